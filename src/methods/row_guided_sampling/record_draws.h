// Columns drawn for one receiver from what the records near it say.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "matrix/lighting_matrix.h"
#include "methods/row_guided_sampling/light_records.h"

namespace lumirank::methods {

struct GuidedColumn {
  matrix::Index column;
  float probability;  // of a draw, by all distributions together: the balance heuristic
  float visible;      // what the records near think of its visibility, in (0, 1]
};

// A mixture of the distributions of the nearest records, with and without visibility, and of the columns'
// power: where one of them knows nothing of a column, another does, and no column that has power is out of
// reach (importance caching: Georgiev, Křivánek, Popov and Slusallek 2012, section 4).
class RecordMixture {
 public:
  RecordMixture(const LightRecords& records, matrix::Index row);

  // u in [0, 1). Equal steps of u are spread over the distributions, and in each of them over its columns in
  // their order.
  GuidedColumn draw(double u) const;

 private:
  float probability_of(matrix::Index column) const;
  float visibility_of(matrix::Index column) const;

  const LightRecords& records_;
  std::array<std::uint32_t, LightRecords::kNear> near_;
  std::size_t near_count_ = 0, count_ = 0;
  // Distributions by their numbers, and what they get.
  std::array<std::uint32_t, 2 * LightRecords::kNear + 1> part_;
  std::array<float, 2 * LightRecords::kNear + 1> share_;
};

// The fraction of a scrambled van der Corput sequence (Owen 1995): any 2^k numbers after one another from a
// multiple of 2^k on are in different parts of as many equal ones. Rows that follow one another lie close in
// the picture, so errors of neighbors make up for one another (Ahmed and Wonka 2020).
double spread_fraction(std::uint64_t index, std::uint64_t seed);

}  // namespace lumirank::methods
