#include "transport/kernels/lobe_lanes.h"

#include "transport/kernels/lane_math.h"

namespace lumirank::transport {
namespace {

using scatter::FresnelKind;
using scatter::LobeKind;
using scatter::NormalDistribution;

const Lane kZero{};
constexpr float kGrazing = 1e-6f;  // as in scatter::eval_f
inline Lane one() { return splat(1); }
inline Lane saturate(Lane x) { return min(max(x, kZero), one()); }

// scatter::fresnel_dielectric.
Lane fresnel_dielectric(Lane cos_i, Lane eta) {
  const Lane c = min(cos_i, one());
  const Lane cos_t2 = one() - (one() - c * c) / (eta * eta);
  const Lane cos_t = sqrt(max(cos_t2, kZero));
  const Lane parallel = (eta * c - cos_t) / (eta * c + cos_t + splat(1e-20f));
  const Lane perpendicular = (c - eta * cos_t) / (c + eta * cos_t + splat(1e-20f));
  const Lane r = splat(0.5f) * (parallel * parallel + perpendicular * perpendicular);
  return select(cos_t2 > kZero, min(r, one()), one());
}

// scatter::fresnel_conductor.
Lane fresnel_conductor(Lane cos_i, Lane eta, Lane k) {
  const Lane c = min(cos_i, one()), c2 = c * c, s2 = one() - c2;
  const Lane t0 = eta * eta - k * k - s2;
  const Lane a2_plus_b2 = sqrt(t0 * t0 + splat(4) * eta * eta * k * k);
  const Lane a = sqrt(max(kZero, splat(0.5f) * (a2_plus_b2 + t0)));
  const Lane t1 = a2_plus_b2 + c2, t2 = splat(2) * a * c;
  const Lane perpendicular = (t1 - t2) / (t1 + t2 + splat(1e-20f));
  const Lane t3 = c2 * a2_plus_b2 + s2 * s2, t4 = t2 * s2;
  const Lane parallel = perpendicular * (t3 - t4) / (t3 + t4 + splat(1e-20f));
  return saturate(splat(0.5f) * (perpendicular + parallel));
}

Lane3 fresnel(FresnelKind kind, const LobeLanes& lobe, Lane cos_m) {
  switch (kind) {
    case FresnelKind::dielectric: {
      const Lane f = fresnel_dielectric(cos_m, lobe.eta);
      return {f, f, f};
    }
    case FresnelKind::conductor:
      return {fresnel_conductor(cos_m, lobe.a.x, lobe.b.x), fresnel_conductor(cos_m, lobe.a.y, lobe.b.y),
              fresnel_conductor(cos_m, lobe.a.z, lobe.b.z)};
    case FresnelKind::schlick: {
      const Lane m = saturate(one() - cos_m), m2 = m * m, w = m2 * m2 * m;
      return lobe.a + (Lane3{one(), one(), one()} - lobe.a) * w;
    }
    case FresnelKind::none:
      break;
  }
  return {one(), one(), one()};
}

// scatter::interface_transmittance.
Lane interface_transmittance(const LobeLanes& lobe, Lane cos_theta) {
  const Lane s = one() - fresnel_dielectric(cos_theta, lobe.eta);
  return saturate(lobe.a.x + s * (lobe.a.y + s * (lobe.a.z + s * lobe.b.x)) +
                  cos_theta * (lobe.b.y + cos_theta * lobe.b.z));
}

// scatter::beckmann_lambda.
Lane beckmann_lambda(Lane a) {
  const Lane t = one() / (one() + splat(0.3275911f) * a);
  const Lane poly =
      t * (splat(0.254829592f) +
           t * (splat(-0.284496736f) +
                t * (splat(1.421413741f) + t * (splat(-1.453152027f) + t * splat(1.061405429f)))));
  return max(kZero, splat(0.5f) * exp_negative(-(a * a)) * (splat(0.5641895835f) / a - poly));
}

// Smith's masking for a direction at cosine z whose slopes across, stretched by the roughness, have the
// square xy2.
Lane masking(NormalDistribution distribution, Lane z, Lane xy2) {
  if (distribution == NormalDistribution::ggx) return splat(2) * z / (z + sqrt(z * z + xy2));
  const Lane a = max(z / sqrt(max(xy2, splat(1e-20f))), splat(1e-12f));
  return one() / (one() + beckmann_lambda(a));
}

// The density of normals at cosine z; xy2: the square of the components across, over the roughness.
Lane normals(NormalDistribution distribution, Lane alpha2, Lane z, Lane xy2) {
  if (distribution == NormalDistribution::ggx) {
    const Lane d = xy2 + z * z;
    return splat(kInvPi) / (alpha2 * d * d);
  }
  const Lane z2 = max(z * z, splat(1e-12f));
  return splat(kInvPi) * exp_negative(-(xy2 / z2)) / (alpha2 * z2 * z2);
}

// Components of a direction in the plane of the surface.
struct Across {
  Lane x, y;  // anisotropic: along s and t
  Lane sin2;  // isotropic: x² + y²
};
Across across(const ScatterGroup& group, const Lane3& v, Lane cos_theta) {
  Across out;
  if (group.form->anisotropic) {
    out.x = dot(v, group.s), out.y = dot(v, group.t);
  } else {
    // Not 1 - cos²: near the normal that difference has no digits left, and narrow lobes live there.
    const Lane3 flat = v - group.n * cos_theta;
    out.sin2 = dot(flat, flat);
  }
  return out;
}
Lane stretched(const ScatterGroup& group, const Across& v, const LobeLanes& lobe) {
  if (!group.form->anisotropic) return v.sin2 * (lobe.alpha_u * lobe.alpha_u);
  const Lane x = v.x * lobe.alpha_u, y = v.y * lobe.alpha_v;
  return x * x + y * y;
}
Lane shrunk(const ScatterGroup& group, const Across& v, const LobeLanes& lobe) {
  if (!group.form->anisotropic) return v.sin2 / (lobe.alpha_u * lobe.alpha_u);
  const Lane x = v.x / lobe.alpha_u, y = v.y / lobe.alpha_v;
  return x * x + y * y;
}

}  // namespace

void prepare(ScatterGroup& group, LobeLanes* lobes) {
  const Lane cos_o = dot(group.n, group.wo);
  group.answers = (cos_o > splat(kGrazing)) & (dot(group.ng, group.wo) > kZero);
  const Lane safe = select(group.answers, cos_o, one());
  const Across o = across(group, group.wo, cos_o);
  for (std::size_t k = 0; k < group.form->lobes.size(); ++k) {
    const LobeForm& form = group.form->lobes[k];
    LobeLanes& lobe = lobes[k];
    if (form.kind == LobeKind::diffuse) {
      lobe.color = lobe.color * splat(kInvPi);
    } else if (form.kind == LobeKind::interfaced_diffuse) {
      lobe.color = lobe.color * (splat(kInvPi) * interface_transmittance(lobe, safe));
    } else {
      const Lane g1 = masking(form.distribution, safe, stretched(group, o, lobe));
      lobe.color = lobe.color * (g1 / (splat(4) * safe));
    }
  }
}

Lane3 eval_lobes(const ScatterGroup& group, const Lane3& wi, LaneMask direct) {
  const ScatterForm& form = *group.form;
  const Lane cos_i = dot(group.n, wi);
  const LaneMask lit = group.answers & (cos_i > splat(kGrazing)) & (dot(group.ng, wi) > kZero);
  Lane3 f{kZero, kZero, kZero};
  if (bits(lit) == 0) return f;
  const Lane safe_cos = select(lit, cos_i, one());

  Lane cos_m{}, cos_d{};
  Across m{}, i{};
  if (form.microfacets) {
    const Lane3 half = group.wo + wi;
    const Lane3 normal = half * (one() / sqrt(dot(half, half)));
    cos_m = dot(group.n, normal), cos_d = dot(group.wo, normal);
    m = across(group, normal, cos_m), i = across(group, wi, cos_i);
  }
  for (std::size_t k = 0; k < form.lobes.size(); ++k) {
    const LobeForm& kind = form.lobes[k];
    const LobeLanes& lobe = group.lobes[k];
    if (kind.kind == LobeKind::diffuse) {
      f = f + lobe.color;
    } else if (kind.kind == LobeKind::interfaced_diffuse) {
      f = f + lobe.color * interface_transmittance(lobe, safe_cos);
    } else {
      const Lane alpha2 = lobe.alpha_u * lobe.alpha_v;
      const Lane d = normals(kind.distribution, alpha2, cos_m, shrunk(group, m, lobe));
      const Lane g1 = masking(kind.distribution, safe_cos, stretched(group, i, lobe));
      Lane3 value = (lobe.color * fresnel(kind.fresnel, lobe, cos_d)) * (d * g1 / safe_cos);
      if (group.some_traced) value = select(direct & lobe.traced, Lane3{kZero, kZero, kZero}, value);
      f = f + value;
    }
  }
  return select(lit, f, Lane3{kZero, kZero, kZero});
}

}  // namespace lumirank::transport
