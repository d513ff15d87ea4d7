// Bound of what a light, or a group of lights, can send to a point: the numbers a light tree decides by.
// A. Conty Estevez, C. Kulla, "Importance Sampling of Many Lights with Adaptive Tree Splitting", 2018.
#pragma once

#include "base/bounds.h"
#include "base/vec.h"

namespace lumirank::emitters {

// Where light leaves and which way: normals lie within `spread` of `axis`, and nothing is emitted more than
// `reach` away from all of them; in between at most `intensity` times the cosine of the angle to the nearest
// normal.
struct LightBound {
  Bounds3f bounds;
  Vec3f axis{0, 0, 1};    // unit
  float spread = 0;       // radians, π: all directions
  float reach = kPi / 2;  // radians, at most π/2
  float intensity = 0;    // greatest radiant intensity (W/sr), summed over the lights of a group
};

// The least cone of normals known to hold both cones, boxes joined, intensities added. One of no intensity is
// ignored.
LightBound join(const LightBound& a, const LightBound& b);

// The solid angle into which a group emits, weighted with the cosine beyond its normals (the paper's M_Ω).
float emission_measure(const LightBound& bound);

// The point to be lit. A direction matters as far as it makes an angle below 90° with `normal` (or with
// -normal, if `both_sides`). A zero normal: all directions matter alike.
struct LitPoint {
  Vec3f position;
  Vec3f normal{0, 0, 1};  // unit, or zero
  bool both_sides = false;
};

}  // namespace lumirank::emitters
