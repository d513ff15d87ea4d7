// Every BSDF that is subjected to the tests all BSDFs must pass. A new material or lobe gets a line in
// bsdf_list.cpp.
#pragma once

#include <string>
#include <vector>

#include "scatter/material.h"

namespace lumirank::scatter {

struct BsdfCase {
  std::string name;
  MaterialSet set;
  int material = 0;
  bool lossless = false;      // reflects and transmits together exactly what arrives
  bool inside_too = false;    // has lobes for wo on the inside
  float eta = 1;              // index inside over outside, for the reciprocity of transmission
  bool fiber = false;         // has no sides: lobes all around
  std::string energy_exempt;  // why the model may make energy; empty: it may not
};

const std::vector<BsdfCase>& bsdf_list();

// A point at the origin with normal `n` and an arbitrary tangent; uv in the middle of a texel.
SurfacePoint point_with_normal(Vec3f n);
// Unit vector with the given cosine to +z.
Vec3f at_angle(float cos_theta, float phi);

}  // namespace lumirank::scatter
