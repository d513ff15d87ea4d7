// What a cluster of light-frame pairs is rendered by: the column of its representative, and what that is
// multiplied with in each of the cluster's frames (Hašan et al. 2008, section 4.5).
#pragma once

#include <cstdint>
#include <vector>

#include "linalg/rectangle_clustering.h"
#include "linalg/reduced_tensor.h"
#include "matrix/lighting_matrix.h"

namespace lumirank::methods {

enum class RepresentativeRule {
  // Ours: the pair whose direction is nearest to that of the cluster's sum, of those that are not much dimmer
  // than its mean, scaled so that sums over the rows that were read are the cluster's. A pair of the largest
  // norm often has it because it stands close to one of those rows, so it is too dark everywhere else.
  central,
  largest,  // as in the paper: of the largest norm, scaled to the sum of the cluster's norms
};

struct ClusterColumn {
  matrix::Index column = 0;
  std::uint32_t frame = 0;  // in which it is computed
  const linalg::RectangleClustering::Rectangle* of = nullptr;
  std::vector<Rgb> scale;  // in each of the rectangle's frames, per channel
  // In each of the rectangle's frames: what it is where it is computed in that very frame; empty until asked
  // for.
  std::vector<matrix::ScaledColumn> in_frame;
};

// The clusters' columns and scales, by what is known of them from the rows that were read.
class ClusterColumns {
 public:
  ClusterColumns(const linalg::ReducedTensor& reduced, RepresentativeRule how)
      : reduced_(reduced), how_(how) {}

  ClusterColumn column_of(const linalg::RectangleClustering::Rectangle& rectangle) const;

  // Fills `in_frame` (ours): with the representative's light, unless that has become much dimmer than the
  // cluster's mean there; else with another that is found as it was. Where nothing moves it is what is
  // carried there, to the bit.
  void find_in_frames(ClusterColumn& of) const;

  struct FrameRange {
    std::uint32_t begin = 0, end = 0;
  };

 private:
  struct Pair {
    matrix::Index column = 0;
    std::uint32_t frame = 0;
  };
  Pair representative(const linalg::RectangleClustering::Rectangle& rectangle, FrameRange frames) const;
  Pair largest(const linalg::RectangleClustering::Rectangle& rectangle, FrameRange frames) const;
  Pair central(const linalg::RectangleClustering::Rectangle& rectangle, FrameRange frames) const;
  matrix::ScaledColumn in_frame(const ClusterColumn& of, std::uint32_t frame) const;
  double amount(Pair pair, std::size_t channel) const;
  Rgb scale(const linalg::RectangleClustering::Rectangle& rectangle, std::uint32_t frame,
            Pair computed) const;

  const linalg::ReducedTensor& reduced_;
  RepresentativeRule how_;
};

}  // namespace lumirank::methods
