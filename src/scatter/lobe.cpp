// A lobe through its family, with what lies over it.
#include "scatter/lobe.h"

#include "scatter/lobes/charlie_sheen.h"
#include "scatter/lobes/family.h"

namespace lumirank::scatter {
Rgb quadrature_albedo(LobeView view, Vec3f wo) {
  // A Fibonacci lattice: no two-dimensional rule of so few points is much better.
  const int count = view.roughly ? 13 : 55, step = view.roughly ? 8 : 34;
  Rgb sum(0);
  for (int k = 0; k < count; ++k) {
    const Vec2f u{(static_cast<float>(k) + 0.5f) / static_cast<float>(count),
                  (static_cast<float>(k * step % count) + 0.5f) / static_cast<float>(count)};
    Vec3f wi;
    if (!lobe_sample(view, wo, u, wi)) continue;
    const float pdf = lobe_pdf(view, wo, wi);
    const float cosine = is_hair(view.lobe.kind) ? fiber_sine(wi) : std::abs(wi.z);
    if (pdf > 0) sum += lobe_value(view, wo, wi) * (cosine / pdf);
  }
  // As a share of energy: without the scaling of radiance.
  const float scale = family_of(view.lobe.kind).refracts ? view.eta * view.eta : 1.0f;
  return sum * (scale / static_cast<float>(count));
}

bool draws_cosine(LobeKind kind) { return family_of(kind).sample == cosine_sample; }

Rgb lobe_value(LobeView view, Vec3f wo, Vec3f wi) {
  return view.lobe.coat ? coated_value(view, wo, wi) : bare_value(view, wo, wi);
}
float lobe_pdf(LobeView view, Vec3f wo, Vec3f wi) {
  return view.lobe.coat ? coated_pdf(view, wo, wi) : bare_pdf(view, wo, wi);
}
bool lobe_sample(LobeView view, Vec3f wo, Vec2f u, Vec3f& wi) {
  return view.lobe.coat ? coated_sample(view, wo, u, wi) : bare_sample(view, wo, u, wi);
}
Rgb lobe_albedo(LobeView view, Vec3f wo) {
  return view.lobe.coat ? coated_albedo(view, wo) : bare_albedo(view, wo);
}
float lobe_importance(LobeView view, float cos_o) {
  return view.lobe.coat ? coated_importance(view, cos_o) : bare_importance(view, cos_o);
}
bool delta_direction(LobeView view, Vec3f wo, Vec3f& wi, Rgb& coefficient) {
  return view.lobe.coat ? coated_delta_direction(view, wo, wi, coefficient)
                        : bare_delta_direction(view, wo, wi, coefficient);
}

Rgb bare_value(LobeView view, Vec3f wo, Vec3f wi) {
  const Rgb value = family_of(view.lobe.kind).value(view, wo, wi);
  return view.lobe.sheen_layer ? value * sheen_layer_factor(view.lobe.sheen_layer, std::min(wo.z, wi.z))
                               : value;
}

float bare_pdf(LobeView view, Vec3f wo, Vec3f wi) { return family_of(view.lobe.kind).pdf(view, wo, wi); }

bool bare_sample(LobeView view, Vec3f wo, Vec2f u, Vec3f& wi) {
  return family_of(view.lobe.kind).sample(view, wo, u, wi);
}

Rgb bare_albedo(LobeView view, Vec3f wo) {
  if (is_delta(view.lobe.kind)) {
    Vec3f wi;
    Rgb coefficient;
    return bare_delta_direction(view, wo, wi, coefficient) ? coefficient : Rgb(0);
  }
  return view.lobe.sheen_layer ? quadrature_albedo(view, wo) : family_of(view.lobe.kind).albedo(view, wo);
}

float bare_importance(LobeView view, float cos_o) {
  const SheenLayer& sheen_layer = view.lobe.sheen_layer;
  return family_of(view.lobe.kind).importance(view, cos_o) *
         (sheen_layer ? std::max(0.05f, sheen_layer_factor(sheen_layer, cos_o)) : 1.0f);
}

bool bare_delta_direction(LobeView view, Vec3f wo, Vec3f& wi, Rgb& coefficient) {
  const SheenLayer& sheen_layer = view.lobe.sheen_layer;
  if (!family_of(view.lobe.kind).direction(view, wo, wi, coefficient)) return false;
  if (sheen_layer) coefficient *= sheen_layer_factor(sheen_layer, wo.z);
  return !is_black(coefficient);
}

float lobe_roughness(const Lobe& lobe) {
  const LobeFamily& family = family_of(lobe.kind);
  if (!family.roughness) return 1;
  // Refraction into the open widens what lies under a coat.
  const float wider = lobe.coat ? lobe.coat.bend : 1.0f;
  return std::min(1.0f, wider * family.roughness(lobe));
}

}  // namespace lumirank::scatter
