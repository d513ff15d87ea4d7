#include "world/units.h"

#include <cmath>

namespace lumirank::world {
namespace {

Rgb times(Rgb value, double factor) {
  if (factor == 1) return value;
  return {static_cast<float>(value.r * factor), static_cast<float>(value.g * factor),
          static_cast<float>(value.b * factor)};
}

}  // namespace

Units::Units(const Bounds3d& box, double smallest_shape) : origin_(near_origin(box, kFar)) {
  const double radius = box.radius();
  if (!(radius > 0) || !std::isfinite(radius)) return;
  const double power = std::floor(std::log2(radius));
  if (radius < kLeastRadius) scale_ = std::exp2(-power);
  if (radius <= kGreatestRadius) return;
  const double least = smallest_shape > 0 ? std::exp2(-std::floor(std::log2(smallest_shape))) : 1;
  scale_ = std::min(1.0, std::max(kGreatestRadius / 2 * std::exp2(-power), least));
}

Transform Units::to_world() const {
  return Transform::scale(scale_, scale_, scale_) * Transform::translate(-origin_.x, -origin_.y, -origin_.z);
}

Vec3f Units::to_world(Vec3d place) const { return static_cast<Vec3f>((place - origin_) * scale_); }

Vec3d Units::place_in_file(Vec3f place) const { return Vec3d(place) * (1 / scale_) + origin_; }

float Units::length_in_file(float length) const { return static_cast<float>(length / scale_); }

Rgb Units::power_to_world(Rgb value) const { return times(value, scale_ * scale_); }
Rgb Units::power_in_file(Rgb value) const { return times(value, 1 / (scale_ * scale_)); }

}  // namespace lumirank::world
