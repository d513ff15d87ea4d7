// E of 16 pairs of a receiver and a spherical light (SphereRules). Most integrals are taken in lanes: in
// closed form between lambertian ends, else by few directions in the cone. A pair where a lobe is much
// narrower than the cone goes to sphere_integral() by itself.
#pragma once

#include "transport/kernels/lane_math.h"
#include "transport/kernels/pair_kernel.h"
#include "transport/receivers.h"
#include "transport/sphere_integral.h"
#include "transport/sphere_rules.h"

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
  // The centre must be seen past both surfaces, and some of the cone past the shading normals' horizons.
  if (row_kind == kRowLambertian || !extras.row_transmits)
    at.alive &= (dot(r.ng, at.w) > Lane{}) & (dot(r.n, at.w) > -c.radius);
  if (column_kind == kColumnSphere || !extras.column_transmits)
    at.alive &= (dot(c.ng, at.w) < Lane{}) & (dot(c.n, at.w) < c.radius);
  const Lane r2 = c.radius * c.radius;
  at.inside = at.d2 <= r2;
  at.disc = at.d2 < r2 * splat(kDiscReach * kDiscReach);
  if (extras.spheres->rules.indicator == SphereRules::Indicator::cosine) at.disc = LaneMask{};
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

// Directions uniform in the cones of 16 pairs.
struct ConeSampler {
  Lane3 axis, s, t;
  Lane below;  // 1 - cosine of the half angle

