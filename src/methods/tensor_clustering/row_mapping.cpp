#include "methods/tensor_clustering/row_mapping.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <nanoflann.hpp>
#include <numeric>

#include "base/bounds.h"
#include "base/error.h"
#include "base/parallel.h"

namespace lumirank::methods {
namespace {

constexpr std::size_t kMappingDimensions = 9;
constexpr std::size_t kSpacingNeighbors = 4;
constexpr float kLeastSpacing = 1e-6f;  // of the scene's diagonal
constexpr float kTiniest = 1e-30f;
// Of the scene's diagonal: what a unit of normal and of reflectance counts.
constexpr float kNormalScale = 0.125f, kAlbedoScale = 1.0f / 64;

// What nanoflann wants to know of the points.
struct MappingPoints {
  std::vector<std::array<float, kMappingDimensions>> points;

  MappingPoints(const matrix::LightingMatrix& m, float scale) : points(m.rows()) {
    const matrix::RowFeatures f = m.row_features();
    for (std::size_t i = 0; i < points.size(); ++i) {
      auto& p = points[i];
      p.fill(0);
      for (int c = 0; c < 3; ++c) {
        const auto at = static_cast<std::size_t>(c);
        p[at] = f.position[i][c];
        if (!f.normal.empty()) p[3 + at] = kNormalScale * scale * f.normal[i][c];
        if (!f.albedo.empty()) p[6 + at] = kAlbedoScale * scale * f.albedo[i][c];
      }
    }
  }
  std::size_t kdtree_get_point_count() const { return points.size(); }
  float kdtree_get_pt(std::size_t i, std::size_t dimension) const { return points[i][dimension]; }
  template <typename Box>
  bool kdtree_get_bbox(Box&) const {
    return false;
  }
};

using MappingTree = nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<float, MappingPoints>,
                                                        MappingPoints, kMappingDimensions, std::uint32_t>;

}  // namespace

RowMapping RowMapping::identity(std::size_t rows) {
  RowMapping m;
  m.from.resize(rows);
  std::iota(m.from.begin(), m.from.end(), 0u);
  m.distance.assign(rows, 0);
  return m;
}

RowMapping RowMapping::then(const RowMapping& next) const {
  RowMapping both;
  both.from.resize(next.from.size());
  both.distance.resize(next.from.size());
  for (std::size_t i = 0; i < next.from.size(); ++i) {
    both.from[i] = from[next.from[i]];
    both.distance[i] = std::max(next.distance[i], distance[next.from[i]]);
  }
  return both;
}

RowMapping nearest_rows(const matrix::LightingMatrix& of, const matrix::LightingMatrix& to, float scale) {
  if (of.row_features().position.empty() || to.row_features().position.empty()) {
    if (of.rows() != to.rows()) throw InternalError("frames without places of rows differ in their number");
    return RowMapping::identity(of.rows());
  }
  const MappingPoints from(to, scale), wanted(of, scale);
  if (from.points.empty()) return {};
  const MappingTree tree(kMappingDimensions, from, {16}), own(kMappingDimensions, wanted, {16});
  RowMapping m;
  m.from.resize(wanted.points.size());
  m.distance.resize(wanted.points.size());
  const float least = kLeastSpacing * scale;
  parallel_for(wanted.points.size(), 1024, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      std::uint32_t nearest = 0;
      float squared = 0;
      tree.knnSearch(wanted.points[i].data(), 1, &nearest, &squared);
      m.from[i] = nearest;
      // Receivers of one film sample can coincide, so the nearest of some that does not.
      std::uint32_t others[kSpacingNeighbors];
      float squares[kSpacingNeighbors] = {};
      const std::size_t found = own.knnSearch(wanted.points[i].data(), kSpacingNeighbors, others, squares);
      float spacing = 0;
      for (std::size_t k = 0; k < found && !(spacing > least); ++k) spacing = std::sqrt(squares[k]);
      m.distance[i] = squared > 0 ? std::sqrt(squared) / std::max(spacing, std::max(least, kTiniest)) : 0.0f;
    }
  });
  return m;
}

float diagonal_of_rows(const matrix::LightingMatrix& matrix) {
  Bounds3f box;
  for (const Vec3f p : matrix.row_features().position) box.extend(p);
  return box.empty() ? 0.0f : length(box.diagonal());
}

}  // namespace lumirank::methods
