// Columns by what a group of receivers may get of them at most, roughly: power, distance and directions,
// without visibility. A lamp that hangs between records, near a ceiling, lights a spot that none of them
// knows of. (The bounded distribution of Georgiev, Křivánek, Popov and Slusallek 2012.)
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "matrix/lighting_matrix.h"

namespace lumirank::methods {

// Places and directions of all columns. Knows nothing where the matrix tells none.
class BoundedColumns {
 public:
  BoundedColumns(const matrix::ColumnFeatures& features, std::size_t columns);
  std::size_t size() const { return power_.size(); }

 private:
  friend class BoundedDistribution;
  std::array<std::vector<float>, 3> position_, normal_;
  std::vector<float> power_, least_;  // `least_`: what the cosine at the column counts as at least
};

// Over the columns, for one group. Empty before update(), and where nothing is known.
class BoundedDistribution {
 public:
  static constexpr std::size_t kBlock = 64;

  // For receivers at these places.
  void update(const BoundedColumns& columns, const matrix::RowFeatures& rows,
              std::span<const matrix::Index> group);
  bool empty() const { return !(total_ > 0); }
  matrix::Index draw(double u) const;
  float probability(matrix::Index column) const {
    return static_cast<float>(static_cast<double>(weights_[column]) / total_);
  }

 private:
  std::vector<float> weights_, blocks_;  // these: sums of kBlock of those
  double total_ = 0;
};

}  // namespace lumirank::methods
