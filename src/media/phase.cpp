#include "media/phase.h"

#include <algorithm>
#include <cmath>
#include <type_traits>

#include "base/frame.h"

namespace lumirank::media {
namespace {

constexpr float kUniform = 0.25f * kInvPi;

// Schlick's k of a mean cosine: the paper's fit, which passes 1 from 0.94 on and means nothing there.
float schlick_k(float g) { return std::clamp(1.55f * g - 0.55f * g * g * g, -0.999f, 0.999f); }

// One number, or the same in all lanes.
template <typename Real>
Real constant(float x) {
  if constexpr (std::is_same_v<Real, Lane>)
    return splat(x);
  else
    return x;
}
float root(float x) { return std::sqrt(x); }
Lane root(Lane x) { return lumirank::sqrt(x); }

template <typename Real>
Real value(PhaseLobe::Kind kind, float mean_cosine, Real cosine) {
  const auto all = constant<Real>;
  if (mean_cosine == 0) return all(kUniform);
  if (kind == PhaseLobe::Kind::schlick) {
    const float k = schlick_k(mean_cosine);
    const Real way = all(1) - all(k) * cosine;
    return all(kUniform * (1 - k * k)) / (way * way);
  }
  // 1 + g² - 2g·cos, written so that nothing cancels for |g| near 1.
  const float g = std::abs(mean_cosine);
  const Real ahead = mean_cosine < 0 ? -cosine : cosine;
  const Real denominator = all(square(1 - g)) + all(2 * g) * (all(1) - ahead);
  return all(kUniform * (1 - g * g)) / (denominator * root(denominator));
}

// By inverting the integral of value() over the cosine from -1. In double precision: for small g most of it
// cancels.
double sample_cosine(PhaseLobe::Kind kind, float mean_cosine, double u) {
  if (mean_cosine == 0) return 2 * u - 1;
  if (kind == PhaseLobe::Kind::schlick) {
    const double k = schlick_k(mean_cosine);
    return (2 * u + k - 1) / (2 * k * u - k + 1);
  }
  const double g = mean_cosine, s = (1 - g * g) / (1 - g + 2 * g * u);
  return (1 + g * g - s * s) / (2 * g);
}

template <typename Color, typename Real>
Color sum_of(const PhaseFunction& f, Real cosine) {
  Real r = constant<Real>(0), g = r, b = r;
  for (std::size_t k = 0; k < static_cast<std::size_t>(f.count); ++k) {
    const PhaseLobe& lobe = f.lobes[k];
    const Real weight = constant<Real>(lobe.weight), first = weight * value(lobe.kind, lobe.g.r, cosine);
    const bool gray = lobe.g.r == lobe.g.g && lobe.g.g == lobe.g.b;
    r = r + first;
    g = g + (gray ? first : weight * value(lobe.kind, lobe.g.g, cosine));
    b = b + (gray ? first : weight * value(lobe.kind, lobe.g.b, cosine));
  }
  return {r, g, b};
}

}  // namespace

Rgb PhaseFunction::eval(float cosine) const { return sum_of<Rgb>(*this, cosine); }
Lane3 PhaseFunction::eval(Lane cosine) const { return sum_of<Lane3>(*this, cosine); }

Vec3f PhaseFunction::sample(Vec3f forward, int channel, float u_lobe, Vec2f u) const {
  std::size_t chosen = 0;
  while (chosen + 1 < static_cast<std::size_t>(count) && u_lobe >= lobes[chosen].weight)
    u_lobe -= lobes[chosen++].weight;
  const float cosine = static_cast<float>(
      std::clamp(sample_cosine(lobes[chosen].kind, lobes[chosen].g[channel], u.x), -1.0, 1.0));
  const float sine = std::sqrt(std::max(0.0f, 1 - cosine * cosine)), phi = 2 * kPi * u.y;
  return Frame::from_normal(forward).to_world({sine * std::cos(phi), sine * std::sin(phi), cosine});
}

Rgb PhaseFunction::max_value(float min_cosine, float max_cosine) const {
  // Each lobe is greatest at one end or the other; the sum of maxima bounds the sum.
  Rgb sum{0};
  for (std::size_t k = 0; k < static_cast<std::size_t>(count); ++k)
    for (int c = 0; c < 3; ++c)
      sum[c] +=
          lobes[k].weight * value(lobes[k].kind, lobes[k].g[c], lobes[k].g[c] < 0 ? min_cosine : max_cosine);
  return sum;
}

bool PhaseFunction::gray() const {
  for (std::size_t k = 0; k < static_cast<std::size_t>(count); ++k)
    if (lobes[k].g.r != lobes[k].g.g || lobes[k].g.g != lobes[k].g.b) return false;
  return true;
}

}  // namespace lumirank::media
