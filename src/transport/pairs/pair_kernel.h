// The unoccluded contribution E of 16 receiver-light pairs; what an entry is: see SceneMatrix.
#pragma once

#include <cstdint>

#include "base/lanes.h"
#include "transport/lights/virtual_lights.h"
#include "transport/pairs/groups.h"
#include "transport/pairs/scatter_group.h"

namespace lumirank::transport {

struct SphereBackground;  // sphere_kernel.h

// What a kernel needs beside the two groups; null where the class of receiver or light does without.
struct PairExtras {
  const ScatterGroup* row = nullptr;
  const ScatterGroup* column = nullptr;
  const SpotShape* const* spots = nullptr;                            // 16
  float clamp = kInfinity;                                            // X
  const SphereBackground* spheres = nullptr;                          // where lights are spherical
  const std::uint32_t *row_items = nullptr, *column_items = nullptr;  // 16 each; spherical lights only
  const std::uint32_t *row_keys = nullptr, *column_keys = nullptr;    // of random numbers
  std::uint32_t wanted = 0xffff;  // lanes that will be read; others may be left out
  Sides row_sides = Sides::front, column_sides = Sides::front;
};

struct PairResult {
  Lane3 e;
  Lane excess;          // unclamped / clamped - 1; only where `clamped`
  std::uint32_t alive;  // lanes with E ≠ 0
  std::uint32_t clamped;
};

// Notes E and which lanes have any. Libraries may leave some threads flushing denormal numbers to zero and
// others not; here all do, well above them.
inline void note_values(PairResult& out, const Lane3& e, LaneMask alive) {
  const Lane zero{}, min_value = splat(1e-35f);
  out.e = {select(alive & (e.x > min_value), e.x, zero), select(alive & (e.y > min_value), e.y, zero),
           select(alive & (e.z > min_value), e.z, zero)};
  out.alive = bits(alive & (max_component(out.e) > zero));
}

// 1 within the beam, 0 beyond the cutoff, linear in the angle between.
inline float spot_fall_off(const SpotShape& spot, float cosine) {
  if (cosine >= spot.cos_beam) return 1;
  if (cosine <= spot.cos_cutoff) return 0;
  return (spot.cutoff - std::acos(cosine)) / (spot.cutoff - spot.beam);
}

// Of the intensity on the axis, or of the profile's unit; `direction` (unit) is away from the light.
inline Rgb spot_share(const SpotShape& spot, float cosine, Vec3f direction) {
  return spot.profile ? spot.profile->intensity(spot.frame.to_local(direction))
                      : Rgb(spot_fall_off(spot, cosine));
}

// What depends on the places and normals alone.
struct PairGeometry {
  LaneMask alive;     // E may differ from 0
  Lane3 w;            // from receiver to light, not normalized; directional: towards the light
  Lane inv, inv_d;    // 1/d², 1/d; directional: 1
  Lane cos_x, cos_y;  // cosines (of a fiber: sines), times d; see VirtualLights::power about ng
  Lane spot_cosine;   // spots: between the axis and the way to the receiver
};

// The length of t × w: the sine of the angle between a fiber and a direction, times the latter's length.
inline Lane fiber_sine(const Lane3& t, const Lane3& w) {
  const Lane3 c{t.y * w.z - t.z * w.y, t.z * w.x - t.x * w.z, t.x * w.y - t.y * w.x};
  return sqrt(dot(c, c));
}

// Culling and evaluation share these lines, so that they agree to the last bit about what is 0.
template <std::uint16_t row_kind, ColumnKind column_kind>
inline PairGeometry pair_geometry(const RowGroup& r, const ColumnGroup& c, const PairExtras& extras) {
  constexpr bool sided_column = column_kind == kColumnFacing || column_kind == kColumnScatter;
  const Lane zero{};
  PairGeometry at;
  at.alive = (c.depth >= r.depth_min) & (c.depth <= r.depth_max);
  if constexpr (column_kind == kColumnDirectional) {
    at.w = c.target;
    at.inv = at.inv_d = splat(1);
  } else {
    at.w = c.p - r.p;
    const Lane d2 = dot(at.w, at.w);
    at.alive &= d2 > splat(1e-30f);
    if constexpr (sided_column) at.alive &= d2 >= c.near;
    at.inv = splat(1) / select(at.alive, d2, splat(1));
    at.inv_d = sqrt(at.inv);
  }
  if (row_kind != kRowLambertian && extras.row_sides == Sides::fiber) {
    at.cos_x = fiber_sine(r.n, at.w);
  } else {
    at.cos_x = dot(r.n, at.w);
    if (row_kind == kRowLambertian || extras.row_sides == Sides::front)
      at.alive &= (at.cos_x > zero) & (dot(r.ng, at.w) > zero);
  }
  if constexpr (sided_column) {
    if (column_kind == kColumnScatter && extras.column_sides == Sides::fiber) {
      at.cos_y = fiber_sine(c.n, at.w);
    } else {
      at.cos_y = -dot(c.ng, at.w);
      if (column_kind == kColumnFacing || extras.column_sides == Sides::front)
        at.alive &= (at.cos_y > zero) & (dot(c.n, at.w) < zero);
    }
  }
  if constexpr (column_kind == kColumnSpot) {
    at.spot_cosine = -(dot(c.n, at.w) * at.inv_d);
    Lane cutoff;
    for (int k = 0; k < kLanes; ++k) cutoff[k] = extras.spots[k] ? extras.spots[k]->cos_cutoff : 2;
    at.alive &= at.spot_cosine > cutoff;
  }
  return at;
}

// The lanes that may have E ≠ 0: few others are traced in vain.
template <std::uint16_t row_kind, ColumnKind column_kind>
inline std::uint32_t cull_pair(const RowGroup& r, const ColumnGroup& c, const PairExtras& extras) {
  return bits(pair_geometry<row_kind, column_kind>(r, c, extras).alive);
}

// The geometric term of the kind of light: cosθx·cosθy/d², cosθx/d² or cosθx.
template <ColumnKind column_kind>
[[gnu::always_inline]] inline Lane geometric_term(const PairGeometry& at) {
  if constexpr (column_kind == kColumnFacing || column_kind == kColumnScatter)
    return (abs(at.cos_x) * at.inv) * (abs(at.cos_y) * at.inv);
  else if constexpr (column_kind == kColumnDirectional)
    return abs(at.cos_x);
  else
    return (abs(at.cos_x) * at.inv) * at.inv_d;
}

// spot_share() of the spots, 0 where nothing arrives.
[[gnu::always_inline]] inline Lane3 spot_shares(const PairExtras& extras, const PairGeometry& at) {
  Lane3 shares{};
  const Lane3 away = at.w * (-at.inv_d);
  for (int k = 0; k < kLanes; ++k) {
    if (!(extras.spots[k] && (bits(at.alive) >> k & 1))) continue;
    const Rgb share = spot_share(*extras.spots[k], at.spot_cosine[k], {away.x[k], away.y[k], away.z[k]});
    shares.x[k] = share.r, shares.y[k] = share.g, shares.z[k] = share.b;
  }
  return shares;
}

template <std::uint16_t row_kind, ColumnKind column_kind>
inline PairResult evaluate_pair(const RowGroup& r, const ColumnGroup& c, const PairExtras& extras) {
  constexpr bool facing = column_kind == kColumnFacing;
  constexpr bool scattering_row = row_kind == kRowScatter;
  constexpr bool scattering_column = column_kind == kColumnScatter;
  const Lane zero{};
  const PairGeometry at = pair_geometry<row_kind, column_kind>(r, c, extras);
  const Lane3 w = at.w;
  const Lane inv_d = at.inv_d;
  const LaneMask alive = at.alive;
  Lane g = geometric_term<column_kind>(at);
  PairResult out;
  out.clamped = 0;
  out.excess = zero;
  if (bits(alive) == 0) {
    out.e = {zero, zero, zero};
    out.alive = 0;
    return out;
  }

  Lane3 f = r.f, power = c.power;
  Lane clamp_area = c.clamp_area;
  if constexpr (scattering_row) f = eval_f(*extras.row, w * inv_d, c.depth < splat(0.5f));
  if constexpr (scattering_column) {
    const Lane3 fy = eval_f(*extras.column, w * (-inv_d), LaneMask{});
    power = power * fy;
    clamp_area = clamp_area * (max_component(fy) * splat(kPi));
  }
  if constexpr (column_kind == kColumnSpot) power = power * spot_shares(extras, at);

  if constexpr (facing || scattering_column) {
    const Lane bound = (clamp_area * (max_component(f) * splat(kPi))) * g;
    const LaneMask over = alive & (bound > splat(extras.clamp));
    out.clamped = bits(over);
    if (out.clamped != 0) {
      const Lane safe = select(over, bound, splat(1));
      g = select(over, g * (splat(extras.clamp) / safe), g);
      out.excess = bound / splat(extras.clamp) - splat(1);
    }
  }

  note_values(out, (f * power) * g, alive);
  return out;
}

}  // namespace lumirank::transport
