// Scenes of pbrt-v3 (M. Pharr, W. Jakob, G. Humphreys, "Physically Based Rendering", third edition, 2016):
// what they say is put in the words of pbrt-v4 where that has them, and read as that. Materials, which
// differ, have a file of their own.
#pragma once

#include <string>
#include <string_view>

#include "scenedesc/pbrt/params.h"

namespace lumirank::scenedesc::pbrt {

// Whether a scene is one: it ends with WorldEnd, which pbrt-v4 does not know.
bool is_version3(std::string_view text);

// Each changes the parameters, and the type where that has another name.
void upgrade_film(Params& p, std::string& type);
void upgrade_filter(Params& p, const std::string& type);
void upgrade_camera(Params& p, std::string& type);
void upgrade_light(Params& p, const std::string& type);
void upgrade_area_light(Params& p, std::string& type);
void upgrade_shape(Params& p, const std::string& type);
void upgrade_texture(Params& p, const std::string& kind);
void upgrade_medium(Params& p);

// The width of microfacets of a roughness (TrowbridgeReitzDistribution::RoughnessToAlpha).
float alpha_of_version3(float roughness);

}  // namespace lumirank::scenedesc::pbrt
