#include "media/depth_profile.h"

#include <algorithm>
#include <cmath>

namespace lumirank::media {
namespace {

constexpr float kStepsPerPlace = 2;

}  // namespace

void DepthProfile::follow(const Medium& medium, Vec3f origin, Vec3f direction, float t_max) {
  steps_.clear();
  Medium::Walk walk(medium, origin, direction, t_max);
  const float density = medium.homogeneous() ? 0 : kStepsPerPlace * walk.places_per_length();
  Medium::Walk::Piece piece;
  Rgb depth{0};
  while (walk.next(piece)) {
    if (is_black(piece.extinction.most) || !(piece.end > piece.begin)) continue;
    if (medium.homogeneous()) {
      depth += over_length(piece.extinction.most, piece.end - piece.begin);
      steps_.push_back({piece.begin, piece.end, piece.extinction.most, depth});
      continue;
    }
    const float length = piece.end - piece.begin;
    const int count = std::max(1, static_cast<int>(std::ceil(length * density)));
    Rgb before = walk.extinction(piece.begin);
    for (int k = 0; k < count; ++k) {
      const float begin = piece.begin + length * static_cast<float>(k) / static_cast<float>(count),
                  end = k + 1 == count
                            ? piece.end
                            : piece.begin + length * static_cast<float>(k + 1) / static_cast<float>(count);
      const Rgb after = walk.extinction(end), between = (before + after) * 0.5f;
      before = after;
      depth += between * (end - begin);
      steps_.push_back({begin, end, between, depth});
    }
  }
}

std::size_t DepthProfile::step_at(float t) const {
  return static_cast<std::size_t>(
      std::partition_point(steps_.begin(), steps_.end(), [t](const Step& s) { return s.end <= t; }) -
      steps_.begin());
}

Rgb DepthProfile::depth(float t) const {
  const std::size_t k = step_at(t);
  if (k == steps_.size()) return whole_depth();
  return depth_before(k) + over_length(steps_[k].extinction, std::max(0.0f, t - steps_[k].begin));
}

Rgb DepthProfile::extinction(float t) const {
  const std::size_t k = step_at(t);
  if (k == steps_.size())  // at the very end
    return !steps_.empty() && steps_.back().end == t ? steps_.back().extinction : Rgb(0);
  return t >= steps_[k].begin ? steps_[k].extinction : Rgb(0);
}

template <typename Of>
float DepthProfile::find(float depth, const Of& of) const {
  const auto k =
      static_cast<std::size_t>(std::partition_point(steps_.begin(), steps_.end(),
                                                    [&](const Step& s) { return of(s.depth) <= depth; }) -
                               steps_.begin());
  if (k == steps_.size()) return kInfinity;
  const Step& s = steps_[k];
  return std::min(s.end, s.begin + (depth - of(depth_before(k))) / of(s.extinction));
}

float DepthProfile::place_of(float depth, int channel) const {
  return find(depth, [channel](const Rgb& rgb) { return rgb[channel]; });
}

float DepthProfile::place_of_mean(float depth) const {
  return find(depth, [](const Rgb& rgb) { return mean(rgb); });
}

}  // namespace lumirank::media
