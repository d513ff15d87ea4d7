// Sheen of cloth: fibers that stand up from a base. Estevez and Kulla 2017, "Production Friendly Microfacet
// Sheen BRDF" (their distribution "Charlie"), with the visibility of Ashikhmin and Premoze 2007, as
// KHR_materials_sheen has it. Inside this room only.
//
//   f(wo, wi) = color · D(h)·V / max(1, E(wo), E(wi))
//   D(h) = (2 + 1/α)·sin(θh)^(1/α) / 2π        V = 1/(4·(cos_o + cos_i - cos_o·cos_i))
//
// E is the directional albedo of D·V. At grazing angles it exceeds 1 for roughness √α below 0.43; the
// denominator, ours, is for that. What is below keeps 1 - share·min(1, max(E(wo), E(wi))), share being the
// largest channel of the sheen's color, so that both together are reciprocal and make no light. E falls with
// the cosine: the larger of two is that of the smaller cosine.
#pragma once

#include "scatter/closure.h"

namespace lumirank::scatter {

// Roughness √α is held within [kMinSheenRoughness, 1].
inline constexpr float kMinSheenRoughness = 0.07f;

struct SheenAlbedo {
  float raw = 0;   // E
  float held = 0;  // albedo of f with a color of 1: at most 1
};
// Bilinear in the roughness and in the square root of the cosine. Thread-safe; built at first use.
SheenAlbedo sheen_albedo(float roughness, float cosine);

// What the sheen over a lobe leaves of it, given the smaller of the two cosines.
float sheen_layer_factor(const SheenLayer& sheen_layer, float min_cosine);

}  // namespace lumirank::scatter
