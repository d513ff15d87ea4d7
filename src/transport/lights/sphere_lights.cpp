#include "transport/lights/sphere_lights.h"

#include <algorithm>
#include <cmath>

#include "base/frame.h"
#include "base/neighbor_distance.h"
#include "base/parallel.h"
#include "base/random.h"
#include "matrix/lighting_matrix.h"

namespace lumirank::transport {
namespace {

// From errors against path tracing of five glossy scenes with 1,000 to 64,000 lights: best at 1.3 for
// 1,000, 2.6 for 8,000, 4 for 30,000, 5 for 64,000.
constexpr double kLightsAtOne = 470;
constexpr int kSectors = 8;
// How far above the surface a light's rays along it start, in radii: past the facets of curved surfaces.
constexpr float kLift = 0.05f;

// Which part of the disc in the tangent plane other surfaces hide from its center: what lies beyond them in
// each sector.
float hidden_share(const world::World& world, Vec3f p, Vec3f ng, float radius, Rng& rng) {
  const Frame frame = Frame::from_normal(ng);
  const Vec3f from = world::World::offset_origin(p, ng, ng) + ng * (kLift * radius);
  const float turn = rng.next_float();
  float shown = 0;
  for (int k = 0; k < kSectors; ++k) {
    const float phi = 2 * kPi * (static_cast<float>(k) + turn) / kSectors;
    const auto hit =
        world.rays().intersect({from, frame.s * std::cos(phi) + frame.t * std::sin(phi), 0, radius});
    const float reach = hit ? std::min(hit->t / radius, 1.0f) : 1.0f;
    shown += reach * reach;
  }
  return 1 - shown / kSectors;
}

}  // namespace

float automatic_radius_scale(std::size_t surface_lights) {
  return static_cast<float>(std::max(1.0, std::cbrt(static_cast<double>(surface_lights) / kLightsAtOne)));
}

float sphere_radius(float neighbor_distance_squared, float scale, float extent) {
  // Lights may coincide where particles are few; a sphere without extent would be a point with its spikes.
  return std::clamp(scale * std::sqrt(neighbor_distance_squared), 1e-5f * extent, extent);
}

float make_spherical(VirtualLights& lights, const world::World& world, const SphereSettings& settings,
                     const Sinks& sinks) {
  std::vector<std::size_t> which;
  std::vector<Vec3f> points;
  std::vector<std::uint32_t> paths;
  for (std::size_t j = 0; j < lights.size(); ++j) {
    if (lights.kind[j] != LightKind::surface) continue;
    which.push_back(j), points.push_back(lights.position[j]);
    if (!lights.path.empty()) paths.push_back(lights.path[j]);
  }
  lights.radius.assign(lights.size(), 0);
  lights.hidden.assign(lights.size(), 0);
  const std::vector<Neighbor> found = neighbors(points, paths, kSphereNeighbor);
  const float scale =
      settings.radius_scale > 0 ? settings.radius_scale : automatic_radius_scale(which.size());
  const float max_radius = world.bounds().radius();
  parallel_for(which.size(), 1024, [&](std::size_t begin, std::size_t end) {
    if (sinks.cancelled()) return;
    for (std::size_t k = begin; k < end; ++k) {
      const std::size_t j = which[k];
      lights.radius[j] =
          found[k].count > 0 ? sphere_radius(found[k].distance_squared, scale, max_radius) : max_radius;
      if (lights.ng[j] == Vec3f{}) continue;  // a fiber has no tangent plane
      Rng rng(0, Stage::spheres, matrix::id_of(lights.id, j));
      lights.hidden[j] = hidden_share(world, lights.position[j], lights.ng[j], lights.radius[j], rng);
    }
  });
  if (sinks.cancelled()) throw Cancelled();
  return scale;
}

}  // namespace lumirank::transport
