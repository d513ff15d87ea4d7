// Every BSDF that is subjected to the tests all BSDFs must pass. A new material or lobe gets a line in
// bsdf_list.cpp.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
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

// For tests with an index into the list: the name of their case, of letters, digits and underscores alone.
inline std::string name_of(const testing::TestParamInfo<int>& index) {
  std::string name = bsdf_list()[static_cast<std::size_t>(index.param)].name;
  std::replace(name.begin(), name.end(), '.', '_');
  return name;
}

// Inputs without a texture.
inline ColorInput gray(float v) { return {Rgb(v), -1}; }
inline FloatInput number(float v) { return {v, -1}; }

// A point at the origin with normal `n` and an arbitrary tangent; uv in the middle of a texel.
SurfacePoint point_with_normal(Vec3f n);
// Unit vector with the given cosine to +z.
Vec3f at_angle(float cos_theta, float phi);

}  // namespace lumirank::scatter
