// A material's inputs on their way to a BSDF.
#pragma once

#include "scenedesc/gltf/reader.h"

namespace lumirank::scenedesc::gltf {

struct Reader::Surface {
  ColorInput base;
  FloatInput metallic, roughness;
  FloatInput alpha;       // roughness²: the width of GGX
  FloatInput stretch{0};  // KHR_materials_anisotropy, see PlasticDesc
  float ior = 1.5f;
  // KHR_materials_pbrSpecularGlossiness: reflectance at normal incidence, over `base`.
  std::optional<ColorInput> specular;
};

}  // namespace lumirank::scenedesc::gltf
