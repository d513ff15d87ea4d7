#include "pathtrace/vertex_merging.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "base/error.h"
#include "base/parallel.h"
#include "base/random.h"

namespace lumirank::pathtrace {
namespace {

// Surfaces more inclined than that, as a cosine, or farther apart than a part of the radius, are others.
constexpr float kAlike = 0.8f, kApart = 0.5f;
constexpr std::size_t kPointsAtOnce = 4096;

float radius(const MergePoint& point) { return std::sqrt(point.area * kInvPi); }

}  // namespace

int MergePoints::level_of(const MergePoint& point) { return std::ilogb(2 * radius(point)) + 1; }

MergePoints::Cell MergePoints::cell_of(Vec3f place, int level) {
  const auto along = [level](float x) {
    return static_cast<std::int64_t>(std::floor(std::ldexp(static_cast<double>(x), -level)));
  };
  return {along(place.x), along(place.y), along(place.z)};
}

std::uint64_t MergePoints::key_of(const Cell& cell, int level) {
  const auto bits = [](std::int64_t k) { return static_cast<std::uint64_t>(k); };
  return mix64(mix64(mix64(bits(cell.x) ^ (bits(level) << 48)) ^ bits(cell.y)) ^ bits(cell.z));
}

bool MergePoints::on_disc(const MergePoint& point, const scatter::SurfacePoint& at) {
  const Vec3f apart = at.position - point.hit.point.position;
  const float squared = length_squared(apart);
  return kPi * squared <= point.area && std::abs(dot(point.hit.point.ng, at.ng)) >= kAlike &&
         kPi * square(dot(point.hit.point.ng, apart)) <= square(kApart) * point.area;
}

MergePoints::MergePoints(std::vector<std::vector<MergePoint>> of_parts) {
  std::size_t number = 0;
  for (const auto& part : of_parts) number += part.size();
  if (number == 0) return;
  points_.reserve(number);
  // Of a large film behind glass they are hundreds of megabytes, which must not be there twice.
  for (auto& part : of_parts) points_.insert(points_.end(), part.begin(), part.end()), part = {};
  // Each is entered in all cells that its sphere reaches, so that who looks for it looks in one.
  const std::size_t parts = (points_.size() + kPointsAtOnce - 1) / kPointsAtOnce;
  std::vector<std::vector<Entry>> entries(parts);
  std::vector<std::vector<int>> levels(parts);
  parallel_for(parts, 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t part = begin; part < end; ++part)
      for (std::size_t k = part * kPointsAtOnce; k < std::min(points_.size(), (part + 1) * kPointsAtOnce);
           ++k) {
        const int level = level_of(points_[k]);
        if (std::find(levels[part].begin(), levels[part].end(), level) == levels[part].end())
          levels[part].push_back(level);
        const float reach = radius(points_[k]);
        const Vec3f p = points_[k].hit.point.position, r{reach, reach, reach};
        const Cell low = cell_of(p - r, level), high = cell_of(p + r, level);
        for (std::int64_t x = low.x; x <= high.x; ++x)
          for (std::int64_t y = low.y; y <= high.y; ++y)
            for (std::int64_t z = low.z; z <= high.z; ++z)
              entries[part].push_back({key_of({x, y, z}, level), static_cast<std::uint32_t>(k)});
      }
  });
  std::size_t count = 0;
  for (const auto& part : entries) count += part.size();
  for (const auto& part : levels) levels_.insert(levels_.end(), part.begin(), part.end());
  std::sort(levels_.begin(), levels_.end());
  levels_.erase(std::unique(levels_.begin(), levels_.end()), levels_.end());
  if (count > std::numeric_limits<std::uint32_t>::max() / 2)
    throw InternalError("pathtrace::MergePoints: more than 2^31 entries");
  const std::size_t buckets = std::bit_ceil(std::max<std::size_t>(1, count));
  begins_.assign(buckets + 1, 0);
  for (const auto& part : entries)
    for (const Entry& entry : part) ++begins_[(entry.key & (buckets - 1)) + 1];
  for (std::size_t b = 0; b < buckets; ++b) begins_[b + 1] += begins_[b];
  entries_.resize(count);
  std::vector<std::uint32_t> next(begins_.begin(), begins_.end() - 1);
  for (auto& part : entries) {
    for (const Entry& entry : part) entries_[next[entry.key & (buckets - 1)]++] = entry;
    part = {};
  }
}

void MergePoints::around(const scatter::SurfacePoint& at, std::vector<const MergePoint*>& found) const {
  found.clear();
  for (const int level : levels_) {
    const std::uint64_t key = key_of(cell_of(at.position, level), level);
    const std::size_t bucket = key & (begins_.size() - 2);
    for (std::uint32_t k = begins_[bucket]; k < begins_[bucket + 1]; ++k)
      if (entries_[k].key == key && on_disc(points_[entries_[k].point], at))
        found.push_back(&points_[entries_[k].point]);
  }
}

}  // namespace lumirank::pathtrace
