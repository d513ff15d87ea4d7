// Random numbers of a path, evenly spread over the paths of a pixel: pairs of Owen-scrambled Sobol points
// (A. B. Owen, "Randomly Permuted (t,m,s)-Nets and (t,s)-Sequences", 1995), each pair of dimensions in an
// order of its own. The scrambling is by hashing, in the manner of S. Laine, T. Karras, "Stratified Sampling
// for Stochastic Transparency", 2011, and B. Burley, "Practical Hash-based Owen Scrambling", 2020.
#pragma once

#include <array>
#include <cstdint>

#include "base/random.h"

namespace lumirank {

class SampleStream {
 public:
  // Samples of even and of odd number belong to two independent sets, so that halves of the samples may be
  // compared. Any one sample alone is as random as from Rng: means are unbiased for every number of samples.
  SampleStream(std::uint64_t seed, Stage stage, std::uint64_t pixel, std::uint64_t sample);

  // Of one film: the same for each pixel alone, and samples of neighboring pixels are spread evenly as well,
  // so that their errors tend to be opposite. Of the first 2^k samples of either half in any aligned block of
  // 2^b × 2^b pixels, each of 2^(k+2b) intervals along either dimension of a pair has one. (The aim is that
  // of A. G. M. Ahmed, P. Wonka, "Screen-Space Blue-Noise Diffusion of Monte Carlo Sampling Error via
  // Hierarchical Ordering of Pixels", 2020; here for any number of samples.) Only over seeds is such a stream
  // uniform. `place`: the pixel's morton2; `use`: which of the streams of a pixel and sample.
  static SampleStream over_film(std::uint64_t seed, Stage stage, std::uint64_t use, std::uint32_t place,
                                std::uint64_t sample);

  // The next pair of dimensions. What a path needs after its first vertices is drawn independently.
  Vec2f next_2d() {
    if (pairs_ >= kPairs) return rng_.next_2d();
    const Bits b = next_pair();
    return {static_cast<float>(b.x >> 8) * 0x1p-24f, static_cast<float>(b.y >> 8) * 0x1p-24f};
  }
  // The same with the bits of a double in x.
  struct Pair {
    double x;
    float y;
  };
  Pair next_fine() {
    if (pairs_ >= kPairs) {
      const double x = rng_.next_double();
      return {x, rng_.next_float()};
    }
    const Bits b = next_pair();
    return {(b.x + rng_.next_double()) * 0x1p-32, static_cast<float>(b.y >> 8) * 0x1p-24f};
  }
  // Independent of everything.
  float next_float() { return rng_.next_float(); }

 private:
  static constexpr std::uint32_t kPairs = 16;
  // Made side by side, which takes little longer than one: a path needs three for each vertex.
  static constexpr std::uint32_t kPairsAtOnce = 8;
  struct Bits {
    std::uint32_t x, y;
  };
  Bits next_pair() {
    const std::uint32_t k = pairs_ % kPairsAtOnce;
    if (k == 0) make_pairs();
    ++pairs_;
    return {static_cast<std::uint32_t>(ahead_[k] >> 32), static_cast<std::uint32_t>(ahead_[k])};
  }
  void make_pairs();

  std::uint64_t key_;
  std::uint32_t reversed_index_, reversed_place_ = 0, pairs_ = 0;
  bool over_film_ = false;
  Rng rng_;
  std::array<std::uint64_t, kPairsAtOnce> ahead_;  // x in the upper half
};

// Numbers for a picture that is the mean of several: sample k of `count` in pass `pass` has this number, in
// the set of even ones alone, and its stream this key. So all passes of even number are spread evenly
// together, and so are those of odd number, of which the others know nothing.
inline std::uint64_t pass_sample(int k, int count, std::uint64_t pass) {
  return 2 * ((pass >> 1) * static_cast<std::uint64_t>(count) + static_cast<std::uint64_t>(k));
}
inline std::uint64_t pass_key(std::uint64_t key, std::uint64_t pass) { return pass & 1 ? mix64(key) : key; }

}  // namespace lumirank
