#include "pathtrace/found_emission.h"

namespace lumirank::pathtrace {

FoundEmission found_emission(const world::World& world, const world::LightSampler& lights,
                             const emitters::LitPoint* from, const world::SurfaceHit* hit, Vec3f direction,
                             float distance, std::optional<Vec2f> on_map) {
  FoundEmission found;
  if (hit) {
    if (hit->emitter < 0) return found;
    found.radiance = world.emitted(*hit, -direction);
    if (from && !is_black(found.radiance)) found.light_pdf = lights.pdf_hit(*from, *hit, direction, distance);
    return found;
  }
  if (from) {
    const auto seen = on_map ? lights.background_at(*from, *on_map) : lights.background(*from, direction);
    found.radiance = seen.radiance, found.light_pdf = seen.pdf;
  } else {
    // Light sampling takes all of a sun's light elsewhere: its disc is met only directly and in mirrors.
    found.radiance =
        (on_map ? lights.background_at(*on_map) : world.background(direction)) + world.sun_disc(direction);
  }
  return found;
}

}  // namespace lumirank::pathtrace
