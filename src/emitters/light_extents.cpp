#include "emitters/light_extents.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#ifdef __AVX__
#include <immintrin.h>
#endif

namespace lumirank::emitters {

LightExtents::Lane LightExtents::sqrt(Lane a) {
#ifdef __AVX__
  return reinterpret_cast<Lane>(_mm256_sqrt_ps(reinterpret_cast<__m256>(a)));
#else
  Lane r;
  for (int k = 0; k < kCount; ++k) r[k] = std::sqrt(a[k]);
  return r;
#endif
}

LightExtents::Angle LightExtents::angle(Lane cosine) {
  const Lane sine2 = 1 - cosine * cosine;
  return {cosine, sqrt(sine2 > 0 ? sine2 : Lane{})};
}

// max(0, a - b) for angles in [0, π].
LightExtents::Angle LightExtents::less(Angle a, Angle b) {
  const auto none = a.cosine >= b.cosine;
  return {none ? Lane{} + 1 : a.cosine * b.cosine + a.sine * b.sine,
          none ? Lane{} : a.sine * b.cosine - a.cosine * b.sine};
}

LightExtents::LightExtents() : radius2_(Lane{} + 1) {}

void LightExtents::set(int k, const LightBound& bound) {
  const Vec3f center = bound.bounds.center();
  center_x_[k] = center.x, center_y_[k] = center.y, center_z_[k] = center.z;
  // Wide enough for the rounding of the center, and never so small that 1/d² loses all measure.
  const float rounding = 1e-6f * std::max({std::abs(center.x), std::abs(center.y), std::abs(center.z)});
  radius2_[k] = std::max(1e-16f, square(bound.bounds.radius() + rounding));
  axis_x_[k] = bound.axis.x, axis_y_[k] = bound.axis.y, axis_z_[k] = bound.axis.z;
  const bool all_round = bound.spread >= kPi;
  spread_.cosine[k] = all_round ? -1.0f : std::cos(bound.spread);
  spread_.sine[k] = all_round ? 0.0f : std::sin(bound.spread);
  min_cosine_[k] = bound.reach >= kPi / 2 ? 0.0f : std::cos(bound.reach);
  intensity_[k] = bound.intensity;
}

void LightExtents::importance(const LitPoint& at, float out[kCount]) const {
  constexpr float kSlack = 1e-3f;
  const Lane zero{}, one = zero + 1;
  const Lane x = center_x_ - at.position.x, y = center_y_ - at.position.y, z = center_z_ - at.position.z;
  const Lane center2 = x * x + y * y + z * z;
  // Inside the sphere every direction is possible, and the distance says nothing.
  const auto inside = center2 <= radius2_;
  const Lane d2 = inside ? radius2_ : center2;
  const Lane inv2 = 1 / d2, inv = sqrt(inv2);
  const Lane sin2_size = radius2_ * inv2, cos2_size = 1 - sin2_size;
  const Angle size{sqrt(cos2_size > 0 ? cos2_size : zero), sqrt(sin2_size)};

  const Lane leaving = -(axis_x_ * x + axis_y_ * y + axis_z_ * z) * inv;
  const Lane emitted = inside ? one : less(less(angle(leaving), spread_), size).cosine + kSlack;
  const Lane facing = (at.normal.x * x + at.normal.y * y + at.normal.z * z) * inv;
  const Lane facing_back = at.both_sides ? -facing : facing;
  Lane received =
      inside ? one : less(angle(facing > facing_back ? facing : facing_back), size).cosine + kSlack;
  if (at.normal == Vec3f{}) received = one;

  const Lane value = intensity_ * emitted * received * inv2;
  const Lane result = emitted > min_cosine_ ? (received > 0 ? value : zero) : zero;
  std::memcpy(out, &result, sizeof result);
}

}  // namespace lumirank::emitters
