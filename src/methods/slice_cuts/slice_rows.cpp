#include "methods/slice_cuts/slice_rows.h"

#include <algorithm>
#include <cmath>

namespace lumirank::methods {

using matrix::Index;

namespace {
constexpr float kSameNormal = 0.9f;  // cosine, at least
constexpr float kSamePlane = 0.2f;   // sine of the elevation over the other's plane, at most
}  // namespace

std::size_t SliceRows::gather_alike(const matrix::RowFeatures& features, std::span<Placed> placed) {
  if (features.normal.empty() || features.position.empty()) return placed.size();
  const Vec3f normal = features.normal[placed[0].receiver], at = features.position[placed[0].receiver];
  const auto alike = [&](const Placed& other) {
    const Vec3f way = features.position[other.receiver] - at;
    return dot(normal, features.normal[other.receiver]) >= kSameNormal * length_squared(normal) &&
           square(dot(normal, way)) <= square(kSamePlane) * length_squared(way);
  };
  return static_cast<std::size_t>(std::stable_partition(placed.begin() + 1, placed.end(), alike) -
                                  placed.begin());
}

void SliceRows::place(const matrix::RowFeatures& features, std::span<const Index> slice) {
  const bool with_pixels = !features.pixel.empty();
  placed_.clear();
  for (const Index i : slice) {
    if (with_pixels)
      placed_.push_back({static_cast<std::int32_t>(std::floor(features.pixel[i].x)),
                         static_cast<std::int32_t>(std::floor(features.pixel[i].y)), i});
    else
      placed_.push_back({static_cast<std::int32_t>(i), 0, i});
  }
  std::sort(placed_.begin(), placed_.end(), [](const Placed& a, const Placed& b) {
    return a.y != b.y ? a.y < b.y : a.x != b.x ? a.x < b.x : a.receiver < b.receiver;
  });
}

Vec3f SliceRows::gather(const matrix::RowFeatures& features) {
  const bool with_places = !features.position.empty();
  group_first_.clear();
  group_points_.clear();
  Vec3f normal{};
  for (std::size_t k = 0; k < placed_.size();) {
    group_first_.push_back(static_cast<std::uint32_t>(k));
    const Placed pixel = placed_[k];
    std::size_t end = k;
    while (end < placed_.size() && placed_[end].x == pixel.x && placed_[end].y == pixel.y) ++end;
    end = k + gather_alike(features, std::span(placed_).subspan(k, end - k));
    Vec3f sum{};
    float count = 0;
    for (; k < end; ++k, ++count) {
      const Index i = placed_[k].receiver;
      sum = sum + (with_places ? features.position[i] : Vec3f{static_cast<float>(i), 0, 0});
      if (!features.normal.empty()) normal = normal + features.normal[i];
    }
    group_points_.push_back(sum / count);
  }
  group_first_.push_back(static_cast<std::uint32_t>(placed_.size()));
  return normal;
}

void SliceRows::center() {
  const auto rows = static_cast<float>(group_points_.size());
  Vec3f middle{};
  for (const Vec3f& p : group_points_) middle = middle + p;
  middle = middle / std::max(rows, 1.0f);
  double spread = 0;
  for (Vec3f& p : group_points_) {
    p = p - middle;
    spread += static_cast<double>(length_squared(p));
  }
  const auto unit = static_cast<float>(
      std::sqrt(std::max(spread, 1e-30) / std::max(static_cast<double>(group_points_.size()), 1.0)));
  for (Vec3f& p : group_points_) p = p / unit;
}

void SliceRows::build(const matrix::RowFeatures& features, std::span<const Index> slice) {
  place(features, slice);
  const Vec3f normal = gather(features);
  center();
  const std::size_t rows = group_points_.size();
  plane_.resize(rows);
  tangent_coordinates(group_points_, normal, plane_);
  curves_.build(plane_);

  receivers_.clear();
  first_.assign(1, 0);
  points_.resize(rows);
  ordered_plane_.resize(rows);
  for (std::size_t r = 0; r < rows; ++r) {
    const std::uint32_t g = curves_.order(0)[r];
    points_[r] = group_points_[g];
    ordered_plane_[r] = plane_[g];
    for (std::uint32_t k = group_first_[g]; k < group_first_[g + 1]; ++k)
      receivers_.push_back(placed_[k].receiver);
    first_.push_back(static_cast<std::uint32_t>(receivers_.size()));
  }
  curves_.build(ordered_plane_);
}

}  // namespace lumirank::methods
