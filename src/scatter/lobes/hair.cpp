// Kajiya and Kay's hair (1989, section "A new lighting model for hair"): a diffuse part in proportion to the
// sine of the angle between fiber and light, and a specular part about the cone of mirror directions. Theirs
// makes energy; here both are normalized and reciprocal.
//
// Local x runs along the fiber. For a direction w, x = w·x is the sine of its latitude φ and c = √(1 - x²)
// the sine of its angle to the fiber, which is also the share of the fiber's width that light along w meets.
// So the cosine of a surface is replaced by c: radiance = ∫ f·L·c dω, and of the light from wi a fiber sends
// on the share ∫ f·c dω ≤ 1 (Marschner et al. 2003, section 3).
//
// diffuse   f = color/π²: ∫ c dω = 2π·∫cos²φ dφ = π², so the share is exactly the color.
// specular  f = color · cosⁿ(φo + φi) / (2π·W(n)·max(co, ci)²), W(n) = ∫ cosⁿδ dδ over ±π/2; 0 beyond 90°.
//           The share is ∫ cosⁿ(δ)/W · co²/max(co, ci)² dδ ≤ 1, symmetric in wo and wi, and near 1 for sharp
//           lobes but at grazing light. (Kajiya and Kay have neither normalization nor denominator.)
#include <cmath>

#include "base/warp.h"
#include "scatter/lobes/bound_terms.h"
#include "scatter/lobes/family.h"

