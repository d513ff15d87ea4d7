#include "methods/common/hilbert_neighbors.h"

#include <algorithm>

#include "base/frame.h"
#include "base/hilbert.h"

namespace lumirank::methods {

namespace {

using Few = SampledNeighbors::Few;
constexpr std::size_t kCount = SampledNeighbors::kCount;
constexpr std::size_t kSortStretch = 16;

// Inserts a candidate among the nearest unless it is there already.
void offer(std::uint32_t candidate, float distance, Few& nearest, std::array<float, kCount>& distances) {
  if (!(distance < distances[kCount - 1])) return;
  for (const std::uint32_t held : nearest)
    if (held == candidate) return;
  std::size_t k = kCount - 1;
  for (; k > 0 && distance < distances[k - 1]; --k) {
    nearest[k] = nearest[k - 1];
    distances[k] = distances[k - 1];
  }
  nearest[k] = candidate;
  distances[k] = distance;
}

}  // namespace

void tangent_coordinates(std::span<const Vec3f> points, Vec3f normal, std::span<Vec2f> out) {
  const Frame frame = Frame::from_normal(length_squared(normal) > 0 ? normalize(normal) : Vec3f{0, 0, 1});
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vec3f local = frame.to_local(points[i]);
    out[i] = {local.x, local.y};
  }
}

void HilbertCurves::build(std::span<const Vec2f> points) {
  points_.assign(points.begin(), points.end());
  const std::size_t n = points.size();
  Vec2f lo{kInfinity, kInfinity}, hi{-kInfinity, -kInfinity};
  for (const Vec2f p : points) {
    lo = {std::min(lo.x, p.x), std::min(lo.y, p.y)};
    hi = {std::max(hi.x, p.x), std::max(hi.y, p.y)};
  }
  const float side = std::max({hi.x - lo.x, hi.y - lo.y, 1e-30f});
  constexpr unsigned kBits = 16;
  // The grid is twice as wide as the points' extent, so that the shifts stay inside.
  constexpr float kCells = 32767.0f;
  keys_.resize(n);
  for (std::size_t c = 0; c < kCurves; ++c) {
    const float shift = static_cast<float>(c) / static_cast<float>(kCurves);
    for (std::size_t i = 0; i < n; ++i) {
      const auto cell = [&](float x, float low) {
        return static_cast<std::uint32_t>(((x - low) / side + shift) * kCells);
      };
      keys_[i] =
          (std::uint64_t{hilbert_place(cell(points[i].x, lo.x), cell(points[i].y, lo.y), kBits)} << 32) | i;
    }
    std::sort(keys_.begin(), keys_.end());
    order_[c].resize(n);
    for (std::size_t k = 0; k < n; ++k) order_[c][k] = static_cast<std::uint32_t>(keys_[k]);
  }
}

void SampledNeighbors::clear(std::size_t points) {
  nearest_.assign(points, Few{kNone, kNone, kNone});
  distance_.assign(points, {kInfinity, kInfinity, kInfinity});
}

void SampledNeighbors::find(const HilbertCurves& curves, std::span<const std::uint8_t> sampled) {
  const auto points = curves.points();
  clear(points.size());
  for (std::size_t c = 0; c < HilbertCurves::kCurves; ++c)
    for (const bool backwards : {false, true}) {
      const auto order = curves.order(c);
      Few last{kNone, kNone, kNone};  // the latest sampled points on the way
      std::size_t next = 0;
      for (std::size_t k = 0; k < order.size(); ++k) {
        const std::uint32_t i = order[backwards ? order.size() - 1 - k : k];
        if (sampled[i]) last[next++ % kCount] = i;
        for (const std::uint32_t candidate : last) {
          if (candidate == kNone) continue;
          const Vec2f d{points[i].x - points[candidate].x, points[i].y - points[candidate].y};
          offer(candidate, d.x * d.x + d.y * d.y, nearest_[i], distance_[i]);
        }
      }
    }
}

void SampledNeighbors::extend(const SampledNeighbors& before, const HilbertCurves& curves,
                              std::span<const std::uint32_t> more) {
  if (&before != this) {
    nearest_ = before.nearest_;
    distance_ = before.distance_;
  }
  const auto points = curves.points();
  const std::size_t n = points.size();
  to_.resize(n);
  farthest_.resize(n);
  for (std::size_t i = 0; i < n; ++i) farthest_[i] = distance_[i].back();
  for (const std::uint32_t sample : more) {
    const Vec2f at = points[sample];
    for (std::size_t i = 0; i < n; ++i) {
      const float x = points[i].x - at.x, y = points[i].y - at.y;
      to_[i] = x * x + y * y;
    }
    // Few points have a new neighbor: sixteen at a time are searched for one.
    for (std::size_t begin = 0; begin < n; begin += kSortStretch) {
      const std::size_t end = std::min(n, begin + kSortStretch);
      const float *const to = &to_[begin], *const farthest = &farthest_[begin];
      int nearer = 0;
      if (end - begin == kSortStretch) {
        for (std::size_t k = 0; k < kSortStretch; ++k) nearer |= to[k] < farthest[k] ? 1 : 0;
      } else {
        nearer = 1;
      }
      if (nearer == 0) continue;
      for (std::size_t i = begin; i < end; ++i) {
        if (!(to_[i] < farthest_[i])) continue;
        offer(sample, to_[i], nearest_[i], distance_[i]);
        farthest_[i] = distance_[i].back();
      }
    }
  }
}

}  // namespace lumirank::methods
