// The integral of one spherical light at one receiver, by multiple importance sampling of three strategies.
#pragma once

#include <cstdint>

#include "base/rgb.h"
#include "base/vec.h"
#include "scatter/closure.h"

namespace lumirank::transport {

// Both ends of a pair. Directions are unit and point away from their surface.
struct SphereEnds {
  const scatter::Closure& x;  // receiver
  const scatter::Closure& y;  // light
  Vec3f wo;                   // towards the eye
  Vec3f incoming;             // back along the light's path
  Vec3f n;                    // the receiver's shading normal; of a fiber, the direction to the light
  Vec3f ng;                   // the light's geometric normal
  Vec3f w;                    // from receiver to light, not normalized
  float radius;
  bool disc;  // I: whether l meets the disc; else cosθy. Never on a fiber
};

// How many samples each strategy gets: uniform in the cone, BSDF at the receiver, BSDF at the light.
struct SphereSamples {
  int cone = 1, receiver = 1, light = 1;
};

// ∫_Ω f_x cosθx f_y I dl, without Φ/(πr²), by the balance heuristic; unbiased with at least one sample in the
// cone. Stratified within each strategy; random numbers belong to `key`.
Rgb sphere_integral(const SphereEnds& ends, SphereSamples samples, std::uint64_t key);

// The integrand at a unit direction l within Ω, for quadratures.
Rgb sphere_integrand(const SphereEnds& ends, Vec3f l);

// The axis of Ω and the cosine of its half angle: the cone, or the receiver's hemisphere on the light's side
// from inside.
struct SphereCone {
  Vec3f axis;
  float cos_max;
  float solid_angle;
};
SphereCone sphere_cone(Vec3f n, Vec3f w, float radius);

}  // namespace lumirank::transport
