// Evenly spread points: the additive recurrence on the generalized golden ratio (Roberts 2018), shifted at
// random modulo 1 so that each point by itself is uniform. In integers, so that no precision is lost however
// long the sequence.
#pragma once

#include <cstdint>

#include "base/random.h"
#include "base/vec.h"

namespace lumirank {

// Two points of the unit square per index: four dimensions, x⁵ = x + 1.
class Sequence4 {
 public:
  Sequence4(std::uint64_t seed, Stage stage, std::uint64_t id) {
    for (std::uint64_t d = 0; d < 4; ++d) shift_[d] = hash_ids(seed, stage, id, ~d);
  }
  Vec2f first(std::uint64_t index) const { return {at(index, 0), at(index, 1)}; }
  Vec2f second(std::uint64_t index) const { return {at(index, 2), at(index, 3)}; }

 private:
  float at(std::uint64_t index, int d) const { return unit_float(shift_[d] + index * kStep[d]); }

  // 2^64 · φ^-(d+1), φ = 1.167303978261418684.
  static constexpr std::uint64_t kStep[4] = {0xdb4f0b9175ae2165ull, 0xbbe0563303a4615full,
                                             0xa0f2ec75a1fe1575ull, 0x89e182857d9ed689ull};
  std::uint64_t shift_[4];
};

// One point of the unit square per index: x³ = x + 1.
class Sequence2 {
 public:
  Sequence2(std::uint64_t seed, Stage stage, std::uint64_t id) {
    for (std::uint64_t d = 0; d < 2; ++d) shift_[d] = hash_ids(seed, stage, id, ~d);
  }
  Vec2f operator()(std::uint64_t index) const {
    return {unit_float(shift_[0] + index * kStep[0]), unit_float(shift_[1] + index * kStep[1])};
  }

 private:
  // 2^64 · φ^-(d+1), φ = 1.324717957244746025.
  static constexpr std::uint64_t kStep[2] = {0xc13fa9a902a6328full, 0x91e10da5c79e7b1dull};
  std::uint64_t shift_[2];
};

}  // namespace lumirank
