#include "media/phase.h"

#include <algorithm>

#include "base/frame.h"

namespace lumirank::media {
namespace {

constexpr float kUniform = 0.25f * kInvPi;

// Schlick's k of a mean cosine: the paper's fit, which passes 1 from 0.94 on and means nothing there.
float schlick_k(float g) { return std::clamp(1.55f * g - 0.55f * g * g * g, -0.999f, 0.999f); }

float value(PhaseLobe::Kind kind, float mean_cosine, float cosine) {
  if (mean_cosine == 0) return kUniform;
  if (kind == PhaseLobe::Kind::schlick) {
    const float k = schlick_k(mean_cosine);
    return kUniform * (1 - k * k) / square(1 - k * cosine);
  }
  // 1 + g² - 2g·cos, written so that nothing cancels for |g| near 1.
  const float g = std::abs(mean_cosine), ahead = mean_cosine < 0 ? -cosine : cosine;
  const float denominator = square(1 - g) + 2 * g * (1 - ahead);
  return kUniform * (1 - g * g) / (denominator * std::sqrt(denominator));
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

Rgb value(const PhaseLobe& lobe, float cosine) {
  const float r = value(lobe.kind, lobe.g.r, cosine);
  if (lobe.g.r == lobe.g.g && lobe.g.g == lobe.g.b) return Rgb(r);
  return {r, value(lobe.kind, lobe.g.g, cosine), value(lobe.kind, lobe.g.b, cosine)};
}

}  // namespace

Rgb PhaseFunction::eval(float cosine) const {
  Rgb sum{0};
  for (std::size_t k = 0; k < static_cast<std::size_t>(count); ++k)
    sum += lobes[k].weight * value(lobes[k], cosine);
  return sum;
}

Vec3f PhaseFunction::sample(Vec3f forward, int channel, float u_lobe, Vec2f u) const {
  std::size_t chosen = 0;
  while (chosen + 1 < static_cast<std::size_t>(count) && u_lobe >= lobes[chosen].weight)
    u_lobe -= lobes[chosen++].weight;
  const float cosine = static_cast<float>(
      std::clamp(sample_cosine(lobes[chosen].kind, lobes[chosen].g[channel], u.x), -1.0, 1.0));
  const float sine = std::sqrt(std::max(0.0f, 1 - cosine * cosine)), phi = 2 * kPi * u.y;
  return Frame::from_normal(forward).to_world({sine * std::cos(phi), sine * std::sin(phi), cosine});
}

Rgb PhaseFunction::max_value() const {
  // Each lobe has its maximum straight ahead or straight back; the sum of maxima bounds the sum.
  Rgb sum{0};
  for (std::size_t k = 0; k < static_cast<std::size_t>(count); ++k)
    for (int c = 0; c < 3; ++c)
      sum[c] += lobes[k].weight * value(lobes[k].kind, lobes[k].g[c], lobes[k].g[c] < 0 ? -1.0f : 1.0f);
  return sum;
}

bool PhaseFunction::gray() const {
  for (std::size_t k = 0; k < static_cast<std::size_t>(count); ++k)
    if (lobes[k].g.r != lobes[k].g.g || lobes[k].g.g != lobes[k].g.b) return false;
  return true;
}

}  // namespace lumirank::media
