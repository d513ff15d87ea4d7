#include "transport/pairs/lobe_lanes.h"

#include "base/lane_math.h"
#include "transport/pairs/fresnel_lanes.h"
#include "transport/pairs/microfacet_lanes.h"

namespace lumirank::transport {
namespace {

using scatter::LaneForm;
using scatter::NormalDistribution;

const Lane kZero{};
constexpr float kGrazing = 1e-6f;  // as in scatter::eval_f
inline Lane one() { return splat(1); }

Lane3 black() { return {kZero, kZero, kZero}; }

// scatter::schlick_weight.
Lane schlick_weight(Lane cosine) {
  const Lane m = saturated(one() - cosine), m2 = m * m;
  return m2 * m2 * m;
}

// scatter::ward_value; the constants of each variant are in the color.
Lane ward(const ScatterGroup& group, int variant, const LobeLanes& lobe, const LocalGeometry& at) {
  const Lane z2 = at.cos_m * at.cos_m;
  const Lane gaussian = exp_negative(-(shrunk(group, at.m, lobe) / z2));
  if (variant == 0) return gaussian / sqrt(at.cos_i);
  if (variant == 1) return gaussian / at.cos_i;
  return gaussian / (at.len2 * (z2 * z2));
}

// scatter::phong_value.
Lane phong(const LobeLanes& lobe, const LocalGeometry& at) {
  const Lane c = splat(2) * at.cos_o * at.cos_i - dot(at.wo, at.wi);
  const LaneMask near_mirror = c > kZero;
  const Lane exponent = min(lobe.alpha_u * log_positive(select(near_mirror, c, one())), kZero);
  return select(near_mirror, exp_negative(exponent), kZero);
}

// scatter::oren_nayar_value. tan((α + β)/2) = (sin α + sin β)/(cos α + cos β).
Lane3 oren_nayar(const LobeLanes& lobe, const LocalGeometry& at) {
  const Lane sin_o = sqrt(max(kZero, one() - at.cos_o * at.cos_o)),
             sin_i = sqrt(max(kZero, one() - at.cos_i * at.cos_i));
  const Lane sin_sin = sin_o * sin_i;
  const LaneMask slanted = sin_sin > splat(1e-12f);
  const Lane across = (dot(at.wo, at.wi) - at.cos_o * at.cos_i) / select(slanted, sin_sin, one());
  const Lane cos_phi = select(slanted, min(max(across, splat(-1)), one()), kZero);
  const Lane theta_o = angle_of(at.cos_o, sin_o), theta_i = angle_of(at.cos_i, sin_i);
  const LaneMask o_is_less = at.cos_o > at.cos_i;
  const Lane alpha = max(theta_o, theta_i), beta = min(theta_o, theta_i);
  const Lane sin_alpha = max(sin_o, sin_i);
  const Lane tan_beta = select(o_is_less, sin_o / at.cos_o, sin_i / at.cos_i);
  const Lane tan_half = (sin_o + sin_i) / (at.cos_o + at.cos_i);
  const Lane two_beta_pi = splat(2 * kInvPi) * beta;
  const Lane c2 =
      lobe.b.y * (sin_alpha - select(cos_phi >= kZero, kZero, two_beta_pi * two_beta_pi * two_beta_pi));
  const Lane both = splat(4 * kInvPi * kInvPi) * alpha * beta;
  const Lane direct =
      lobe.b.x + cos_phi * c2 * tan_beta + (one() - abs(cos_phi)) * (lobe.b.z * both * both) * tan_half;
  const Lane indirect = lobe.eta * (one() - cos_phi * two_beta_pi * two_beta_pi);
  return lobe.color * max(kZero, direct) + lobe.a * indirect;
}

// scatter::disney_diffuse_value.
Lane disney_diffuse(const LobeLanes& lobe, const LocalGeometry& at) {
  const Lane fo = schlick_weight(at.cos_o), fi = schlick_weight(at.cos_i);
  const Lane rr = splat(2) * lobe.alpha_u * at.cos_d * at.cos_d;
  const Lane half = splat(0.5f);
  const Lane smooth = (one() - half * fo) * (one() - half * fi) + rr * (fo + fi + fo * fi * (rr - one()));
  const Lane ss90 = half * rr - one();
  const Lane ss = (one() + ss90 * fo) * (one() + ss90 * fi);
  const Lane flat = splat(1.25f) * (ss * (one() / (at.cos_o + at.cos_i) - half) + half);
  return smooth + (flat - smooth) * lobe.b.x;
}

constexpr float kCoatMask2 = 0.25f * 0.25f;  // of Disney's clear coat

// scatter::clearcoat_value.
Lane clearcoat(const ScatterGroup& group, const LobeLanes& lobe, const LocalGeometry& at) {
  const Lane w = schlick_weight(at.cos_d), f = w + (one() - w) * splat(0.04f);
  const Lane a2 = lobe.alpha_u * lobe.alpha_u;
  const Lane g1 = masking(NormalDistribution::ggx, at.cos_i, splat(kCoatMask2) * sin2_of(group, at.i));
  return f * g1 / (sin2_of(group, at.m) + a2 * at.cos_m * at.cos_m);
}

Lane3 microfacet(const ScatterGroup& group, const LobeForm& form, const LobeLanes& lobe,
                 const LocalGeometry& at) {
  const Lane d = ndf(form.distribution, lobe.alpha_u * lobe.alpha_v, at.cos_m, shrunk(group, at.m, lobe));
  const Lane g1 = masking(form.distribution, at.cos_i, stretched(group, at.i, lobe));
  return (lobe.color * fresnel(form.fresnel, lobe, at.cos_d)) * (d * g1 / at.cos_i);
}

Lane3 value(const ScatterGroup& group, const LobeForm& form, const LobeLanes& lobe, const LocalGeometry& at) {
  switch (form.lanes) {
    case LaneForm::interfaced_diffuse:
      return lobe.color * interface_transmittance(lobe, at.cos_i);
    case LaneForm::oren_nayar:
      return oren_nayar(lobe, at);
    case LaneForm::microfacet_reflect:
      return microfacet(group, form, lobe, at);
    case LaneForm::thin_transmit: {
      const Lane f = fresnel_dielectric(at.cos_d, lobe.eta);
      const Lane d = ndf(form.distribution, lobe.alpha_u * lobe.alpha_v, at.cos_m, shrunk(group, at.m, lobe));
      const Lane g1 = masking(form.distribution, at.cos_i, stretched(group, at.i, lobe));
      return lobe.color * ((one() - f) * d * g1 / at.cos_i);
    }
    case LaneForm::phong:
      return lobe.color * phong(lobe, at);
    case LaneForm::ward:
      return lobe.color * ward(group, form.variant, lobe, at);
    case LaneForm::sheen:
      return lobe.color * schlick_weight(at.cos_d);
    case LaneForm::disney_diffuse:
      return lobe.color * disney_diffuse(lobe, at);
    case LaneForm::clearcoat:
      return lobe.color * clearcoat(group, lobe, at);
    case LaneForm::constant:
    case LaneForm::none:  // not evaluated here
      break;
  }
  return lobe.color;
}

// Folds what a lobe makes of wo alone into its color and its constants.
void prepare(const ScatterGroup& group, const LobeForm& form, LobeLanes& lobe, const Lane3& wo, Lane cos_o) {
  const Lane inv_pi = splat(kInvPi);
  switch (form.lanes) {
    case LaneForm::interfaced_diffuse:
      lobe.color = lobe.color * (inv_pi * interface_transmittance(lobe, cos_o));
      return;
    case LaneForm::oren_nayar: {
      const Lane s2 = lobe.alpha_u * lobe.alpha_u;
      lobe.color = lobe.color * inv_pi, lobe.a = lobe.a * inv_pi;
      lobe.b.x = one() - splat(0.5f) * s2 / (s2 + splat(0.33f));
      lobe.b.y = splat(0.45f) * s2 / (s2 + splat(0.09f));
      lobe.b.z = splat(0.125f) * s2 / (s2 + splat(0.09f));
      lobe.eta = splat(0.17f) * s2 / (s2 + splat(0.13f));
      return;
    }
    case LaneForm::microfacet_reflect:
    case LaneForm::thin_transmit: {
      const Lane g1 =
          masking(form.distribution, cos_o, stretched(group, tangent_slopes(group, wo, cos_o), lobe));
      lobe.color = lobe.color * (g1 / (splat(4) * cos_o));
      return;
    }
    case LaneForm::phong:
      lobe.color = lobe.color * ((lobe.alpha_u + splat(2)) * splat(0.5f * kInvPi));
      return;
    case LaneForm::ward: {
      const Lane area = splat(kPi) * lobe.alpha_u * lobe.alpha_v;
      const Lane slant =
          form.variant == 0 ? splat(4) * sqrt(cos_o) : (form.variant == 1 ? splat(4) * cos_o : one());
      lobe.color = lobe.color * (one() / (area * slant));
      return;
    }
    case LaneForm::clearcoat: {
      const Lane a2 = lobe.alpha_u * lobe.alpha_u, sin2 = sin2_of(group, tangent_slopes(group, wo, cos_o));
      const Lane g1 = masking(NormalDistribution::ggx, cos_o, splat(kCoatMask2) * sin2);
      lobe.color = lobe.color * (g1 * inv_pi * (a2 - one()) / log_positive(a2));
      return;
    }
    case LaneForm::constant:
    case LaneForm::disney_diffuse:
      lobe.color = lobe.color * inv_pi;
      return;
    case LaneForm::sheen:
    case LaneForm::none:
      return;
  }
}

// A direction refracted into a coat, given its cosine there.
Lane3 bent(const ScatterGroup& group, const CoatLanes& coat, const Lane3& w, Lane cos_out, Lane cos_in) {
  return w * (one() / coat.bend) + group.n * (cos_in - cos_out / coat.bend);
}

// scatter::coated_value.
Lane3 under_coat(const ScatterGroup& group, const LobeForm& form, const LobeLanes& lobe,
                 const CoatLanes& coat, const Lane3& wi, Lane cos_i) {
  const Lane inside = coat_cosine(coat, cos_i);
  const LaneMask enters = inside > kZero;
  LocalGeometry at{coat.wo,    bent(group, coat, wi, cos_i, inside),
                   coat.cos_o, select(enters, inside, one()),
                   {},         {},
                   {},         {},
                   {}};
  find_half_vector(group, at);
  const Lane3 f = value(group, form, lobe, at) * coat_passage(coat, cos_i, inside);
  return select(enters, f, black());
}

}  // namespace

void prepare(ScatterGroup& group, LobeLanes* lobes, CoatLanes* coats) {
  const Lane cos_o = dot(group.n, group.wo);
  group.answers = (cos_o > splat(kGrazing)) & (dot(group.ng, group.wo) > kZero);
  group.cos_o = select(group.answers, cos_o, one());
  for (std::size_t k = 0; k < group.form->lobes.size(); ++k) {
    const LobeForm& form = group.form->lobes[k];
    if (!form.coated) {
      prepare(group, form, lobes[k], group.wo, group.cos_o);
      continue;
    }
    CoatLanes& coat = coats[k];
    const Lane inside = coat_cosine(coat, group.cos_o);
    const LaneMask enters = inside > kZero;
    coat.cos_o = select(enters, inside, one());
    coat.wo = bent(group, coat, group.wo, group.cos_o, coat.cos_o);
    prepare(group, form, lobes[k], coat.wo, coat.cos_o);
    const Lane3 passage = coat_passage(coat, group.cos_o, inside) * (one() / (coat.bend * coat.bend));
    lobes[k].color = select(enters, lobes[k].color * passage, black());
    if (form.lanes == LaneForm::oren_nayar) lobes[k].a = select(enters, lobes[k].a * passage, black());
  }
}

// The lobes that shine through, for wi behind: they are evaluated at wi mirrored to wo's side.
Lane3 eval_behind(const ScatterGroup& group, const Lane3& wi, Lane cos_i, LaneMask direct) {
  const ScatterForm& form = *group.form;
  const LaneMask lit = group.answers & (cos_i < splat(-kGrazing)) & (dot(group.ng, wi) < kZero);
  Lane3 f = black();
  if (bits(lit) == 0) return f;
  const Lane3 mirrored = wi - group.n * (splat(2) * cos_i);
  LocalGeometry at{group.wo, mirrored, group.cos_o, select(lit, -cos_i, one()), {}, {}, {}, {}, {}};
  find_half_vector(group, at);
  for (std::size_t k = 0; k < form.lobes.size(); ++k) {
    if (!scatter::shines_through(form.lobes[k].kind)) continue;
    const LobeLanes& lobe = group.lobes[k];
    Lane3 part = value(group, form.lobes[k], lobe, at);
    if (group.some_traced) part = select(direct & lobe.traced, black(), part);
    f = f + part;
  }
  return select(lit, f, black());
}

Lane3 eval_lobes(const ScatterGroup& group, const Lane3& wi, LaneMask direct) {
  const ScatterForm& form = *group.form;
  const Lane cos_i = dot(group.n, wi);
  const LaneMask lit = group.answers & (cos_i > splat(kGrazing)) & (dot(group.ng, wi) > kZero);
  const Lane3 behind = form.sides == Sides::both ? eval_behind(group, wi, cos_i, direct) : black();
  if (bits(lit) == 0) return behind;
  Lane3 f = black();

  LocalGeometry at{group.wo, wi, group.cos_o, select(lit, cos_i, one()), {}, {}, {}, {}, {}};
  if (form.microfacets) find_half_vector(group, at);
  for (std::size_t k = 0; k < form.lobes.size(); ++k) {
    const LobeForm& kind = form.lobes[k];
    if (scatter::shines_through(kind.kind)) continue;
    const LobeLanes& lobe = group.lobes[k];
    Lane3 part = kind.coated ? under_coat(group, kind, lobe, group.coats[k], wi, at.cos_i)
                             : value(group, kind, lobe, at);
    // Matt lobes leave no direct light to tracing.
    if (group.some_traced && !scatter::family_of(kind.kind).matt)
      part = select(direct & lobe.traced, black(), part);
    f = f + part;
  }
  return select(lit, f, behind);
}

}  // namespace lumirank::transport
