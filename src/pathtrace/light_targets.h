// Bodies at which light paths are aimed: what is of smooth glass, mirrors or is polished metal, as spheres
// about its parts. Light that they bend or mirror is what light paths are for (light_tracer.h), and of all
// that the sun sends to a scene, or a lamp to a hall, hardly any meets them.
#pragma once

#include <optional>
#include <vector>

#include "world/world.h"

namespace lumirank::pathtrace {

class LightTargets {
 public:
  LightTargets() = default;  // none
  // Those near the eye, or large as it sees them, get the most paths.
  LightTargets(const world::World& world, Vec3f eye);

  bool empty() const { return radius_.empty(); }
  std::size_t size() const { return radius_.size(); }

  // Of a mixture with the starts that the emitter has by itself.
  static constexpr float kShare = 0.5f;
  // One of them, by its part of the paths; none for the share of u that the emitter keeps. u is stretched
  // again over [0, 1).
  std::optional<std::size_t> draw(float& u) const;

  // Densities of the whole mixture. Across a line through `place`, per area, of which the emitter by itself
  // has `own`:
  float per_area(Vec3f place, Vec3f direction, float own) const;
  // Per solid angle, of directions from a place on a surface with a normal (zero: of a point), of which the
  // emitter by itself has `own`. Targets around the place, and those below its horizon, leave it to that.
  float per_solid_angle(Vec3f place, Vec3f normal, Vec3f direction, float own) const;

  // A place on the disc that a target fills across a direction.
  Vec3f place_on(std::size_t target, Vec3f direction, Vec2f u) const;
  // A direction to a target; none where it is left to the emitter.
  std::optional<Vec3f> direction_to(std::size_t target, Vec3f place, Vec3f normal, Vec2f u) const;

 private:
  // 1 less the cosine of half the angle that a target fills as seen from a place with a normal; 0 where
  // directions are left to the emitter.
  float height_seen(float distance2, float along_normal, float radius) const;

  // By target. Apart, for they are asked all together.
  std::vector<float> x_, y_, z_, radius_, part_;  // parts of the paths sum to kShare
};

}  // namespace lumirank::pathtrace
