// Light that goes straight between two places, through participating media and through surfaces that let it
// pass.
#pragma once

#include <cmath>

#include "media/tracking.h"
#include "world/world.h"

namespace lumirank::world {

// A bound on straight passes, so that coincident null surfaces cannot hold a ray for ever.
inline constexpr int kMaxPasses = 4096;

// The open segment from `from` towards `direction` (unit) for `distance` (may be infinite). `ng`: the
// geometric normal of the surface there, zero in a medium. `medium`: the one into which it leads.
struct StraightSegment {
  Vec3f from, ng, direction;
  float distance;
  int medium;
};

// What of the light is left by surfaces that let it pass and by media, as an unbiased estimate (exact through
// homogeneous media); `blocked`: an opaque surface is in between. With `through_opaque` the media behind such
// a surface are counted all the same; else what is left is 0 then. `random()` gives numbers in [0, 1).
struct Arriving {
  Rgb left{1};
  bool blocked = false;
};
enum class Behind : std::uint8_t { stop, go_on };  // an opaque surface
template <typename Random, typename Surface>
Arriving pass(const World& world, const StraightSegment& segment, Behind behind, Random&& random,
              Surface&& surface) {
  const bool endless = !std::isfinite(segment.distance);
  const Vec3f target = endless ? Vec3f{} : segment.from + segment.direction * segment.distance;
  geometry::Ray ray{segment.ng == Vec3f{} ? segment.from
                                          : World::offset_origin(segment.from, segment.ng, segment.direction),
                    segment.direction};
  int medium = segment.medium;
  Arriving out;
  for (int step = 0; step < kMaxPasses; ++step) {
    float way = kInfinity;
    if (!endless) {
      // Aimed anew from the moved origin, which may be farther off a surface than the open end is long.
      way = length(target - ray.origin);
      if (!(way > 0)) return out;
      ray.direction = (target - ray.origin) / way;
      ray.t_max = way * (1 - 1e-4f);  // what stands at the end must not block
    }
    const auto hit = world.rays().intersect(ray);
    const bool opaque =
        hit && world.rays().placements()[hit->instance].blocking == geometry::Blocking::opaque;
    out.blocked |= opaque;
    if (opaque && behind == Behind::stop) {
      out.left = Rgb{0};
      return out;
    }
    if (medium >= 0)
      out.left *= media::transmittance(world.media()[static_cast<std::size_t>(medium)], ray.origin,
                                       ray.direction, hit ? hit->t : way, random);
    if (!hit || is_black(out.left)) return out;
    const SurfaceHit at = world.surface(*hit, ray.direction);
    if (!opaque) out.left *= surface(at, ray.direction);
    if (is_black(out.left)) return out;
    medium = world.medium_beyond(at, ray.direction, medium);
    ray.origin = World::offset_origin(at.point.position, at.point.ng, ray.direction);
  }
  return {Rgb{0}, true};
}

template <typename Random>
Arriving pass_straight(const World& world, const StraightSegment& segment, bool through_opaque,
                       Random&& random) {
  return pass(world, segment, through_opaque ? Behind::go_on : Behind::stop, random,
              [&](const SurfaceHit& hit, Vec3f direction) {
                return world.materials().transmittance(hit.material, hit.point, direction);
              });
}

// What media alone leave of it, whatever surfaces there are.
template <typename Random>
Rgb pass_media(const World& world, const StraightSegment& segment, Random&& random) {
  return pass(world, segment, Behind::go_on, random, [](const SurfaceHit&, Vec3f) { return Rgb(1); }).left;
}

}  // namespace lumirank::world
