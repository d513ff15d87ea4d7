// Short pbrt scenes for tests.
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "scenedesc/readers.h"

namespace lumirank::scenedesc {

// `world`: what comes after WorldBegin, which is line 2.
inline SceneDesc pbrt_world(const std::string& world, const std::string& head = "",
                            const ReadOptions& options = {}) {
  return parse_pbrt(head + "\nWorldBegin\n" + world, testing::TempDir() + "scene.pbrt", options);
}

// The only warning of the scene; fails if there are more or none.
inline Warning only_warning(const SceneDesc& scene) {
  EXPECT_EQ(scene.warnings.size(), 1u) << describe(scene);
  return scene.warnings.empty() ? Warning{} : scene.warnings[0];
}

template <typename Kind>
const Kind& shape(const SceneDesc& scene, std::size_t index = 0) {
  return std::get<Kind>(scene.shapes.at(index).kind);
}

inline const VolumeDesc& volume(const SceneDesc& scene, const VolumeInput& input) {
  return scene.volumes.at(static_cast<std::size_t>(input.volume));
}

// The material of the only shape, below the wrapper that makes it two-sided.
template <typename Kind>
const Kind& inner(const SceneDesc& scene, std::size_t shape_index = 0) {
  const auto& outer = scene.bsdfs.at(static_cast<std::size_t>(scene.shapes.at(shape_index).bsdf)).kind;
  if (const auto* two = std::get_if<TwoSidedDesc>(&outer)) {
    EXPECT_EQ(two->front, two->back);
    return std::get<Kind>(scene.bsdfs.at(static_cast<std::size_t>(two->front)).kind);
  }
  return std::get<Kind>(outer);
}

inline const std::string kSphere = "Shape \"sphere\"\n";

// A sphere of this material.
inline SceneDesc pbrt_material(const std::string& material, const std::string& before = "") {
  return pbrt_world(before + "Material " + material + "\n" + kSphere);
}

inline void expect_near(Rgb have, Rgb want, float tolerance) {
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(have[k], want[k], tolerance) << "channel " << k;
}

}  // namespace lumirank::scenedesc
