// The columns as they are known after some rows: which are lit, in which clusters, and how large an error to
// expect.
#pragma once

#include <vector>

#include "linalg/clustering.h"
#include "methods/common/cluster_settings.h"
#include "methods/common/held_out_rows.h"
#include "methods/common/reduced_matrix.h"
#include "methods/common/representatives.h"

namespace lumirank::methods {

// A view of a reduced matrix at one moment: valid until it reads another row.
class ColumnClusters {
 public:
  ColumnClusters(const matrix::LightingMatrix& matrix, ReducedMatrix& reduced,
                 const ClusterSettings& settings, std::uint64_t seed);

  std::span<const matrix::Index> lit() const { return lit_; }
  std::span<const matrix::Index> zero() const { return zero_; }

  linalg::Splitter cluster(std::size_t columns, linalg::ClusteringAlgorithm algorithm) const;
  // Relative L1 error of the image to expect by the rows that the clustering has seen: √(E‖X_R − Σ_R‖²) /
  // ‖Σ_R‖ (2007, section 3.4), taken to an L1 error by ReducedMatrix::l1_over_l2; where rows count by eye, as
  // below, at those of them that were kept.
  double expected_error(const linalg::Splitter& clusters) const;
  // The same by rows that it has not seen, or not as they are: the exact standard deviation of the estimate
  // at each of them, times √(2/π), summed. No column is rendered for it.
  double expected_error(const linalg::Splitter& clusters, const HeldOutRows& unseen) const;

  // Takes, of 0, 0.1, 0.3 and 0.6, the share of the lights' power in the choice of representatives that
  // promises the least error on the unseen rows. It depends on rows alone, so the estimate stays unbiased.
  void tune_power_share(const linalg::Splitter& clusters, const HeldOutRows& unseen);
  double power_share() const { return power_share_; }

  // Draws for zero columns that go with that many clusters.
  std::size_t zero_draws(std::size_t columns) const;
  Representatives choose(const linalg::Splitter& clusters, std::uint64_t round) const;

 private:
  // For a representative drawn with probability q_j/s: Σ_clusters (s Σ_j ‖x_j‖²/q_j − ‖Σ_j x_j‖²), the
  // expected squared error of the sum of the points x; with q_j = ‖x_j‖ it is the cost that the clustering
  // minimizes. One number per coordinate of the points. `Reader`: reader(j, out) writes them as floats.
  template <typename Reader>
  std::vector<double> expected_squares(const linalg::Partition& partition, std::size_t dimension,
                                       const Reader& reader) const;
  // What the draws among zero columns add to that.
  template <typename Reader>
  void add_zero_squares(std::size_t draws, std::size_t dimension, const Reader& reader,
                        std::vector<double>& squares) const;

  const matrix::LightingMatrix& matrix_;
  const ReducedMatrix& reduced_;
  const ClusterSettings& settings_;
  std::uint64_t seed_;
  std::vector<matrix::Index> lit_, zero_;
  linalg::Points points_;
  std::vector<double> norms_;  // of the projected points
  double power_share_;
  std::vector<float> weights_;  // q of the representatives
};

}  // namespace lumirank::methods
