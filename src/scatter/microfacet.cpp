#include "scatter/microfacet.h"

namespace lumirank::scatter {
namespace {

Vec3f sample_ggx(Vec3f w, Vec2f u) {
  const float phi = 2 * kPi * u.x;
  const float z = (1 - u.y) * (1 + w.z) - w.z;
  const float r = std::sqrt(std::max(0.0f, 1 - z * z));
  return Vec3f{r * std::cos(phi), r * std::sin(phi), z} + w;
}

// Inverse of erf: Winitzki's closed form, made exact by two Newton steps.
double erf_inverse(double y) {
  const double l = std::log((1 - y) * (1 + y)), a = 0.147, b = 2 / (3.14159265358979324 * a) + 0.5 * l;
  double x = std::copysign(std::sqrt(std::sqrt(b * b - l / a) - b), y);
  for (int i = 0; i < 2; ++i) x -= (std::erf(x) - y) * 0.886226925452758014 * std::exp(x * x);
  return x;
}

// Slopes (at roughness 1) visible from a direction whose azimuth is +x. The slope towards the viewer has the
// density (cosθ - s·sinθ)·exp(-s²) up to a factor, for s < cotθ.
double sample_beckmann_slope(double cos_theta, double sin_theta, double u) {
  constexpr double inv_2_sqrt_pi = 0.282094791773878143;
  const auto mass_below = [&](double s) {
    return 0.5 * cos_theta * (1 + std::erf(s)) + sin_theta * inv_2_sqrt_pi * std::exp(-s * s);
  };
  double lo = -6, hi = std::min(6.0, cos_theta / std::max(sin_theta, 1e-9));
  const double target = u * mass_below(hi);
  double s = std::min(0.0, 0.5 * (lo + hi));
  for (int i = 0; i < 60 && hi - lo > 1e-9; ++i) {
    const double excess = mass_below(s) - target;
    (excess > 0 ? hi : lo) = s;
    const double slope = 2 * inv_2_sqrt_pi * (cos_theta - s * sin_theta) * std::exp(-s * s);
    double next = s - excess / slope;
    if (!(next > lo && next < hi)) next = 0.5 * (lo + hi);
    if (std::abs(next - s) < 1e-7) return next;
    s = next;
  }
  return s;
}

Vec3f sample_beckmann(Vec3f w, Vec2f u) {
  const double r = std::sqrt(double(w.x) * w.x + double(w.y) * w.y);
  const double cos_phi = r > 0 ? w.x / r : 1, sin_phi = r > 0 ? w.y / r : 0;
  const double sx = sample_beckmann_slope(w.z, r, u.x);
  // Away from the ends, where the inverse is infinite.
  const double sy = erf_inverse(std::clamp(2.0 * u.y - 1, -1 + 1e-9, 1 - 1e-9));
  return {static_cast<float>(-(cos_phi * sx - sin_phi * sy)),
          static_cast<float>(-(sin_phi * sx + cos_phi * sy)), 1};
}

}  // namespace

Vec3f sample_visible_normal(NormalDistribution kind, Vec3f w, Vec2f u, float alpha_u, float alpha_v) {
  // Stretched so that the surface has roughness 1.
  const Vec3f stretched = normalize({w.x * alpha_u, w.y * alpha_v, w.z});
  const Vec3f h = kind == NormalDistribution::ggx ? sample_ggx(stretched, u) : sample_beckmann(stretched, u);
  const Vec3f m{h.x * alpha_u, h.y * alpha_v, std::max(h.z, 1e-9f)};
  return normalize(m);
}

}  // namespace lumirank::scatter
