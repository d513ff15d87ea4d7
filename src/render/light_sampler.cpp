#include "render/light_sampler.h"

#include "base/rgb.h"

namespace lumirank::rendering {

LightSampler::LightSampler(const world::World& world) : world_(world) {
  const auto& emitters = world.emitters();
  std::vector<float> weights;
  triangle_of_.resize(emitters.size());
  for (std::size_t e = 0; e < emitters.size(); ++e) {
    weights.push_back(std::max(0.0f, mean(emitters::power(emitters[e], world.bounds().radius()))));
    if (const auto* area = std::get_if<emitters::AreaEmitter>(&emitters[e].kind)) {
      auto& map = triangle_of_[e];
      for (std::size_t k = 0; k < area->triangles.size(); ++k) {
        const std::size_t t = area->triangles[k].mesh_triangle;
        if (t >= map.size()) map.resize(t + 1, -1);
        map[t] = static_cast<std::int32_t>(k);
      }
    }
  }
  by_power_ = Distribution1D(weights);
}

LightSampler::Sample LightSampler::sample(Vec3f point, float u_emitter, float u1, Vec2f u2) const {
  if (empty()) return {};
  const auto pick = by_power_.sample(u_emitter);
  Sample s;
  s.emitter = static_cast<int>(pick.index);
  s.direct = world_.sample_direct(s.emitter, point, u1, u2);
  s.pdf = s.direct.pdf * pick.pmf;
  return s;
}

float LightSampler::pdf_hit(const world::SurfaceHit& hit, Vec3f direction, float distance) const {
  if (hit.emitter < 0) return 0;
  const auto e = static_cast<std::size_t>(hit.emitter);
  const auto* area = std::get_if<emitters::AreaEmitter>(&world_.emitters()[e].kind);
  if (!area || hit.hit.triangle >= triangle_of_[e].size()) return 0;
  const std::int32_t k = triangle_of_[e][hit.hit.triangle];
  if (k < 0) return 0;
  return by_power_.pmf(e) *
         emitters::pdf_direct_area(*area, area->triangles[static_cast<std::size_t>(k)], direction, distance);
}

float LightSampler::pdf_background(Vec3f direction) const {
  const int e = world_.environment();
  if (e < 0) return 0;
  const auto& environment =
      std::get<emitters::EnvironmentEmitter>(world_.emitters()[static_cast<std::size_t>(e)].kind);
  return by_power_.pmf(static_cast<std::size_t>(e)) * environment.pdf(direction);
}

Rgb visible_fraction(const world::World& world, Vec3f from, Vec3f ng, Vec3f direction, float distance,
                     std::uint64_t key) {
  const Vec3f origin = world::World::offset_origin(from, ng, direction);
  geometry::Ray ray{origin, direction, 0, kInfinity};
  if (std::isfinite(distance)) {
    // Aimed anew from the moved origin, which may be farther off the surface than the open end is long; the
    // lamp itself must not block.
    ray.direction = from + direction * distance - origin;
    ray.t_max = 1 - 1e-4f;
  }
  if (world.rays().occluded(ray, key)) return Rgb{0};
  return world.rays().has_smooth() ? world.rays().transmittance(ray) : Rgb{1};
}

}  // namespace lumirank::rendering
