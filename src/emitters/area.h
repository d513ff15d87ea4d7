// Making area emitters, and sampling points on them.
#pragma once

#include "emitters/emitter.h"

namespace lumirank::emitters {

// Fills by_power and total_area from `triangles`. Triangles of zero area get no probability; a lit triangle
// whose mean is far below the emitter's keeps a hundredth of the average probability per area, because the
// mean of a textured triangle comes from a few points and may miss a bright spot that the exact lookup finds
// (probability 0 there would lose its light).
void finish(AreaEmitter& emitter);

// A point on the emitter, chosen by power, uniform within the triangle.
struct AreaPoint {
  std::uint32_t triangle = 0;
  Vec2f barycentric;
  Vec3f position;
  float pdf = 0;  // per area; 0 if the emitter has no power
};
AreaPoint sample_area(const AreaEmitter& emitter, float u1, Vec2f u2);

// Solid-angle density of a point that is drawn evenly on a triangle and found along `direction` at
// `distance`; 0 from behind.
float pdf_direct_triangle(const AreaEmitter::Triangle& triangle, Vec3f direction, float distance);

}  // namespace lumirank::emitters
