#include <cmath>

#include "scatter/closure_builder.h"
#include "scatter/microfacet.h"

namespace lumirank::scatter {
namespace {

float unit(float x) { return x > 0 ? std::min(x, 1.0f) : 0.0f; }  // NaN: 0

}  // namespace

Rgb reflectance(const TextureSet& textures, const ColorInput& input, const SurfaceUv& uv) {
  const Rgb c = input.texture >= 0 ? textures.lookup(input.texture, uv) : input.value;
  return {unit(c.r), unit(c.g), unit(c.b)};
}

Rgb positive_color(const TextureSet& textures, const ColorInput& input, const SurfaceUv& uv) {
  const Rgb c = input.texture >= 0 ? textures.lookup(input.texture, uv) : input.value;
  const auto positive = [](float x) { return x > 0 && std::isfinite(x) ? x : 0.0f; };
  return {positive(c.r), positive(c.g), positive(c.b)};
}

float number(const TextureSet& textures, const FloatInput& input, const SurfaceUv& uv) {
  const float x = input.texture >= 0 ? textures.lookup_float(input.texture, uv) : input.value;
  return std::isfinite(x) ? x : 0.0f;
}

float fraction(const TextureSet& textures, const FloatInput& input, const SurfaceUv& uv) {
  return unit(number(textures, input, uv));
}

float rough_alpha(const TextureSet& textures, const FloatInput& input, const SurfaceUv& uv) {
  return std::clamp(number(textures, input, uv), kMinAlpha, 1.0f);
}

std::vector<float> mixture_weights(const TextureSet& textures, const MixtureMaterial& m,
                                   const SurfaceUv& uv) {
  std::vector<float> weights;
  weights.reserve(m.parts.size());
  float sum = 0;
  for (const MixtureMaterial::Part& part : m.parts) {
    const float w = fraction(textures, part.weight, uv);
    weights.push_back(part.complement ? 1 - w : w);
    sum += weights.back();
  }
  if (sum > 1)
    for (float& w : weights) w /= sum;
  return weights;
}

}  // namespace lumirank::scatter
