// Directional albedo of isotropic microfacet reflection in constant time, from moments of the visible normals
// that are tabulated once per distribution.
#pragma once

#include <vector>

#include "scatter/closure.h"
#include "scatter/lobe.h"

namespace lumirank::scatter {

// Over the visible normals m of one direction wo, with g = G1(reflected):
struct ReflectionMoments {
  float white = 0;    // mean of g: the albedo of a perfect mirror's microfacets
  float schlick = 0;  // mean of g·(1 - wo·m)⁵
};
// Bilinear in √alpha (held within [0, 1]) and in the cosine of wo. Thread-safe; built at first use.
ReflectionMoments reflection_moments(NormalDistribution distribution, float alpha, float cos_o);

// Albedo of a microfacet_reflect lobe, as if both alphas were their geometric mean: the white one times the
// Fresnel factor at the cosine whose Schlick weight is the mean one. Exact for Schlick's curve, and near it
// for all that look alike.
Rgb microfacet_reflect_albedo(LobeView view, float cos_o);
// Whether that, and the following, are within 0.12 for any microfacet lobe of these alphas.
bool table_tells_roughly(const Lobe& lobe);
// Of microfacet_transmit and thin_transmit lobes: what is not reflected at that cosine.
Rgb rough_transmit_albedo(LobeView view, float eta, float cos_o);

}  // namespace lumirank::scatter
