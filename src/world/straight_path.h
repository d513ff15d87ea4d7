// Light that goes straight between two places, through participating media and through surfaces that let it
// pass.
#pragma once

#include <cmath>
#include <vector>

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

// What of the light is left by surfaces and by media, as an unbiased estimate (exact through homogeneous
// media); opaque surfaces leave nothing. `random()` gives numbers in [0, 1).
template <typename Random>
Rgb pass_straight(const World& world, const StraightSegment& segment, Random&& random) {
  const bool endless = !std::isfinite(segment.distance);
  const Vec3f target = endless ? Vec3f{} : segment.from + segment.direction * segment.distance;
  geometry::Ray ray{segment.ng == Vec3f{} ? segment.from
                                          : World::offset_origin(segment.from, segment.ng, segment.direction),
                    segment.direction};
  int medium = segment.medium;
  Rgb left{1};
  for (int step = 0; step < kMaxPasses; ++step) {
    float way = kInfinity;
    if (!endless) {
      // Aimed anew from the moved origin, which may be farther off a surface than the open end is long.
      way = length(target - ray.origin);
      if (!(way > 0)) return left;
      ray.direction = (target - ray.origin) / way;
      ray.t_max = way * (1 - 1e-4f);  // what stands at the end must not block
    }
    const auto hit = world.rays().intersect(ray);
    if (hit && world.rays().placements()[hit->instance].blocking == geometry::Blocking::opaque) return Rgb{0};
    if (medium >= 0)
      left *= media::transmittance(world.media()[static_cast<std::size_t>(medium)], ray.origin, ray.direction,
                                   hit ? hit->t : way, random);
    if (!hit || is_black(left)) return left;
    const SurfaceHit at = world.surface(*hit, ray.direction);
    left *= world.materials().transmittance(at.material, at.point, ray.direction);
    if (is_black(left)) return left;
    medium = world.medium_beyond(at, ray.direction, medium);
    ray.origin = World::offset_origin(at.point.position, at.point.ng, ray.direction);
  }
  return Rgb{0};
}

// What media leave of a segment that starts off any surface and that nothing blocks (or as if nothing opaque
// stood there), and with `panes` the surfaces that let it pass. `crossed` is work space.
enum class Panes : std::uint8_t { left_out, counted };
template <typename Random>
void pass_open(const World& world, const StraightSegment& segment, Panes panes, media::OpticalPath& path,
               std::vector<geometry::Hit>& crossed, Random&& random) {
  int medium = segment.medium;
  float passed = 0;
  const auto fly_to = [&](float t) {
    if (medium >= 0)
      path.add(world.media()[static_cast<std::size_t>(medium)], segment.from + segment.direction * passed,
               segment.direction, t - passed, random);
    passed = t;
  };
  const float open = geometry::kShadowEpsilon;
  world.rays().crossings(
      {segment.from, segment.direction, std::isfinite(segment.distance) ? open * segment.distance : open,
       segment.distance * (1 - open)},
      crossed);
  for (const geometry::Hit& hit : crossed) {
    fly_to(hit.t);
    const SurfaceHit at = world.surface(hit, segment.direction);
    if (panes == Panes::counted)
      path.ratio *= world.materials().transmittance(at.material, at.point, segment.direction);
    if (is_black(path.ratio)) return;
    medium = world.medium_beyond(at, segment.direction, medium);
  }
  fly_to(segment.distance);
}

}  // namespace lumirank::world
