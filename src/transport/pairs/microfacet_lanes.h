// Normal distributions, masking and half vectors in lanes: line by line after scatter/microfacet.h.
#pragma once

#include "base/lane_math.h"
#include "transport/pairs/scatter_group.h"

namespace lumirank::transport {

// scatter::beckmann_lambda.
inline Lane beckmann_lambda(Lane a) {
  const Lane t = splat(1) / (splat(1) + splat(0.3275911f) * a);
  const Lane poly =
      t * (splat(0.254829592f) +
           t * (splat(-0.284496736f) +
                t * (splat(1.421413741f) + t * (splat(-1.453152027f) + t * splat(1.061405429f)))));
  return max(Lane{}, splat(0.5f) * exp_negative(-(a * a)) * (splat(0.5641895835f) / a - poly));
}

// Smith's masking for a direction at cosine z whose slopes across, stretched by the roughness, have the
// square xy2.
inline Lane masking(scatter::NormalDistribution distribution, Lane z, Lane xy2) {
  if (distribution == scatter::NormalDistribution::ggx) return splat(2) * z / (z + sqrt(z * z + xy2));
  const Lane a = max(z / sqrt(max(xy2, splat(1e-20f))), splat(1e-12f));
  return splat(1) / (splat(1) + beckmann_lambda(a));
}

// The density of normals at cosine z; xy2: the square of the components across, over the roughness.
inline Lane ndf(scatter::NormalDistribution distribution, Lane alpha2, Lane z, Lane xy2) {
  if (distribution == scatter::NormalDistribution::ggx) {
    const Lane d = xy2 + z * z;
    return splat(kInvPi) / (alpha2 * d * d);
  }
  const Lane z2 = max(z * z, splat(1e-12f));
  return splat(kInvPi) * exp_negative(-(xy2 / z2)) / (alpha2 * z2 * z2);
}

// Components of a direction in the plane of the surface.
struct TangentSlopes {
  Lane x, y;  // anisotropic: along s and t
  Lane sin2;  // isotropic: x² + y²
};
inline TangentSlopes tangent_slopes(const ScatterGroup& group, const Lane3& v, Lane cos_theta) {
  TangentSlopes out;
  if (group.form->anisotropic) {
    out.x = dot(v, group.s), out.y = dot(v, group.t);
  } else {
    // Not 1 - cos²: near the normal that difference has no digits left, and narrow lobes live there.
    const Lane3 flat = v - group.n * cos_theta;
    out.sin2 = dot(flat, flat);
  }
  return out;
}
inline Lane stretched(const ScatterGroup& group, const TangentSlopes& v, const LobeLanes& lobe) {
  if (!group.form->anisotropic) return v.sin2 * (lobe.alpha_u * lobe.alpha_u);
  const Lane x = v.x * lobe.alpha_u, y = v.y * lobe.alpha_v;
  return x * x + y * y;
}
inline Lane shrunk(const ScatterGroup& group, const TangentSlopes& v, const LobeLanes& lobe) {
  if (!group.form->anisotropic) return v.sin2 / (lobe.alpha_u * lobe.alpha_u);
  const Lane x = v.x / lobe.alpha_u, y = v.y / lobe.alpha_v;
  return x * x + y * y;
}

inline Lane sin2_of(const ScatterGroup& group, const TangentSlopes& v) {
  return group.form->anisotropic ? v.x * v.x + v.y * v.y : v.sin2;
}
// A pair of directions on the side of n, outside or within a coat, and what lobes want to know of it.
struct LocalGeometry {
  Lane3 wo, wi;
  Lane cos_o, cos_i;
  Lane len2, cos_m, cos_d;  // of wo + wi: squared length; of the half vector: cosines with n and with wo
  TangentSlopes m, i;       // the half vector and wi
};
inline void find_half_vector(const ScatterGroup& group, LocalGeometry& at) {
  const Lane3 half = at.wo + at.wi;
  at.len2 = dot(half, half);
  const Lane3 normal = half * (splat(1) / sqrt(at.len2));
  at.cos_m = dot(group.n, normal), at.cos_d = dot(at.wo, normal);
  at.m = tangent_slopes(group, normal, at.cos_m), at.i = tangent_slopes(group, at.wi, at.cos_i);
}

}  // namespace lumirank::transport
