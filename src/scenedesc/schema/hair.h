// Physical descriptions of hair → the nearest Kajiya-Kay parameters.
#pragma once

#include "base/rgb.h"
#include "scenedesc/schema/scene_desc.h"

namespace lumirank::scenedesc {

// Degrees; real hair has two or three.
inline constexpr float kMaxHairTilt = 20;

// Absorption per radius of a fiber with so much of the two pigments of hair (d'Eon et al. 2011, section 6.1).
Rgb hair_absorption(float eumelanin, float pheomelanin);

// For the model of Marschner et al. 2003 in the parameters of Chiang et al. 2016: absorption `sigma_a` per
// radius, relative index `eta`, longitudinal roughness `beta_m` in [0, 1]. At light across the fiber the
// result has the same share of energy, split alike: what is reflected at the surface is specular, with an
// exponent of the same width, and what has been inside is diffuse.
HairDesc hair_from_absorption(Rgb sigma_a, float eta, float beta_m);

// The inverse, as near as it comes; textured inputs count with their constant value. The specular share is
// that of the mean channel, and diffuse shares beyond what clear hair has become those of clear hair.
struct HairAbsorption {
  Rgb sigma_a{0};
  float eta = 1, beta_m = 0;
};
HairAbsorption hair_to_absorption(const HairDesc& hair);

}  // namespace lumirank::scenedesc
