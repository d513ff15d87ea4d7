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

Units::Units(const Bounds3d& box, double min_shape_radius) : origin_(near_origin(box, kFar)) {
  const double radius = box.radius();
  if (!(radius > 0) || !std::isfinite(radius)) return;
  const double power = std::floor(std::log2(radius));
  if (radius < kMinRadius) scale_ = std::exp2(-power);
  if (radius <= kMaxRadius) return;
  const double min_scale = min_shape_radius > 0 ? std::exp2(-std::floor(std::log2(min_shape_radius))) : 1;
  scale_ = std::min(1.0, std::max(kMaxRadius / 2 * std::exp2(-power), min_scale));
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
