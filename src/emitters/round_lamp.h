// Lamps that are round: convex bodies of many triangles which nearly fill a ball, as bulbs and globes do. As
// many leaves of a light tree they cost much, and their triangles take turns where one direction of a cone
// does: from outside, directions are drawn evenly over the cone of the ball around the lamp, and what such a
// ray meets first of the lamp shines. (P. Shirley, C. Wang, K. Zimmerman, "Monte Carlo Techniques for Direct
// Lighting Calculations", 1996, section 3.2, there for spheres themselves.)
#pragma once

#include <optional>

#include "emitters/emitter.h"

namespace lumirank::emitters {

// The ball around a lamp.
struct RoundLamp {
  Vec3f center;
  float radius = 0;

  // The cone of the ball, seen from a point. None from within the ball, or so far away that the directions of
  // a cone are too few in single precision.
  struct Cone {
    Vec3f axis;
    float one_minus_cosine = 0;  // of its half angle
    float pdf() const { return 1 / (2 * kPi * one_minus_cosine); }
    Vec3f sample(Vec2f u) const;
  };
  std::optional<Cone> cone(Vec3f point) const;
  // Where a ray with a unit direction is inside the ball, or a little more: [x, y]; x > y if it passes by.
  Vec2f span(Vec3f origin, Vec3f direction) const;
};

// None if the emitter is no such lamp: of few triangles, unseen, open, not convex, far from filling a ball,
// or brighter in some triangles than in others (drawn evenly, those would be noise).
std::optional<RoundLamp> round_lamp(const AreaEmitter& emitter);

}  // namespace lumirank::emitters
