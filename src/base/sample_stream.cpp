#include "base/sample_stream.h"

#include <algorithm>

namespace lumirank {
namespace {

// Each half of a number by itself.
std::uint64_t both_reversed(std::uint64_t x) {
  x = __builtin_bswap64(x);
  x = ((x & 0x0f0f0f0f0f0f0f0fu) << 4) | ((x >> 4) & 0x0f0f0f0f0f0f0f0fu);
  x = ((x & 0x3333333333333333u) << 2) | ((x >> 2) & 0x3333333333333333u);
  x = ((x & 0x5555555555555555u) << 1) | ((x >> 1) & 0x5555555555555555u);
  return x << 32 | x >> 32;
}
std::uint32_t reversed(std::uint32_t x) { return static_cast<std::uint32_t>(both_reversed(x)); }

// A permutation of 32-bit numbers in which a bit depends on itself and lower bits only, hence Owen's
// scrambling of a number whose first digit is its lowest bit. Sums, odd factors, and x ^ (x · even) all are
// of that kind. The sum makes each result uniform over the keys.
std::uint32_t scramble_from_lowest(std::uint32_t x, std::uint64_t key) {
  const auto low = static_cast<std::uint32_t>(key), high = static_cast<std::uint32_t>(key >> 32);
  x ^= x * 0x3a8f05c6u;
  x += low;
  x *= high | 1;
  x ^= x * 0x9e6b1d34u;
  x ^= x * 0x51c7a2eau;
  return x;
}

// Of each half of a number by itself, so that two take as long as one: Sobol's second dimension, lowest bit
// first. Bit r is the sum (mod 2) of the index's bits k with C(k, r) odd, which by Lucas are those whose
// number k has all the ones of r.
std::uint64_t both_pascal(std::uint64_t i) {
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
std::uint64_t both_pascal_rows(std::uint64_t i) {
  i ^= (i << 1) & 0xaaaaaaaaaaaaaaaau;
  i ^= (i << 2) & 0xccccccccccccccccu;
  i ^= (i << 4) & 0xf0f0f0f0f0f0f0f0u;
  i ^= (i << 8) & 0xff00ff00ff00ff00u;
  return i ^ ((i << 16) & 0xffff0000ffff0000u);
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

SampleStream::Bits SampleStream::next_pair() {
  const std::uint64_t key = mix64(key_ + pairs_++);
  // The order of the points is shuffled within all aligned blocks of 2^k, so that every pair of dimensions
  // stays even, and two pairs know nothing of each other.
  std::uint64_t index = scramble_from_lowest(reversed_index_, key);
  if (over_film_) index |= std::uint64_t{scramble_from_lowest(reversed_place_, mix64(key ^ 3))} << 32;
  index = both_reversed(index);
  const std::uint64_t second = both_pascal(index);
  auto dx = static_cast<std::uint32_t>(index), dy = static_cast<std::uint32_t>(second);
  if (over_film_) {
    const std::uint64_t shift = both_pascal_rows(index >> 32 | (second >> 32 << 32));
    dx ^= static_cast<std::uint32_t>(shift), dy ^= static_cast<std::uint32_t>(shift >> 32);
  }
  const std::uint64_t x = scramble_from_lowest(dx, mix64(key ^ 1)),
                      y = scramble_from_lowest(dy, mix64(key ^ 2));
  const std::uint64_t both = both_reversed(x << 32 | y);
  return {static_cast<std::uint32_t>(both >> 32), static_cast<std::uint32_t>(both)};
}

}  // namespace lumirank
