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

// Sobol's second dimension, lowest bit first: bit r is the sum (mod 2) of the index's bits k with C(k, r)
// odd, which by Lucas are those whose number k has all the ones of r.
std::uint32_t pascal(std::uint32_t i) {
  i ^= (i >> 1) & 0x55555555u;
  i ^= (i >> 2) & 0x33333333u;
  i ^= (i >> 4) & 0x0f0f0f0fu;
  i ^= (i >> 8) & 0x00ff00ffu;
  return i ^ (i >> 16);
}

// The transpose: bit r is the sum of the index's bits k with C(r, k) odd. Any rows of that triangle which
// follow each other are as independent as the first ones, C(r, ·) being polynomials in r of each degree; so
// whichever bits of a number it is added to are full already, the next ones are a permutation of the index's
// lowest.
std::uint32_t pascal_rows(std::uint32_t i) {
  i ^= (i << 1) & 0xaaaaaaaau;
  i ^= (i << 2) & 0xccccccccu;
  i ^= (i << 4) & 0xf0f0f0f0u;
  i ^= (i << 8) & 0xff00ff00u;
  return i ^ (i << 16);
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
  const std::uint32_t i = reversed(scramble_from_lowest(reversed_index_, key));
  std::uint32_t dx = i, dy = pascal(i);
  if (over_film_) {
    // The order within aligned blocks is shuffled here, too.
    const std::uint32_t z = reversed(scramble_from_lowest(reversed_place_, mix64(key ^ 3)));
    dx ^= pascal_rows(z), dy ^= pascal_rows(pascal(z));
  }
  const std::uint64_t x = scramble_from_lowest(dx, mix64(key ^ 1)),
                      y = scramble_from_lowest(dy, mix64(key ^ 2));
  const std::uint64_t both = both_reversed(x << 32 | y);
  return {static_cast<std::uint32_t>(both >> 32), static_cast<std::uint32_t>(both)};
}

}  // namespace lumirank
