// The unoccluded contribution E of 16 receiver-light pairs; what an entry is: see SceneMatrix.
#pragma once

#include <cstdint>

#include "transport/kernels/groups.h"
#include "transport/kernels/lanes.h"
#include "transport/kernels/scatter_group.h"
#include "transport/virtual_lights.h"

namespace lumirank::transport {

// What a kernel needs beside the two groups; null where the class of receiver or light does without.
struct PairExtras {
  const ScatterGroup* row = nullptr;
  const ScatterGroup* column = nullptr;
  const SpotShape* const* spots = nullptr;  // 16
  float clamp = kInfinity;                  // X
};

struct PairResult {
  Lane3 e;
  Lane excess;          // unclamped / clamped - 1; only where `clamped`
  std::uint32_t alive;  // lanes with E ≠ 0
  std::uint32_t clamped;
};

// 1 within the beam, 0 beyond the cutoff, linear in the angle between.
inline float spot_fall_off(const SpotShape& spot, float cosine) {
  if (cosine >= spot.cos_beam) return 1;
  if (cosine <= spot.cos_cutoff) return 0;
  return (spot.cutoff - std::acos(cosine)) / (spot.cutoff - spot.beam);
}

template <std::uint16_t row_kind, ColumnKind column_kind>
inline PairResult evaluate_pair(const RowGroup& r, const ColumnGroup& c, const PairExtras& extras) {
  constexpr bool directional = column_kind == kColumnDirectional;
  constexpr bool facing = column_kind == kColumnFacing;
  constexpr bool scattering_row = row_kind == kRowScatter;
  constexpr bool scattering_column = column_kind == kColumnScatter;
  const Lane zero{};

  LaneMask alive = (c.depth >= r.depth_min) & (c.depth <= r.depth_max);
  // w is not normalised; inv = 1/d².
  Lane3 w;
  Lane inv, inv_d;
  if constexpr (directional) {
    w = c.target;
    inv = inv_d = splat(1);
  } else {
    w = c.p - r.p;
    const Lane d2 = dot(w, w);
    alive &= d2 > splat(1e-30f);
    inv = splat(1) / select(alive, d2, splat(1));
    if constexpr (!facing || scattering_row) inv_d = sqrt(inv);
  }

  const Lane cos_x = dot(r.n, w);
  if constexpr (!scattering_row) alive &= (cos_x > zero) & (dot(r.ng, w) > zero);
  // The geometric term of the kind of light: cosθx·cosθy/d², cosθx/d² or cosθx.
  Lane g;
  if constexpr (facing || scattering_column) {
    const Lane cos_y = -dot(c.ng, w);  // see VirtualLights::power about ng
    if constexpr (facing) alive &= (cos_y > zero) & (dot(c.n, w) < zero);
    g = (abs(cos_x) * inv) * (abs(cos_y) * inv);
  } else if constexpr (directional) {
    g = abs(cos_x);
  } else {
    g = (abs(cos_x) * inv) * inv_d;
  }

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
  if constexpr (column_kind == kColumnSpot) {
    const Lane cosine = -(dot(c.n, w) * inv_d);
    Lane fall_off;
    for (int k = 0; k < kLanes; ++k)
      fall_off[k] = extras.spots[k] ? spot_fall_off(*extras.spots[k], cosine[k]) : 0;
    power = power * fall_off;
  }

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

  // Libraries may leave some threads flushing denormal numbers to zero and others not; here all do, well
  // above them.
  const Lane3 e = (f * power) * g;
  const Lane least = splat(1e-35f);
  out.e = {select(alive & (e.x > least), e.x, zero), select(alive & (e.y > least), e.y, zero),
           select(alive & (e.z > least), e.z, zero)};
  alive &= max_component(out.e) > zero;
  out.alive = bits(alive);
  return out;
}

}  // namespace lumirank::transport
