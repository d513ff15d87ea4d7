// Settings that decide the entries of a SceneMatrix beside its world, receivers and lights.
#pragma once

#include <cstdint>

#include "transport/pairs/sphere_rules.h"

namespace lumirank::transport {

struct SceneMatrixSettings {
  std::uint64_t seed = 1;
  float clamp = 1;  // X of the conventions; 0: off. Spherical lights need none and have none
  // What clamping takes is given back elsewhere: nothing is lost by it, and nothing else may be bounded.
  bool compensated = false;
  int max_depth =
      -1;  // Mitsuba's count; receiver depth + light depth + the connecting segment may not exceed it
  bool group_by_emitter = false;  // clusters may not cross emitters (for --aov light:NAME)
  // Lobes of receivers with a roughness below this get 0 from direct columns: their direct light is traced
  // (pipeline/traced_direct.h). Above 1: all lobes of all receivers.
  float traced_direct_below = 0;
  SphereRules spheres;  // where lights are spherical
  // Rows know their directional albedo (RowFeatures::albedo), which costs some time where they are glossy.
  bool row_albedo = false;
};

}  // namespace lumirank::transport