namespace lumirank::scatter {
namespace {

constexpr float kInvPi2 = kInvPi * kInvPi;

// c² never counts as less: f grows like 1/c².
constexpr float kMinSine2 = 1e-8f;

// Not 1 - x²: near the fiber that difference has no digits left.
float sine2(Vec3f w) { return std::max(kMinSine2, w.y * w.y + w.z * w.z); }
float latitude(Vec3f w) { return std::atan2(w.x, std::sqrt(w.y * w.y + w.z * w.z)); }

// cos(φo + φi), at least 0.
float off_mirror(float xo, float co, float xi, float ci) { return std::max(0.0f, co * ci - xo * xi); }

// Draws of the specular lobe follow a logistic distribution of δ = φo + φi, cut to the latitudes there are.
// It is nearly the shape of cosⁿ: a normal distribution of variance 1/(n + 1) for large n, whose width is
// 1/0.6 logistic scales.
struct Logistic {
  float scale, lo, hi;  // hi and lo: of the distribution function
  Logistic(float exponent, float phi) {
    scale = 0.6f / std::sqrt(exponent + 1);
    lo = cdf(std::max(-kPi / 2, phi - kPi / 2));
    hi = cdf(std::min(kPi / 2, phi + kPi / 2));
  }
  float cdf(float delta) const { return 1 / (1 + std::exp(-delta / scale)); }
  float density(float delta) const {
    const float e = std::exp(-std::abs(delta) / scale);
    return e / (scale * square(1 + e) * (hi - lo));
  }
  float draw(float u) const {
    const float p = std::clamp(lo + u * (hi - lo), 1e-7f, 1 - 1e-7f);
    return scale * std::log(p / (1 - p));
  }
};

}  // namespace

float hair_specular_scale(float exponent) {
  // W(n) = √π·Γ((n + 1)/2)/Γ(n/2 + 1)
  const float log_w = std::lgamma((exponent + 1) / 2) - std::lgamma(exponent / 2 + 1);
  return 1 / (2 * kPi * std::sqrt(kPi) * std::exp(log_w));
}

float fiber_sine(Vec3f w) { return std::sqrt(w.y * w.y + w.z * w.z); }

namespace {

Rgb hair_diffuse_value(LobeView view, Vec3f, Vec3f) { return view.lobe.color * kInvPi2; }
float hair_diffuse_pdf(LobeView, Vec3f, Vec3f) { return 1 / (4 * kPi); }
bool hair_diffuse_sample(LobeView, Vec3f, Vec2f u, Vec3f& wi) {
  wi = warp_sphere(u);
  return true;
}

Rgb hair_specular_value(LobeView view, Vec3f wo, Vec3f wi) {
  const Lobe& lobe = view.lobe;
  const float so = sine2(wo), si = sine2(wi);
  const float c = off_mirror(wo.x, std::sqrt(so), wi.x, std::sqrt(si));
  if (c <= 0) return Rgb(0);
  return lobe.color * (lobe.alpha_v * std::pow(c, lobe.alpha_u) / std::max(so, si));
}

float hair_specular_pdf(LobeView view, Vec3f wo, Vec3f wi) {
  const Lobe& lobe = view.lobe;
  const float phi_o = latitude(wo), delta = phi_o + latitude(wi);
  if (std::abs(delta) >= kPi / 2) return 0;
  return Logistic(lobe.alpha_u, phi_o).density(delta) / (2 * kPi * std::sqrt(sine2(wi)));
}

bool hair_specular_sample(LobeView view, Vec3f wo, Vec2f u, Vec3f& wi) {
  const Lobe& lobe = view.lobe;
  const float phi_o = latitude(wo);
  const float phi_i = Logistic(lobe.alpha_u, phi_o).draw(u.x) - phi_o;
  const float c = std::cos(phi_i), azimuth = 2 * kPi * u.y;
  if (!(c > 0)) return false;
  wi = {std::sin(phi_i), c * std::cos(azimuth), c * std::sin(azimuth)};
  return true;
}

// The share above, by so few values of δ as keep what albedo() promises (tests/scatter/energy_test.cpp).
Rgb hair_specular_albedo(LobeView view, Vec3f wo) {
  constexpr int kDeltas = 8;
  const Lobe& lobe = view.lobe;
  const float phi_o = latitude(wo), so = sine2(wo);
  const Logistic logistic(lobe.alpha_u, phi_o);
  float sum = 0;
  for (int k = 0; k < kDeltas; ++k) {
    const float delta = logistic.draw((static_cast<float>(k) + 0.5f) / kDeltas);
    const float c = std::cos(delta), si = square(std::cos(delta - phi_o));
    if (c > 0) sum += std::pow(c, lobe.alpha_u) * si / (std::max(so, si) * logistic.density(delta));
  }
  return lobe.color * (2 * kPi * lobe.alpha_v * sum / kDeltas);
}

float hair_diffuse_factor(const Lobe&, float, float) { return kInvPi * kInvPi; }
float hair_specular_factor(const Lobe& lobe, float, float) { return lobe.alpha_v; }
Rgb hair_diffuse_bound(const LobeTerm& t, float, float lo, float hi, CosineFactor factor) {
  return t.scale * (factor == CosineFactor::cosine ? max_sine_of(lo, hi) : 1.0f);
}
Rgb hair_specular_bound(const LobeTerm& t, float latitude_o, float lo, float hi, CosineFactor factor) {
  const float min_sine = std::min(std::cos(lo), std::cos(hi));  // of the angle to the fiber
  const float max_sine = max_sine_of(lo, hi);
  const float from = latitude_o + lo, to = latitude_o + hi;
  const float off = from > 0 ? from : to < 0 ? -to : 0.0f;
  if (off >= kPi / 2) return Rgb(0);
  // c/max(co, c)² ≤ 1/max(co, c); the denominator does not count below 1e-8.
  const float larger = std::max({t.cos_o, min_sine, 1e-4f});
  const float share = factor == CosineFactor::cosine
                          ? std::min(1 / larger, max_sine / square(std::max(t.cos_o, 1e-4f)))
                          : 1 / square(larger);
  return t.scale * (std::pow(std::cos(off), t.lobe->alpha_u) * share);
}
float hair_specular_roughness(const Lobe& lobe) { return std::sqrt(2 / (lobe.alpha_u + 2)); }

}  // namespace

constinit const LobeFamily hair_diffuse_family{.value = hair_diffuse_value,
                                               .pdf = hair_diffuse_pdf,
                                               .sample = hair_diffuse_sample,
                                               .albedo = color_albedo,
                                               .factor_of_wo = hair_diffuse_factor,
                                               .fiber_bound = hair_diffuse_bound};

constinit const LobeFamily hair_specular_family{.value = hair_specular_value,
                                                .pdf = hair_specular_pdf,
                                                .sample = hair_specular_sample,
                                                .albedo = hair_specular_albedo,
                                                .factor_of_wo = hair_specular_factor,
                                                .fiber_bound = hair_specular_bound,
                                                .power = true,
                                                .roughness = hair_specular_roughness};

}  // namespace lumirank::scatter
