// E of 16 pairs of a receiver and a spherical light (SphereRules). Most integrals are taken in lanes: in
// closed form between lambertian ends, else by few directions. Pairs whose BSDFs themselves have to be
// sampled go to sphere_integral() one by one.
#pragma once

#include "transport/pairs/sphere_integral.h"
#include "transport/pairs/sphere_samples.h"

namespace lumirank::transport {

// Where the cone's own size decides, a hemisphere gets kSamplesOfDisc; a lobe's width kSamplesPerWidth.
// Beyond kMaxWidths, lobes are followed.
inline constexpr float kSamplesOfDisc = 32, kMinOfDisc = 4, kSamplesPerWidth = 2, kMaxWidths = 4;

// v / f; 0 where both are.
inline Rgb without(Rgb v, Rgb f) {
  return {f.r > 0 ? v.r / f.r : 0, f.g > 0 ? v.g / f.g : 0, f.b > 0 ? v.b / f.b : 0};
}

// The steps of evaluate_sphere() are inlined by force: calls would spill their sixteen lanes.

// A sphere as seen by its receiver.
struct SphereView {
  Lane cosine, below;  // of half the cone's angle; 1 - cosine
  Lane inv_d;
  Lane3 center;    // the direction to the light
  Lane3 axis;      // of the cone; from inside, of the receiver's hemisphere
  bool row_fiber;  // then the hemisphere is the one towards the light
};

template <std::uint16_t row_kind>
[[gnu::always_inline]] inline SphereView view_sphere(const RowGroup& r, const ColumnGroup& c,
                                                     const PairExtras& extras, const SphereGeometry& at,
                                                     LaneMask alive) {
  const Lane zero{}, one = splat(1);
  SphereView out;
  const Lane sin2 = select(at.inside, one, (c.radius * c.radius) / select(alive, at.d2, one));
  out.cosine = sqrt(max(one - sin2, zero));
  out.below = select(at.inside, one, sin2 / (one + out.cosine));
  out.inv_d = one / sqrt(select(alive, at.d2, one));
  out.center = at.w * out.inv_d;
  out.row_fiber = row_kind == kRowScatter && extras.row_sides == Sides::fiber;
  const Lane side = select(dot(r.n, at.w) < zero, -one, one);
  out.axis = out.row_fiber ? out.center : select(at.inside, r.n * side, out.center);
  return out;
}

// How many directions a pair gets, and who takes them.
struct SpherePlan {
  Lane count;                          // whole; 0 where `closed` is the integral
  Lane3 closed;                        // of lambertian ends that see all of each other
  Lane row_widths{}, column_widths{};  // of the cone, in widths of the lobes of either end
  LaneMask apart{};                    // pairs for sphere_integral()
};

template <std::uint16_t row_kind, ColumnKind column_kind>
[[gnu::always_inline]] inline SpherePlan plan_sphere(const RowGroup& r, const ColumnGroup& c,
                                                     const PairExtras& extras, const SphereGeometry& at,
                                                     const SphereView& view, LaneMask alive) {
  constexpr bool scattering_row = row_kind == kRowScatter;
  constexpr bool scattering_column = column_kind == kColumnScatterSphere;
  const Lane zero{}, one = splat(1);
  const SphereRules& rules = extras.spheres->rules;
  const bool by_cone = rules.samples == SphereRules::Samples::cone;
  const bool all = rules.strategies == SphereRules::Strategies::all;
  SpherePlan plan;
  plan.closed = {zero, zero, zero};
  Lane count = splat(by_cone ? kSamplesInHemisphere : kSamplesOfDisc) * view.below;
  if constexpr (!scattering_row && !scattering_column) {
    count = max(count, splat(kMinOfDisc));
    const LaneMask closed = ~at.disc & ~at.inside & (dot(r.n, at.w) > c.radius) &
                            (dot(r.ng, at.w) > c.radius) & (dot(c.ng, at.w) < -c.radius) &
                            (dot(c.n, at.w) < -c.radius);
    const Lane product = max(cosines_over_cone(r, c, view.axis, view.cosine, view.below), zero);
    plan.closed = select(closed & alive, Lane3{product, product, product}, plan.closed);
    count = select(closed, zero, count);
  } else if (by_cone) {
    if (all) plan.apart = alive;
  } else {
    const Lane solid_angle = splat(2 * kPi) * view.below;
    const Lane sine = select(at.inside, one, c.radius * view.inv_d);
    if constexpr (scattering_row)
      plan.row_widths = lobe_widths(extras.row->cones, view.axis, view.cosine, sine, solid_angle);
    if constexpr (scattering_column) {
      const LobeCones& lobe = extras.column->cones;
      plan.column_widths = select(at.inside, solid_angle * lobe.per_solid_angle,
                                  lobe_widths(lobe, view.axis * splat(-1), view.cosine, sine, solid_angle));
    }
    const Lane widths = plan.row_widths + plan.column_widths;
    count = max(select(at.disc, max(count, splat(kMinOfDisc)), one), widths * splat(kSamplesPerWidth));
    if (all) plan.apart = alive & (widths > splat(kMaxWidths));
  }
  plan.count =
      select(count > zero, floor(max(min(count, splat(kSamplesInHemisphere)), one) + splat(0.5f)), zero);
  return plan;
}

// The directions by strategy. Pairs apart whose lobes can be followed in lanes are apart no longer.
template <std::uint16_t row_kind, ColumnKind column_kind>
[[gnu::always_inline]] inline SphereCounts share_directions(const PairExtras& extras, const SphereView& view,
                                                            SpherePlan& plan) {
  const Lane zero{}, one = splat(1);
  SphereCounts counts{plan.count, zero, zero, {}};
  if (bits(plan.apart) == 0 || extras.spheres->rules.samples == SphereRules::Samples::cone ||
      (row_kind == kRowScatter && !follows_lobes(*extras.row)) ||
      (column_kind == kColumnScatterSphere && !follows_lobes(*extras.column)))
    return counts;
  // A narrow lobe is met by one sample of its own; where two meet, each is noise to the other's.
  const LaneMask row_lobe = plan.apart & (plan.row_widths > one);
  const LaneMask column_lobe = plan.apart & (plan.column_widths > one);
  const Lane each = select(row_lobe & column_lobe, splat(3), one);
  counts.mixed = plan.apart;
  counts.row = select(row_lobe, each, zero), counts.column = select(column_lobe, each, zero);
  counts.cone =
      select(plan.apart, max(min(floor(splat(kSamplesOfDisc) * view.below), splat(8)), one), plan.count);
  plan.apart = LaneMask{};
  return counts;
}

inline SphereSamples samples_apart(const SphereRules& rules, const SphereView& view, const SpherePlan& plan,
                                   int k) {
  SphereSamples samples;
  if (rules.samples == SphereRules::Samples::cone) {
    samples.cone = samples.receiver = samples.light = (static_cast<int>(plan.count[k]) + 2) / 3;
    return samples;
  }
  // A narrow lobe is met by one sample of its own; where two meet, each is noise to the other's.
  const bool both = plan.row_widths[k] > 1 && plan.column_widths[k] > 1;
  samples.cone = std::clamp(static_cast<int>(kSamplesOfDisc * view.below[k]), 1, 8);
  samples.receiver = plan.row_widths[k] > 1 ? (both ? 3 : 1) : 0;
  samples.light = plan.column_widths[k] > 1 ? (both ? 3 : 1) : 0;
  return samples;
}

// The integral of pair k alone.
template <std::uint16_t row_kind, ColumnKind column_kind>
[[gnu::always_inline]] inline Rgb integrate_apart(const RowGroup& r, const ColumnGroup& c,
                                                  const PairExtras& extras, const SphereGeometry& at,
                                                  const SphereView& view, const SpherePlan& plan, int k) {
  const std::uint32_t i = extras.row_items[k], j = extras.column_items[k];
  const Receivers& receivers = *extras.spheres->receivers;
  const VirtualLights& lights = *extras.spheres->lights;
  const scatter::Closure x = receivers.closure_at(i), y = lights.closure_at(j);
  const Vec3f facing = view.row_fiber ? Vec3f{view.center.x[k], view.center.y[k], view.center.z[k]}
                                      : Vec3f{r.n.x[k], r.n.y[k], r.n.z[k]};
  const SphereEnds ends{x,
                        y,
                        receivers.wo[i],
                        lights.incoming[j],
                        facing,
                        {c.ng.x[k], c.ng.y[k], c.ng.z[k]},
                        {at.w.x[k], at.w.y[k], at.w.z[k]},
                        c.radius[k],
                        at.disc[k] != 0};
  Rgb v = sphere_integral(ends, samples_apart(extras.spheres->rules, view, plan, k),
                          mix64(extras.spheres->seed ^ extras.row_keys[k]) ^ extras.column_keys[k]);
  // What the groups hold of matt ends comes in later.
  if constexpr (row_kind != kRowScatter) v = without(v, {r.f.x[k], r.f.y[k], r.f.z[k]});
  if constexpr (column_kind != kColumnScatterSphere) v = without(v, lights.albedo[j] * kInvPi);
  return v;
}

// a_j·G·(π f_x)(π f_y) as for points, averaged over the sphere; `value` is the integral.
template <std::uint16_t row_kind, ColumnKind column_kind>
[[gnu::always_inline]] inline void clamp_sphere(const RowGroup& r, const ColumnGroup& c,
                                                const PairExtras& extras, const Lane3& value, LaneMask alive,
                                                Lane3& e, PairResult& out) {
  const Lane one = splat(1);
  Lane bound = c.clamp_area * max_component(value) / (c.radius * c.radius);
  if constexpr (row_kind != kRowScatter) bound = bound * max_component(r.f);
  if constexpr (column_kind == kColumnScatterSphere) bound = bound * splat(kPi);
  const LaneMask over = alive & (bound > splat(extras.clamp));
  out.clamped = bits(over);
  if (out.clamped == 0) return;
  e = e * select(over, splat(extras.clamp) / select(over, bound, one), one);
  out.excess = bound / splat(extras.clamp) - one;
}

template <std::uint16_t row_kind, ColumnKind column_kind>
inline PairResult evaluate_sphere(const RowGroup& r, const ColumnGroup& c, const PairExtras& extras) {
  const Lane zero{};
  const SphereGeometry at = sphere_geometry<row_kind, column_kind>(r, c, extras);
  const LaneMask alive = at.alive & mask_from_bits(extras.wanted);
  PairResult out{};
  out.e = {zero, zero, zero};
  if (bits(alive) == 0) return out;

  const SphereView view = view_sphere<row_kind>(r, c, extras, at, alive);
  SpherePlan plan = plan_sphere<row_kind, column_kind>(r, c, extras, at, view, alive);
  SphereCounts counts = share_directions<row_kind, column_kind>(extras, view, plan);
  Lane3 value = plan.closed;
  const std::uint32_t lanes = bits(alive & ~plan.apart & (plan.count > zero));
  if (lanes != 0) {
    const LaneMask here = mask_from_bits(lanes);
    counts.cone = select(here, counts.cone, zero);
    const Lane3 sampled = integrate_in_lanes<row_kind, column_kind>(
        r, c, extras, at, ConeSampler(view.axis, view.below), view.cosine, counts);
    value = select(here, sampled, value);
  }
  for (std::uint32_t b = bits(plan.apart); b != 0; b &= b - 1) {
    const int k = __builtin_ctz(b);
    const Rgb v = integrate_apart<row_kind, column_kind>(r, c, extras, at, view, plan, k);
    value.x[k] = v.r, value.y[k] = v.g, value.z[k] = v.b;
  }

  Lane3 f = c.power;
  if constexpr (row_kind != kRowScatter) f = f * r.f;
  Lane3 e = f * value;
  if (bits(alive & at.disc) != 0 && !view.row_fiber) e = e * (splat(1) / shown_share(r, c, at));
  if (extras.clamp < kInfinity) clamp_sphere<row_kind, column_kind>(r, c, extras, value, alive, e, out);
  note_values(out, e, alive);
  return out;
}

}  // namespace lumirank::transport
