// Where along rays the integrals of pairs with a ray in them are sampled, 16 pairs at a time.
//
// A point and a ray: equiangular (as in base/equiangular.h). Two rays: jointly, first on the light by the
// integral of 1/d² over the whole of the other line, then equiangular on the other (Novák et al. 2012,
// section 4.2: "joint importance sampling" for isotropic media).
#pragma once

#include "base/lane_math.h"

namespace lumirank::transport {

struct RayPlaces {
  Lane t;    // along the ray
  Lane pdf;  // per length; 0: nothing can be drawn
};

inline Lane3 cross(const Lane3& a, const Lane3& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

// Spread evenly over the length.
inline RayPlaces sample_evenly(Lane length, Lane u) { return {u * length, splat(1) / length}; }

// On origin + t·direction, 0 ≤ t ≤ length, with a density in proportion to 1/d² from `point`.
inline RayPlaces sample_equiangular(const Lane3& origin, const Lane3& direction, Lane length,
                                    const Lane3& point, Lane u) {
  const Lane zero{}, one = splat(1);
  const Lane3 to_point = point - origin;
  const Lane closest = dot(to_point, direction);
  const Lane3 off = to_point - direction * closest;
  const Lane h = max(sqrt(dot(off, off)), splat(1e-6f) * length), h2 = h * h;
  // Both ends as the point sees them, counted from the closest place of the line.
  const Lane begin = -closest, end = length - closest;
  const Lane to_begin = one / sqrt(h2 + begin * begin), to_end = one / sqrt(h2 + end * end);
  const Lane cosine = (h2 + begin * end) * to_begin * to_end, sine = h * length * to_begin * to_end;
  const Lane acute = angle_of(min(abs(cosine), one), sine);
  const Lane angle = select(cosine < zero, splat(kPi) - acute, acute);
  // The direction to the beginning, turned by a part of the angle.
  Lane turned_sine, turned_cosine;
  sin_cos_turns(angle * u * splat(0.5f * kInvPi), turned_sine, turned_cosine);
  const Lane x = h * turned_cosine - begin * turned_sine, y = begin * turned_cosine + h * turned_sine;
  // By rounding alone the direction may not meet the line at all: then it is the end.
  const Lane met = select(x > zero, h * y / x, end);
  const Lane along = min(max(met, begin), end);
  const LaneMask some = (angle > zero) & (length > zero);
  return {min(max(closest + along, zero), length),
          select(some, h / (select(some, angle, one) * (h2 + along * along)), zero)};
}

// On the first of two rays, with a density in proportion to 1/(distance to the second's line):
// ∫ 1/d² over a line is π over the distance to it.
inline RayPlaces sample_near_line(const Lane3& origin, const Lane3& direction, Lane length,
                                  const Lane3& line_origin, const Lane3& line_direction, Lane u) {
  // The distance of origin + t·direction to the line is √(h² + sin²·(t - closest)²).
  const Lane3 normal = cross(direction, line_direction);
  const Lane zero{}, least = splat(1e-8f), cross2 = dot(normal, normal);
  const Lane sine2 = max(cross2, least), sine = sqrt(sine2);
  const Lane3 between = line_origin - origin;
  const Lane closest = dot(cross(between, line_direction), normal) / sine2;
  const Lane h = max(abs(dot(between, normal)) / sine, splat(1e-6f) * length);
  const Lane scale = sine / h;
  const Lane begin = -closest * scale, end = (length - closest) * scale;
  const Lane first = arsinh(begin), spread = arsinh(end) - first;
  const Lane met = min(max(sinh(first + spread * u), begin), end);
  // Of lines that are parallel, or far apart for the length, the distance is nearly the same everywhere, and
  // rounding would tell more in the difference above than it does.
  const LaneMask apart = (cross2 > least) & (spread > splat(1.0f / 64));
  const RayPlaces even = sample_evenly(length, u);
  const Lane density = scale / (select(apart, spread, splat(1)) * sqrt(splat(1) + met * met));
  return {select(apart, min(max(closest + met / scale, zero), length), even.t),
          select(apart, density, even.pdf)};
}

}  // namespace lumirank::transport
