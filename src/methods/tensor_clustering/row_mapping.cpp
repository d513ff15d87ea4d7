#include "methods/tensor_clustering/row_mapping.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <nanoflann.hpp>
#include <numeric>

#include "base/bounds.h"
#include "base/error.h"
#include "base/parallel.h"

namespace lumirank::methods {
namespace {

constexpr std::size_t kMappingDimensions = 9;
// Rows before and after one, by number, of which the nearest tells how far apart rows are.
constexpr std::size_t kSpacingNeighbors = 8;
constexpr std::size_t kRowsInTurn = 1024;
constexpr float kLeastSpacing = 1e-6f;  // of the scene's diagonal
constexpr float kTiniest = 1e-30f;
// Of the scene's diagonal: what a unit of normal and of reflectance counts.
constexpr float kNormalScale = 0.125f, kAlbedoScale = 1.0f / 64;

// Of the mean square distance: what is added to the products of differences, so that weights stay small.
constexpr float kBlendStiffness = 0.01f;
constexpr float kMaxBlendWeight = 3;

using MappingPoint = std::array<float, kMappingDimensions>;

float squared_distance(const MappingPoint& a, const MappingPoint& b) {
  float sum = 0;
  for (std::size_t d = 0; d < kMappingDimensions; ++d) sum += (a[d] - b[d]) * (a[d] - b[d]);
  return sum;
}

}  // namespace

// What nanoflann wants to know of the points.
struct MappingPoints {
  std::vector<MappingPoint> points;

  MappingPoints(const matrix::RowFeatures& f, float scale) : points(f.position.size()) {
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

namespace {

// For nanoflann: the nearest point so far, where a good guess may be the first.
struct NearestRow {
  std::uint32_t row = 0;
  float squared = std::numeric_limits<float>::infinity();

  std::size_t size() const { return 1; }
  bool full() const { return true; }
  float worstDist() const { return squared; }
  bool addPoint(float distance, std::uint32_t index) {
    if (distance < squared || (distance == squared && index < row)) squared = distance, row = index;
    return true;
  }
};

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
  parallel_for(next.from.size(), kRowsInTurn, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      if (next.from[i] >= from.size()) {  // nothing is seen in between
        both.distance[i] = std::numeric_limits<float>::infinity();
        continue;
      }
      both.from[i] = from[next.from[i]];
      both.distance[i] = std::max(next.distance[i], distance[next.from[i]]);
    }
  });
  return both;
}

bool reaches(float distance, double max_distance, std::size_t rows) {
  constexpr double kUsualRows = 256 * 256;
  const double larger = std::max(1.0, std::sqrt(static_cast<double>(rows) / kUsualRows));
  return std::isfinite(distance) &&
         (max_distance == 0 || static_cast<double>(distance) <= max_distance * larger);
}

struct FrameRows::Impl {
  std::size_t rows = 0;
  float scale = 0;
  MappingPoints points;
  MappingTree tree;

  Impl(const matrix::RowFeatures& features, std::size_t rows_, float scale_)
      : rows(rows_), scale(scale_), points(features, scale_), tree(kMappingDimensions, points, {16}) {}

  // To the nearest of its neighbors by number that does not coincide with it (receivers of one film sample
  // can).
  float spacing(std::size_t i) const {
    const float least = std::max(kLeastSpacing * scale, kTiniest);
    float nearest = std::numeric_limits<float>::infinity();
    const std::size_t end = std::min(points.points.size(), i + kSpacingNeighbors + 1);
    for (std::size_t k = i - std::min(i, kSpacingNeighbors); k < end; ++k)
      if (const float d = squared_distance(points.points[i], points.points[k]); d > least * least)
        nearest = std::min(nearest, d);
    return std::isfinite(nearest) ? std::max(least, std::sqrt(nearest)) : least;
  }
};

FrameRows::FrameRows(const matrix::LightingMatrix& matrix, float scale)
    : FrameRows(matrix.row_features(), matrix.rows(), scale) {}
FrameRows::FrameRows(const matrix::RowFeatures& features, std::size_t rows, float scale)
    : impl_(std::make_unique<const Impl>(features, rows, scale)) {}
FrameRows::~FrameRows() = default;

RowMapping FrameRows::nearest(const FrameRows& to) const {
  const auto &wanted = impl_->points.points, &from = to.impl_->points.points;
  if (impl_->rows == 0 || to.impl_->rows == 0) {
    RowMapping nothing;
    nothing.from.assign(impl_->rows, 0);
    nothing.distance.assign(impl_->rows, std::numeric_limits<float>::infinity());
    return nothing;
  }
  if (wanted.empty() || from.empty()) {
    if (impl_->rows != to.impl_->rows)
      throw InternalError("frames without places of rows differ in their number");
    return RowMapping::identity(impl_->rows);
  }
  RowMapping m;
  m.from.resize(wanted.size());
  m.distance.resize(wanted.size());
  parallel_for(wanted.size(), kRowsInTurn, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      NearestRow best;
      const auto guess = [&](std::size_t k) {
        if (k < from.size())
          best.addPoint(squared_distance(wanted[i], from[k]), static_cast<std::uint32_t>(k));
      };
      guess(i);
      if (i > begin) guess(m.from[i - 1]), guess(m.from[i - 1] + std::size_t{1});
      if (best.squared > 0) to.impl_->tree.findNeighbors(best, wanted[i].data(), nanoflann::SearchParams());
      m.from[i] = best.row;
      m.distance[i] = best.squared > 0 ? std::sqrt(best.squared) / impl_->spacing(i) : 0.0f;
    }
  });
  return m;
}

RowBlend FrameRows::blend(std::size_t row, const FrameRows& to) const {
  constexpr std::size_t n = RowBlend::kRows;
  const auto& from = to.impl_->points.points;
  const MappingPoint& wanted = impl_->points.points[row];
  RowBlend out;
  std::array<float, n> squared{};
  const std::size_t found =
      to.impl_->tree.knnSearch(wanted.data(), std::min(n, from.size()), out.from.data(), squared.data());
  if (found < n || squared[0] == 0) return out;
  // Least |wanted − Σ w x|² with Σ w = 1: weights in proportion to C⁻¹·1, C the products of the differences.
  std::array<MappingPoint, n> difference;
  for (std::size_t a = 0; a < n; ++a)
    for (std::size_t d = 0; d < kMappingDimensions; ++d) difference[a][d] = from[out.from[a]][d] - wanted[d];
  Eigen::Matrix4f products;
  for (std::size_t a = 0; a < n; ++a)
    for (std::size_t b = 0; b < n; ++b)
      products(static_cast<Eigen::Index>(a), static_cast<Eigen::Index>(b)) =
          std::inner_product(difference[a].begin(), difference[a].end(), difference[b].begin(), 0.0f);
  products.diagonal().array() += kBlendStiffness * products.trace() / static_cast<float>(n);
  const Eigen::Vector4f weight = products.llt().solve(Eigen::Vector4f::Ones());
  const float sum = weight.sum();
  // Where they cannot be found the nearest stands for all.
  if (!(sum > kTiniest) || !weight.allFinite() || weight.cwiseAbs().maxCoeff() > kMaxBlendWeight * sum)
    return out;
  for (std::size_t a = 0; a < n; ++a) out.weight[a] = weight[static_cast<Eigen::Index>(a)] / sum;
  return out;
}

float diagonal_of_rows(const matrix::RowFeatures& features) {
  Bounds3f box;
  for (const Vec3f p : features.position) box.extend(p);
  return box.empty() ? 0.0f : length(box.diagonal());
}

}  // namespace lumirank::methods
