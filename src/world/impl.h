// Implementation of World.
#pragma once

#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "world/light_sampler.h"
#include "world/world.h"

namespace lumirank::world {

struct World::Impl {
  struct PlacementData {
    bool identity = true;
    bool keeps_angles = true;  // moves, turns, mirrors and scales all directions alike
    bool hair = false;         // fibers of hair: points lie on the axis and have no geometric normal
    bool flip = false;         // the outside is against the order of the corners in the mesh's own frame
    Transform to_world, inverse;
    scenedesc::MediumInterfaceDesc media;
  };

  std::optional<geometry::RayScene> rays;
  scatter::MaterialSet materials;
  std::vector<PlacementData> placements;
  std::vector<std::uint64_t> placement_ids;
  std::vector<media::Medium> media;
  std::vector<emitters::Emitter> emitters;
  std::vector<scatter::ColorInput> radiance;  // of area emitters; unused for the others
  int environment = -1;
  bool hides_emitters = false;
  std::vector<Rgb> absorption;    // by medium, where they are the color of glass and `media` is empty
  std::vector<std::size_t> suns;  // emitters with a disc
  Bounds3f bounds;
  Units units;
  WorldInfo info;
  std::once_flag sampler_made;
  std::unique_ptr<const LightSampler> sampler;

  // Everything at a point of a triangle; normals towards the outside.
  SurfaceHit surface(const geometry::Hit& hit, Vec3f ray_direction) const;
  scatter::SurfaceUv uv(const geometry::Hit& hit) const;
  // The same for a segment of a fiber (fiber_surface.cpp); position, normals and tangents only.
  scatter::SurfacePoint fiber_surface(const geometry::Hit& hit, Vec3f ray_direction) const;
  Rgb emitted_at(int emitter, std::uint32_t triangle, Vec2f barycentric) const;
};

}  // namespace lumirank::world
