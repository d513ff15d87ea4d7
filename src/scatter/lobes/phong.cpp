// The modified Phong model (Lafortune and Willems 1994): (n + 2)/(2π)·cosⁿ of the angle to the mirror
// direction.
#include "scatter/lobes/bound_terms.h"
#include "scatter/lobes/family.h"

namespace lumirank::scatter {
namespace {

float cos_to_mirror(Vec3f wo, Vec3f wi) { return dot(Vec3f{-wo.x, -wo.y, wo.z}, wi); }

Rgb phong_value(LobeView view, Vec3f wo, Vec3f wi) {
  const float c = cos_to_mirror(wo, wi), n = view.lobe.alpha_u;
  if (c <= 0) return Rgb(0);
  return view.lobe.color * ((n + 2) * (0.5f * kInvPi) * std::pow(c, n));
}

float phong_pdf(LobeView view, Vec3f wo, Vec3f wi) {
  const float c = cos_to_mirror(wo, wi), n = view.lobe.alpha_u;
  return c <= 0 ? 0.0f : (n + 1) * (0.5f * kInvPi) * std::pow(c, n);
}

bool phong_sample(LobeView view, Vec3f wo, Vec2f u, Vec3f& wi) {
  const float c = std::pow(1 - u.x, 1 / (view.lobe.alpha_u + 1)), s = std::sqrt(std::max(0.0f, 1 - c * c));
  const float phi = 2 * kPi * u.y;
  const Frame around = Frame::from_normal({-wo.x, -wo.y, wo.z});
  wi = around.to_world({s * std::cos(phi), s * std::sin(phi), c});
  return wi.z > 0;
}

float phong_factor(const Lobe& lobe, float, float) { return (lobe.alpha_u + 2) * (0.5f * kInvPi); }
Rgb phong_bound(const LobeTerm& t, const AngleRange& r, CosineFactor factor) {
  if (!(r.cos_mirror > 0)) return Rgb(0);
  return t.scale *
         (std::pow(r.cos_mirror, t.lobe->alpha_u) * (factor == CosineFactor::cosine ? r.cos_hi : 1.0f));
}
// The width of Beckmann's microfacets that are about as sharp.
float alpha_of(const Lobe& lobe) { return std::sqrt(2 / (lobe.alpha_u + 2)); }
float phong_reach(const LobeTerm& t) { return alpha_of(*t.lobe); }
UnderCoat phong_under_coat(LobeView view) {
  const Rgb color = view.lobe.color;
  const float alpha = alpha_of(view.lobe);
  return {UnderCoat::Sort::glossy, color, color, NormalDistribution::beckmann, alpha, alpha};
}
void widen_phong(Lobe& lobe, const Widening& by) {
  lobe.alpha_u = std::max(0.0f, 2 / square(by(alpha_of(lobe))) - 2);
}

}  // namespace

constinit const LobeFamily phong_family{.value = phong_value,
                                        .pdf = phong_pdf,
                                        .sample = phong_sample,
                                        .factor_of_wo = phong_factor,
                                        .bound = phong_bound,
                                        .reach = phong_reach,
                                        .bound_by_mirror = true,
                                        .power = true,
                                        .roughness = alpha_of,
                                        .under_coat = phong_under_coat,
                                        .widen = widen_phong,
                                        .lanes = LaneForm::phong};

}  // namespace lumirank::scatter
