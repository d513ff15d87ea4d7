// The rows of a slice's reduced matrix: pixels, each with those of its receivers that the slice has (Huo et
// al. 2015, section 7.2). Receivers of a pixel in another slice are a row of their own there.
//
// Ours: a pixel on an edge or among leaves has a row for each of the surfaces that it shows, so that any one
// of a row's receivers speaks for the others.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "matrix/lighting_matrix.h"
#include "methods/common/hilbert_neighbors.h"

namespace lumirank::methods {

class SliceRows {
 public:
  // Rows are numbered along Hilbert's curve in the tangent plane of the mean normal, so that rows near each
  // other in number are near each other in place. Keeps its buffers.
  void build(const matrix::RowFeatures& features, std::span<const matrix::Index> slice);

  std::size_t size() const { return points_.size(); }
  // Row after row.
  std::span<const matrix::Index> receivers() const { return receivers_; }
  std::uint32_t begin(std::size_t row) const { return first_[row]; }
  std::uint32_t end(std::size_t row) const { return first_[row + 1]; }
  // Mean place of a row's receivers, in units in which the rows spread about 1 around 0.
  std::span<const Vec3f> points() const { return points_; }
  const HilbertCurves& curves() const { return curves_; }

 private:
  struct Placed {
    std::int32_t x, y;
    matrix::Index receiver;
  };
  // The first of `placed` that are alike come first; how many.
  static std::size_t gather_alike(const matrix::RowFeatures& features, std::span<Placed> placed);
  // The steps of build(): the receivers in the order of their pixels; the rows' receivers and places, with
  // the sum of all normals; the places around 0.
  void place(const matrix::RowFeatures& features, std::span<const matrix::Index> slice);
  Vec3f gather(const matrix::RowFeatures& features);
  void center();
  std::vector<Placed> placed_;
  std::vector<std::uint32_t> group_first_, first_;
  std::vector<matrix::Index> receivers_;
  std::vector<Vec3f> group_points_, points_;
  std::vector<Vec2f> plane_, ordered_plane_;
  HilbertCurves curves_;
};

}  // namespace lumirank::methods
