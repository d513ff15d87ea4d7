// The columns as they are known after some rows: which are lit, in which clusters, and how large an error to
// expect.
#pragma once

#include <vector>

#include "linalg/clustering.h"
#include "methods/row_column/exploration.h"
#include "methods/row_column/representatives.h"
#include "methods/row_column/settings.h"

namespace lumirank::methods {

// A view of an exploration at one moment: valid until it reads another row.
class ColumnsKnown {
 public:
  ColumnsKnown(const matrix::LightingMatrix& matrix, Exploration& exploration,
               const RowColumnSettings& settings, std::uint64_t seed);

  std::span<const matrix::Index> lit() const { return lit_; }
  std::span<const matrix::Index> zero() const { return zero_; }

  linalg::Splitter cluster(std::size_t columns, linalg::ClusteringAlgorithm algorithm) const;
  // Relative 2-norm error to expect on the rows that the clustering has seen: √(E‖X_R − Σ_R‖²) / ‖Σ_R‖ (2007,
  // section 3.4).
  double expected_error(const linalg::Splitter& clusters) const;
  // The same on rows that it has not seen, summed exactly over them. For a representative drawn with
  // probability ‖ρ_j‖/s,
  //   E|X_i − Σ_i|² = Σ_clusters (s Σ_j A_ij²/‖ρ_j‖ − (Σ_j A_ij)²),
  // and the draws among zero columns add their own variance (or, if ignored, their bias). No column is
  // rendered for it.
  double expected_error(const linalg::Splitter& clusters, Exploration& unseen) const;

  // Draws for zero columns that go with that many clusters.
  std::size_t zero_draws(std::size_t columns) const;
  Representatives choose(const linalg::Splitter& clusters, std::uint64_t round) const;

 private:
  const matrix::LightingMatrix& matrix_;
  const Exploration& exploration_;
  const RowColumnSettings& settings_;
  std::uint64_t seed_;
  std::vector<matrix::Index> lit_, zero_;
  linalg::Points points_;
  std::vector<double> norms_;  // of the projected points
};

}  // namespace lumirank::methods
