// What shines where a path arrives, and how likely light sampling would have found it.
#pragma once

#include <optional>

#include "base/rgb.h"
#include "world/light_sampler.h"
#include "world/world.h"

namespace lumirank::pathtrace {

struct FoundEmission {
  Rgb radiance;  // along the path, against its direction
  float light_pdf =
      0;  // of light sampling at the path's last vertex, per solid angle; 0 if that was specular
};

// `from`: the last vertex, nullptr if it was specular (or the eye), where nothing was sampled. `hit`: nullptr
// where the path leaves the scene. `distance`: from the last vertex.
FoundEmission found_emission(const world::World& world, const world::LightSampler& lights,
                             const emitters::LitPoint* from, const world::SurfaceHit* hit, Vec3f direction,
                             float distance, std::optional<Vec2f> on_map = {});

}  // namespace lumirank::pathtrace
