// Spherical light seen from 16 receivers: the cone of directions, how lobes meet it, and what of the integral
// is known in closed form.
#pragma once

#include "base/lane_math.h"
#include "transport/pairs/pair_kernel.h"
#include "transport/pairs/sphere_rules.h"
#include "transport/rows/receivers.h"

namespace lumirank::transport {

// What all spherical pairs of a matrix share.
struct SphereBackground {
  SphereRules rules;
  const Receivers* receivers;
  const VirtualLights* lights;
  std::uint64_t seed;
};

struct SphereGeometry {
  LaneMask alive;
  Lane3 w;
  Lane d2;
  LaneMask inside;
  LaneMask disc;  // I is the disc
};

template <std::uint16_t row_kind, ColumnKind column_kind>
inline SphereGeometry sphere_geometry(const RowGroup& r, const ColumnGroup& c, const PairExtras& extras) {
  SphereGeometry at;
  at.alive = (c.depth >= r.depth_min) & (c.depth <= r.depth_max);
  at.w = c.p - r.p;
  at.d2 = dot(at.w, at.w);
  at.alive &= at.d2 > splat(1e-30f);
  const Lane reach = c.radius * splat(extras.spheres->rules.beyond);
  at.alive &= at.d2 >= reach * reach;
  // The center must be seen past both surfaces, and some of the cone past the shading normals' horizons.
  if (row_kind == kRowLambertian || extras.row_sides == Sides::front)
    at.alive &= (dot(r.ng, at.w) > Lane{}) & (dot(r.n, at.w) > -c.radius);
  if (column_kind == kColumnSphere || extras.column_sides == Sides::front)
    at.alive &= (dot(c.ng, at.w) < Lane{}) & (dot(c.n, at.w) < c.radius);
  const Lane r2 = c.radius * c.radius;
  at.inside = at.d2 <= r2;
  at.disc = at.d2 < r2 * splat(kDiscReach * kDiscReach);
  if (extras.spheres->rules.indicator == SphereRules::Indicator::cosine) at.disc = LaneMask{};
  // A fiber has no tangent plane.
  if (column_kind == kColumnScatterSphere && extras.column_sides == Sides::fiber) at.disc = LaneMask{};
  return at;
}

// Where the receiver's surface hides part of the disc that the light knows to be hidden: by how much less
// area the light's energy lies on. The circle's part below a chord at height t radii, from the receiver's
// plane.
inline Lane shown_share(const RowGroup& r, const ColumnGroup& c, const SphereGeometry& at) {
  const Lane across = dot(r.ng, c.ng);
  const Lane tilt = sqrt(max(splat(1) - across * across, splat(1e-8f)));
  const Lane t = max(min(dot(r.ng, at.w) / (tilt * c.radius), splat(1)), splat(-1));
  const Lane below = splat(0.5f) - (arc_sine(t) + t * sqrt(max(splat(1) - t * t, Lane{}))) * splat(kInvPi);
  return select(at.disc, splat(1) - min(below, c.hidden), splat(1));
}

// Any frame around unit normals, as Frame::from_normal.
inline void any_frame(const Lane3& n, Lane3& s, Lane3& t) {
  const Lane one = splat(1);
  const Lane sign = select(n.z < Lane{}, -one, one);
  const Lane a = -one / (sign + n.z), b = n.x * n.y * a;
  s = {one + sign * n.x * n.x * a, sign * b, -(sign * n.x)};
  t = {b, sign + n.y * n.y * a, -n.y};
}

// Directions uniform in the cones of 16 pairs.
struct ConeSampler {
  Lane3 axis, s, t;
  Lane below;  // 1 - cosine of the half angle

  ConeSampler(const Lane3& axis_, Lane below_) : axis(axis_), below(below_) { any_frame(axis, s, t); }
  Lane3 direction(Lane u, Lane v) const {
    const Lane low = u * below;
    const Lane radius = sqrt(max(low * (splat(2) - low), Lane{}));
    Lane sine, cosine;
    sin_cos_turns(v, sine, cosine);
    return axis * (splat(1) - low) + s * (radius * cosine) + t * (radius * sine);
  }
};

// ∫ cosθx cosθy dl over a cone that lies above both horizons.
inline Lane cosines_over_cone(const RowGroup& r, const ColumnGroup& c, const Lane3& axis, Lane cosine,
                              Lane below) {
  // ∫ l lᵀ dl = a·1 + b·axis axisᵀ.
  const Lane whole = splat(2 * kPi) * below;
  const Lane along = splat(2 * kPi / 3) * below * (splat(1) + cosine + cosine * cosine);
  const Lane a = splat(0.5f) * (whole - along), b = splat(1.5f) * along - splat(0.5f) * whole;
  return -(a * dot(r.n, c.ng) + b * (dot(r.n, axis) * dot(c.ng, axis)));
}

// How many widths of its lobe the cone has, where they overlap.
inline Lane lobe_widths(const LobeCones& lobe, const Lane3& axis, Lane cosine, Lane sine, Lane solid_angle) {
  const Lane cos_both = cosine * lobe.cos_reach - sine * lobe.sin_reach;
  const Lane sin_both = sine * lobe.cos_reach + cosine * lobe.sin_reach;
  const LaneMask near = (dot(axis, lobe.axis) > cos_both) | (sin_both < Lane{});
  return select(near, solid_angle * lobe.per_solid_angle, Lane{});
}

}  // namespace lumirank::transport
