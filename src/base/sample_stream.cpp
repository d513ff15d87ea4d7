#include "base/sample_stream.h"

#include <array>

namespace lumirank {
namespace {

constexpr std::uint64_t lower_half(std::uint64_t x) { return x & 0xffffffffu; }

// Each half of a number by itself.
inline std::uint64_t both_reversed(std::uint64_t x) {
  x = ((x & 0x0000ffff0000ffffu) << 16) | ((x >> 16) & 0x0000ffff0000ffffu);
  x = ((x & 0x00ff00ff00ff00ffu) << 8) | ((x >> 8) & 0x00ff00ff00ff00ffu);
  x = ((x & 0x0f0f0f0f0f0f0f0fu) << 4) | ((x >> 4) & 0x0f0f0f0f0f0f0f0fu);
  x = ((x & 0x3333333333333333u) << 2) | ((x >> 2) & 0x3333333333333333u);
  return ((x & 0x5555555555555555u) << 1) | ((x >> 1) & 0x5555555555555555u);
}
std::uint32_t reversed(std::uint32_t x) { return static_cast<std::uint32_t>(both_reversed(x)); }

// A permutation of 32-bit numbers in which a bit depends on itself and lower bits only, hence Owen's
// scrambling of a number whose first digit is its lowest bit. Sums, odd factors, and x ^ (x · even) all are
// of that kind. The sum makes each result uniform over the keys. In 64 bits, so that the loops below have
// numbers of one width.
inline std::uint64_t scramble_from_lowest(std::uint64_t x, std::uint64_t key) {
  x ^= lower_half(x * 0x3a8f05c6u);
  x = lower_half(x + key);
  x = lower_half(x * (key >> 32 | 1));
  x ^= lower_half(x * 0x9e6b1d34u);
  return x ^ lower_half(x * 0x51c7a2eau);
}

// Of each half of a number by itself, so that two take as long as one: Sobol's second dimension, lowest bit
// first. Bit r is the sum (mod 2) of the index's bits k with C(k, r) odd, which by Lucas are those whose
// number k has all the ones of r.
inline std::uint64_t both_pascal(std::uint64_t i) {
  i ^= (i >> 1) & 0x5555555555555555u;
  i ^= (i >> 2) & 0x3333333333333333u;
  i ^= (i >> 4) & 0x0f0f0f0f0f0f0f0fu;
  i ^= (i >> 8) & 0x00ff00ff00ff00ffu;
  return i ^ ((i >> 16) & 0x0000ffff0000ffffu);
}

// The transpose: bit r is the sum of the index's bits k with C(r, k) odd. Any rows of that triangle which
// follow each other are as independent as the first ones, C(r, ·) being polynomials in r of each degree; so
// whichever bits of a number it is added to are full already, the next ones are a permutation of the index's
// lowest.
inline std::uint64_t both_pascal_rows(std::uint64_t i) {
  i ^= (i << 1) & 0xaaaaaaaaaaaaaaaau;
  i ^= (i << 2) & 0xccccccccccccccccu;
  i ^= (i << 4) & 0xf0f0f0f0f0f0f0f0u;
  i ^= (i << 8) & 0xff00ff00ff00ff00u;
  return i ^ ((i << 16) & 0xffff0000ffff0000u);
}

// A pair of dimensions, x in the upper half, of a point whose coordinates have their first digits lowest.
inline std::uint64_t scrambled(std::uint64_t x, std::uint64_t y, std::uint64_t key) {
  return both_reversed(scramble_from_lowest(x, mix64(key ^ 1)) << 32 |
                       scramble_from_lowest(y, mix64(key ^ 2)));
}

// The order of the points is shuffled within all aligned blocks of 2^k, so that every pair of dimensions
// stays even, and two pairs know nothing of each other.
inline std::uint64_t pair_of_pixel(std::uint64_t reversed_index, std::uint64_t key) {
  const std::uint64_t index = both_reversed(scramble_from_lowest(reversed_index, key));
  return scrambled(index, lower_half(both_pascal(index)), key);
}

inline std::uint64_t pair_over_film(std::uint64_t reversed_index, std::uint64_t reversed_place,
                                    std::uint64_t key) {
  const std::uint64_t index = both_reversed(scramble_from_lowest(reversed_index, key) |
                                            scramble_from_lowest(reversed_place, mix64(key ^ 3)) << 32);
  const std::uint64_t second = both_pascal(index);
  const std::uint64_t shift = both_pascal_rows(index >> 32 | (second >> 32 << 32));
  return scrambled(lower_half(index ^ shift), lower_half(second ^ shift >> 32), key);
}

}  // namespace

SampleStream SampleStream::over_film(std::uint64_t seed, Stage stage, std::uint64_t use, std::uint32_t place,
                                     std::uint64_t sample) {
  SampleStream stream(seed, stage, use, sample);
  stream.over_film_ = true, stream.reversed_place_ = reversed(place);
  stream.rng_ = Rng(seed, stage, hash_ids(use, stage, place), sample);
  return stream;
}

SampleStream::SampleStream(std::uint64_t seed, Stage stage, std::uint64_t pixel, std::uint64_t sample)
    : key_(hash_ids(seed, stage, pixel, sample & 1)),
      reversed_index_(reversed(static_cast<std::uint32_t>(sample >> 1))),
      rng_(seed, stage, ~key_, sample) {}

// Plain loops, which compilers make vector instructions of where all that they call is inlined.
void SampleStream::make_pairs() {
  const std::uint64_t first = key_ + pairs_, index = reversed_index_, place = reversed_place_;
  std::array<std::uint64_t, kPairsAtOnce> pairs;
  if (over_film_)
    for (std::uint64_t k = 0; k < kPairsAtOnce; ++k)
      pairs[k] = pair_over_film(index, place, mix64(first + k));
  else
    for (std::uint64_t k = 0; k < kPairsAtOnce; ++k) pairs[k] = pair_of_pixel(index, mix64(first + k));
  ahead_ = pairs;
}

}  // namespace lumirank