  ConeSampler(const Lane3& axis_, Lane below_) : axis(axis_), below(below_) {
    // Any frame, as Frame::from_normal.
    const Lane one = splat(1);
    const Lane sign = select(axis.z < Lane{}, -one, one);
    const Lane a = -one / (sign + axis.z), b = axis.x * axis.y * a;
    s = {one + sign * axis.x * axis.x * a, sign * b, -(sign * axis.x)};
    t = {b, sign + axis.y * axis.y * a, -axis.y};
  }
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
inline Lane lobe_widths(const LobeCones& lobe, const Lane3& axis, Lane cosine, Lane solid_angle) {
  const Lane sine = sqrt(max(splat(1) - cosine * cosine, Lane{}));
  const Lane cos_both = cosine * lobe.cos_reach - sine * lobe.sin_reach;
  const Lane sin_both = sine * lobe.cos_reach + cosine * lobe.sin_reach;
  const LaneMask near = (dot(axis, lobe.axis) > cos_both) | (sin_both < Lane{});
  return select(near, solid_angle * lobe.per_solid_angle, Lane{});
}

// Where the cone's own size decides, a hemisphere gets kSamplesOfDisc; a lobe's width kSamplesPerWidth.
// Beyond kMostWidths, the lobe itself is sampled.
inline constexpr float kSamplesOfDisc = 32, kLeastOfDisc = 4, kSamplesPerWidth = 2, kMostWidths = 4;

// f and e: ∫ f_x cosθx f_y I dl by uniform directions, `count` of them per lane.
template <std::uint16_t row_kind, ColumnKind column_kind>
inline Lane3 integrate_in_lanes(const RowGroup& r, const ColumnGroup& c, const PairExtras& extras,
                                const SphereGeometry& at, const ConeSampler& cone, Lane count) {
  const Lane zero{};
  LaneBits key, other;
  for (int k = 0; k < kLanes; ++k)
    key[k] = extras.row_keys[k] * 0x9e3779b9u ^ static_cast<std::uint32_t>(extras.spheres->seed),
    other[k] = extras.column_items[k];
  key = mix(mix(key) ^ other);
  const Lane u0 = unit_lane(key), v0 = unit_lane(mix(key ^ 0x68bc21ebu));
  const Lane inv = splat(1) / max(count, splat(1));
  const Lane height = dot(c.ng, at.w), r2 = c.radius * c.radius;
  const LaneMask discs = at.disc;
  Lane3 sum{zero, zero, zero};
  for (int k = 0;; ++k) {
    const Lane number = splat(static_cast<float>(k));
    const LaneMask more = number < count;
    if (bits(more) == 0) break;
    Lane v = v0 + splat(static_cast<float>(k) * 0.618033989f);
    v = v - floor(v);
    const Lane3 l = cone.direction((number + u0) * inv, v);
    const Lane slope = dot(c.ng, l);
    LaneMask lit = more & (slope * height > zero);
    const Lane3 off = l * (height / select(lit, slope, splat(1))) - at.w;
    lit &= ~discs | (dot(off, off) < r2);
    const Lane cos_x = dot(r.n, l);
    if constexpr (row_kind == kRowLambertian) lit &= (cos_x > zero) & (dot(r.ng, l) > zero);
    if constexpr (column_kind == kColumnSphere) lit &= dot(c.n, l) < zero;
    if (bits(lit) == 0) continue;
    const Lane weight = select(lit, abs(cos_x) * select(discs, splat(1), abs(slope)), zero);
    Lane3 f{splat(1), splat(1), splat(1)};
    if constexpr (row_kind == kRowScatter) f = eval_f(*extras.row, l, LaneMask{});
    if constexpr (column_kind == kColumnScatterSphere)
      f = f * eval_f(*extras.column, l * splat(-1), LaneMask{});
    sum = sum + select(lit, f * weight, Lane3{zero, zero, zero});
  }
  return sum * (splat(2 * kPi) * cone.below * inv);
}

// v / f; 0 where both are.
inline Rgb without(Rgb v, Rgb f) {
  return {f.r > 0 ? v.r / f.r : 0, f.g > 0 ? v.g / f.g : 0, f.b > 0 ? v.b / f.b : 0};
}

template <std::uint16_t row_kind, ColumnKind column_kind>
inline PairResult evaluate_sphere(const RowGroup& r, const ColumnGroup& c, const PairExtras& extras) {
  constexpr bool scattering_row = row_kind == kRowScatter;
  constexpr bool scattering_column = column_kind == kColumnScatterSphere;
  const Lane zero{}, one = splat(1);
  const SphereRules& rules = extras.spheres->rules;
  const SphereGeometry at = sphere_geometry<row_kind, column_kind>(r, c, extras);
  LaneMask alive = at.alive & mask_from_bits(extras.wanted);
  PairResult out{};
  out.e = {zero, zero, zero};
  if (bits(alive) == 0) return out;

  const Lane r2 = c.radius * c.radius;
  const Lane sin2 = select(at.inside, one, r2 / select(alive, at.d2, one));
  const Lane cosine = sqrt(max(one - sin2, zero));
  const Lane below = select(at.inside, one, sin2 / (one + cosine));
  const Lane inv_d = one / sqrt(select(alive, at.d2, one));
  const Lane3 centre = at.w * inv_d;
  const Lane side = select(dot(r.n, at.w) < zero, -one, one);
  const Lane3 axis = select(at.inside, r.n * side, centre);

  // How many directions, and who takes them.
  const bool by_cone = rules.samples == SphereRules::Samples::cone;
  const bool all = rules.strategies == SphereRules::Strategies::all;
  Lane count = splat(by_cone ? kSamplesInHemisphere : kSamplesOfDisc) * below;
  Lane row_widths{}, column_widths{};
  LaneMask apart{};
  Lane3 value{zero, zero, zero};
  if constexpr (!scattering_row && !scattering_column) {
    count = max(count, splat(kLeastOfDisc));
    const LaneMask closed = ~at.disc & ~at.inside & (dot(r.n, at.w) > c.radius) &
                            (dot(r.ng, at.w) > c.radius) & (dot(c.ng, at.w) < -c.radius) &
                            (dot(c.n, at.w) < -c.radius);
    const Lane product = max(cosines_over_cone(r, c, axis, cosine, below), zero);
    value = select(closed & alive, Lane3{product, product, product}, value);
    count = select(closed, zero, count);
  } else if (by_cone) {
    if (all) apart = alive;
  } else {
    const Lane solid_angle = splat(2 * kPi) * below;
    if constexpr (scattering_row) row_widths = lobe_widths(extras.row->cones, axis, cosine, solid_angle);
    if constexpr (scattering_column) {
      const LobeCones& lobe = extras.column->cones;
      column_widths = select(at.inside, solid_angle * lobe.per_solid_angle,
                             lobe_widths(lobe, axis * splat(-1), cosine, solid_angle));
    }
    const Lane widths = row_widths + column_widths;
    count = max(select(at.disc, max(count, splat(kLeastOfDisc)), one), widths * splat(kSamplesPerWidth));
    if (all) apart = alive & (widths > splat(kMostWidths));
  }
  count = select(count > zero, floor(max(min(count, splat(kSamplesInHemisphere)), one) + splat(0.5f)), zero);
  const std::uint32_t lanes = bits(alive & ~apart & (count > zero));
  if (lanes != 0) {
    const LaneMask here = mask_from_bits(lanes);
    const Lane3 sampled = integrate_in_lanes<row_kind, column_kind>(
        r, c, extras, at, ConeSampler(axis, below), select(here, count, zero));
    value = select(here, sampled, value);
  }
  for (std::uint32_t b = bits(apart); b != 0; b &= b - 1) {
    const int k = __builtin_ctz(b);
    const std::uint32_t i = extras.row_items[k], j = extras.column_items[k];
    const Receivers& receivers = *extras.spheres->receivers;
    const VirtualLights& lights = *extras.spheres->lights;
    const scatter::Closure x = receivers.closure_at(i), y = lights.closure_at(j);
    const SphereEnds ends{x,
                          y,
                          receivers.wo[i],
                          lights.incoming[j],
                          {r.n.x[k], r.n.y[k], r.n.z[k]},
                          {c.ng.x[k], c.ng.y[k], c.ng.z[k]},
                          {at.w.x[k], at.w.y[k], at.w.z[k]},
                          c.radius[k],
                          at.disc[k] != 0};
    SphereSamples samples;
    if (by_cone) {
      samples.cone = samples.receiver = samples.light = (static_cast<int>(count[k]) + 2) / 3;
    } else {
      // A narrow lobe is met by one sample of its own; where two meet, each is noise to the other's.
      const bool both = row_widths[k] > 1 && column_widths[k] > 1;
      samples.cone = std::clamp(static_cast<int>(kSamplesOfDisc * below[k]), 1, 8);
      samples.receiver = row_widths[k] > 1 ? (both ? 3 : 1) : 0;
      samples.light = column_widths[k] > 1 ? (both ? 3 : 1) : 0;
    }
    Rgb v = sphere_integral(ends, samples, mix64(extras.spheres->seed ^ extras.row_keys[k]) ^ j);
    // What the groups hold of matt ends comes in below.
    if constexpr (!scattering_row) v = without(v, {r.f.x[k], r.f.y[k], r.f.z[k]});
    if constexpr (!scattering_column) v = without(v, lights.albedo[j] * kInvPi);
    value.x[k] = v.r, value.y[k] = v.g, value.z[k] = v.b;
  }

  Lane3 f = c.power;
  if constexpr (!scattering_row) f = f * r.f;
  Lane3 e = f * value;
  if (bits(alive & at.disc) != 0) e = e * (one / shown_share(r, c, at));
  if (extras.clamp < kInfinity) {
    // a_j·G·(π f_x)(π f_y) as for points, averaged over the sphere.
    Lane bound = c.clamp_area * max_component(value) / r2;
    if constexpr (!scattering_row) bound = bound * max_component(r.f);
    if constexpr (scattering_column) bound = bound * splat(kPi);
    const LaneMask over = alive & (bound > splat(extras.clamp));
    out.clamped = bits(over);
    if (out.clamped != 0) {
      e = e * select(over, splat(extras.clamp) / select(over, bound, one), one);
      out.excess = bound / splat(extras.clamp) - one;
    }
  }
  const Lane least = splat(1e-35f);
  out.e = {select(alive & (e.x > least), e.x, zero), select(alive & (e.y > least), e.y, zero),
           select(alive & (e.z > least), e.z, zero)};
  alive &= max_component(out.e) > zero;
  out.alive = bits(alive);
  return out;
}

}  // namespace lumirank::transport
