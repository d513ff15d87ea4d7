// Random numbers as a function of (seed, stage, ids), never of the order in which threads ask for them.
#pragma once

#include <cstdint>

#include "base/vec.h"

namespace lumirank {

// Who draws. Two stages never share a stream, so adding draws to one does not change another.
enum class Stage : std::uint32_t {
  receivers = 1,
  emitter_samples,
  particles,
  pilot,
  rows,
  projection,
  clustering,
  representatives,
  zero_columns,
  opacity,
  reference,
  traced_direct,
  method,
  benchmark,
  test,
  spheres,
  traced_sharp,
  traced_near,
  gather_samples,
  film_samples,
  shutter,
  ray_pairs,
  passes,
  segments,
  gathered,
  light_paths,
};

// A 64-bit mix with full avalanche (the finaliser of SplitMix64).
inline std::uint64_t mix64(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15ull;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ull;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebull;
  return x ^ (x >> 31);
}

inline std::uint64_t hash_ids(std::uint64_t seed, Stage stage, std::uint64_t a = 0, std::uint64_t b = 0) {
  return mix64(mix64(mix64(seed ^ (static_cast<std::uint64_t>(stage) << 56)) ^ a) ^ b);
}

// Uniform in [0, 1): 24 bits, so that it is exact in a float and never 1.
inline float unit_float(std::uint64_t bits) { return static_cast<float>(bits >> 40) * 0x1p-24f; }
inline double unit_double(std::uint64_t bits) { return static_cast<double>(bits >> 11) * 0x1p-53; }

// A stream of numbers for one (seed, stage, a, b). Cheap to make: one per path, row or light.
class Rng {
 public:
  Rng(std::uint64_t seed, Stage stage, std::uint64_t a = 0, std::uint64_t b = 0)
      : state_(hash_ids(seed, stage, a, b)) {}

  std::uint64_t next_bits() {
    state_ += 0x9e3779b97f4a7c15ull;
    std::uint64_t x = state_;
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ull;
    x = (x ^ (x >> 27)) * 0x94d049bb133111ebull;
    return x ^ (x >> 31);
  }
  float next_float() { return unit_float(next_bits()); }
  double next_double() { return unit_double(next_bits()); }
  Vec2f next_2d() {
    const float x = next_float();
    return {x, next_float()};
  }
  // Uniform in [0, n); n > 0.
  std::uint64_t next_below(std::uint64_t n) {
    __extension__ using Wide = unsigned __int128;  // g++ and clang have it; ISO C++ does not
    return static_cast<std::uint64_t>((static_cast<Wide>(next_bits()) * n) >> 64);
  }
  // Standard normal deviate.
  double next_gaussian();

 private:
  std::uint64_t state_;
};

}  // namespace lumirank
