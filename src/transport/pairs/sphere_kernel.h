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
  const Lane3 center = at.w * inv_d;
  // From inside, the hemisphere of the receiver; of a fiber, the one towards the light.
  const bool row_fiber = scattering_row && extras.row_sides == Sides::fiber;
  const Lane side = select(dot(r.n, at.w) < zero, -one, one);
  const Lane3 axis = row_fiber ? center : select(at.inside, r.n * side, center);

  // How many directions, and who takes them.
  const bool by_cone = rules.samples == SphereRules::Samples::cone;
  const bool all = rules.strategies == SphereRules::Strategies::all;
  Lane count = splat(by_cone ? kSamplesInHemisphere : kSamplesOfDisc) * below;
  Lane row_widths{}, column_widths{};
  LaneMask apart{};
  Lane3 value{zero, zero, zero};
  if constexpr (!scattering_row && !scattering_column) {
    count = max(count, splat(kMinOfDisc));
    const LaneMask closed = ~at.disc & ~at.inside & (dot(r.n, at.w) > c.radius) &
                            (dot(r.ng, at.w) > c.radius) & (dot(c.ng, at.w) < -c.radius) &
                            (dot(c.n, at.w) < -c.radius);
    const Lane product = max(cosines_over_cone(r, c, axis, cosine, below), zero);
    value = select(closed & alive, Lane3{product, product, product}, value);
    count = select(closed, zero, count);
  } else if (by_cone) {
    if (all) apart = alive;
  } else {
    const Lane solid_angle = splat(2 * kPi) * below, sine = select(at.inside, one, c.radius * inv_d);
    if constexpr (scattering_row)
      row_widths = lobe_widths(extras.row->cones, axis, cosine, sine, solid_angle);
    if constexpr (scattering_column) {
      const LobeCones& lobe = extras.column->cones;
      column_widths = select(at.inside, solid_angle * lobe.per_solid_angle,
                             lobe_widths(lobe, axis * splat(-1), cosine, sine, solid_angle));
    }
    const Lane widths = row_widths + column_widths;
    count = max(select(at.disc, max(count, splat(kMinOfDisc)), one), widths * splat(kSamplesPerWidth));
    if (all) apart = alive & (widths > splat(kMaxWidths));
  }
  count = select(count > zero, floor(max(min(count, splat(kSamplesInHemisphere)), one) + splat(0.5f)), zero);
  SphereCounts counts{count, zero, zero, {}};
  if (bits(apart) != 0 && !by_cone && (!scattering_row || follows_lobes(*extras.row)) &&
      (!scattering_column || follows_lobes(*extras.column))) {
    // A narrow lobe is met by one sample of its own; where two meet, each is noise to the other's.
    const LaneMask row_lobe = apart & (row_widths > one), column_lobe = apart & (column_widths > one);
    const Lane each = select(row_lobe & column_lobe, splat(3), one);
    counts.mixed = apart;
    counts.row = select(row_lobe, each, zero), counts.column = select(column_lobe, each, zero);
    counts.cone = select(apart, max(min(floor(splat(kSamplesOfDisc) * below), splat(8)), one), count);
    apart = LaneMask{};
  }
  const std::uint32_t lanes = bits(alive & ~apart & (count > zero));
  if (lanes != 0) {
    const LaneMask here = mask_from_bits(lanes);
    counts.cone = select(here, counts.cone, zero);
    const Lane3 sampled =
        integrate_in_lanes<row_kind, column_kind>(r, c, extras, at, ConeSampler(axis, below), cosine, counts);
    value = select(here, sampled, value);
  }
  for (std::uint32_t b = bits(apart); b != 0; b &= b - 1) {
    const int k = __builtin_ctz(b);
    const std::uint32_t i = extras.row_items[k], j = extras.column_items[k];
    const Receivers& receivers = *extras.spheres->receivers;
    const VirtualLights& lights = *extras.spheres->lights;
    const scatter::Closure x = receivers.closure_at(i), y = lights.closure_at(j);
    const Vec3f facing =
        row_fiber ? Vec3f{center.x[k], center.y[k], center.z[k]} : Vec3f{r.n.x[k], r.n.y[k], r.n.z[k]};
    const SphereEnds ends{x,
                          y,
                          receivers.wo[i],
                          lights.incoming[j],
                          facing,
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
    Rgb v = sphere_integral(ends, samples,
                            mix64(extras.spheres->seed ^ extras.row_keys[k]) ^ extras.column_keys[k]);
    // What the groups hold of matt ends comes in below.
    if constexpr (!scattering_row) v = without(v, {r.f.x[k], r.f.y[k], r.f.z[k]});
    if constexpr (!scattering_column) v = without(v, lights.albedo[j] * kInvPi);
    value.x[k] = v.r, value.y[k] = v.g, value.z[k] = v.b;
  }

  Lane3 f = c.power;
  if constexpr (!scattering_row) f = f * r.f;
  Lane3 e = f * value;
  if (bits(alive & at.disc) != 0 && !row_fiber) e = e * (one / shown_share(r, c, at));
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
  note_values(out, e, alive);
  return out;
}

}  // namespace lumirank::transport
