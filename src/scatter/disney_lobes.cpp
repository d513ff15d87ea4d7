// The parts of the principled model that no other material has: diffuse with retro-reflection and flattening,
// sheen, and the clear coat (Burley 2012 and 2015; forms and constants as in Mitsuba 3's principled plugin).
#include "scatter/fresnel.h"
#include "scatter/lobe.h"
#include "scatter/microfacet.h"

namespace lumirank::scatter {

// color/π · lerp(diffuse + retro, flat, flatness); alpha_u is the roughness, extra the flatness.
Rgb disney_diffuse_value(const Lobe& lobe, Vec3f wo, Vec3f wi) {
  const float fo = schlick_weight(wo.z), fi = schlick_weight(wi.z);
  const float cos_d = dot(normalize(wo + wi), wi);
  const float rr = 2 * lobe.alpha_u * cos_d * cos_d;
  const float smooth = (1 - 0.5f * fo) * (1 - 0.5f * fi) + rr * (fo + fi + fo * fi * (rr - 1));
  float value = smooth;
  if (lobe.extra > 0) {
    const float ss90 = 0.5f * rr;
    const float ss = lerp(1.0f, ss90, fo) * lerp(1.0f, ss90, fi);
    const float flat = 1.25f * (ss * (1 / (wo.z + wi.z) - 0.5f) + 0.5f);
    value = lerp(smooth, flat, lobe.extra);
  }
  return lobe.color * (kInvPi * value);
}

// color · (1 - cos_d)⁵.
Rgb sheen_value(const Lobe& lobe, Vec3f wo, Vec3f wi) {
  return lobe.color * schlick_weight(dot(normalize(wo + wi), wi));
}

namespace {

constexpr float kCoatF0 = 0.04f, kCoatMaskAlpha = 0.25f;

// The generalised Trowbridge-Reitz distribution with exponent 1; alpha_u is its width.
// sin² + α²·cos² instead of 1 + (α² - 1)·cos²: near the pole the latter has no digits left.
float gtr1_d(Vec3f m, float alpha) {
  const float a2 = alpha * alpha;
  return (a2 - 1) / (kPi * std::log(a2) * (m.x * m.x + m.y * m.y + a2 * m.z * m.z));
}

}  // namespace

// color · F · D · G; Mitsuba leaves out 1/(4 cos cos), and so do we.
Rgb clearcoat_value(const Lobe& lobe, Vec3f wo, Vec3f wi) {
  const Vec3f m = normalize(wo + wi);
  const float f = lerp(schlick_weight(dot(wo, m)), 1.0f, kCoatF0);
  const float g = ggx_g1(wo, kCoatMaskAlpha, kCoatMaskAlpha) * ggx_g1(wi, kCoatMaskAlpha, kCoatMaskAlpha);
  return lobe.color * (f * gtr1_d(m, lobe.alpha_u) * g);
}

float clearcoat_pdf(const Lobe& lobe, Vec3f wo, Vec3f wi) {
  const Vec3f m = normalize(wo + wi);
  return gtr1_d(m, lobe.alpha_u) * m.z / (4 * dot(wo, m));
}

bool clearcoat_sample(const Lobe& lobe, Vec3f wo, Vec2f u, Vec3f& wi) {
  const float a2 = lobe.alpha_u * lobe.alpha_u, phi = 2 * kPi * u.x;
  // 1 - cos², written so that it keeps its digits near the pole.
  const float sin2 = (std::pow(a2, 1 - u.y) - a2) / (1 - a2);
  const float r = std::sqrt(std::clamp(sin2, 0.0f, 1.0f));
  const Vec3f m{r * std::cos(phi), r * std::sin(phi), std::sqrt(std::max(0.0f, 1 - r * r))};
  wi = reflect(wo, m);
  return dot(wo, m) > 0 && wi.z > 0;
}

}  // namespace lumirank::scatter
