#include "world/colored_glass.h"

#include <algorithm>
#include <cmath>

#include "base/random.h"
#include "base/warp.h"
#include "world/world.h"

namespace lumirank::world {

namespace {

namespace sd = scenedesc;

constexpr int kRaysOfShape = 64;
// Glass that stands in a table by a hair meets the table.
constexpr double kMeetsOthers = 0.25, kMeetsNothing = 0.02;

bool only_absorbs(const sd::MediumDesc& medium) {
  if (!medium.homogeneous() || !is_black(medium.emission.value)) return false;
  return medium.form == sd::MediumDesc::Form::absorption_and_scattering
             ? is_black(medium.scattering.value)
             : is_black(medium.albedo.value) || is_black(medium.extinction.value);
}

// What leaves a vertex on rough glass, or on glass that is matt in part, begins within it, and is not asked.
bool is_smooth_glass(const sd::SceneDesc& desc, const sd::ShapeDesc& shape) {
  if (!shape.media.divides) return true;
  if (shape.bsdf == sd::kNone) return false;
  const auto* glass = std::get_if<sd::DielectricDesc>(&desc.bsdfs[static_cast<std::size_t>(shape.bsdf)].kind);
  const auto smooth = [](const sd::FloatInput& alpha) {
    return alpha.texture == sd::kNone && alpha.value == 0;
  };
  return glass && smooth(glass->alpha_u) && smooth(glass->alpha_v);
}

}  // namespace

bool may_color_glass(const sd::SceneDesc& desc) {
  return !desc.media.empty() && std::all_of(desc.media.begin(), desc.media.end(), only_absorbs) &&
         std::all_of(desc.shapes.begin(), desc.shapes.end(),
                     [&](const sd::ShapeDesc& shape) { return is_smooth_glass(desc, shape); }) &&
         std::all_of(desc.sensors.begin(), desc.sensors.end(),
                     [](const sd::SensorDesc& sensor) { return sensor.medium == sd::kNone; });
}

std::vector<Rgb> absorption_of_glass(const sd::SceneDesc& desc) {
  std::vector<Rgb> absorption;
  for (const sd::MediumDesc& medium : desc.media)
    absorption.push_back(medium.form == sd::MediumDesc::Form::absorption_and_scattering
                             ? medium.absorption.value
                             : medium.extinction.value);
  return absorption;
}

bool colors_glass(const World& world) {
  const geometry::RayScene& rays = world.rays();
  const auto divides = [&](const SurfaceHit& hit) { return world.divides_media(hit.hit.instance); };
  for (std::uint32_t i = 0; i < rays.placements().size(); ++i) {
    if (!world.divides_media(i)) continue;
    const geometry::Placement& placement = rays.placements()[i];
    if (world.materials().passage(static_cast<int>(placement.material)) !=
        scatter::MaterialSet::Passage::opaque)
      return false;
    const std::size_t triangles = rays.mesh(placement.mesh).triangle_count();
    if (triangles == 0) continue;
    Rng random(1, Stage::method, i);
    int inward = 0, others = 0, nothing = 0;
    for (int k = 0; k < kRaysOfShape; ++k) {
      geometry::Hit start;
      start.instance = i, start.mesh = placement.mesh;
      start.triangle = static_cast<std::uint32_t>(std::min(
          triangles - 1, static_cast<std::size_t>(random.next_double() * static_cast<double>(triangles))));
      const Vec2f u = random.next_2d();
      const float root = std::sqrt(u.x);
      start.barycentric = {1 - root, u.y * root};
      const SurfaceHit at = world.surface(start, {0, 0, 1});
      const Vec3f direction =
          Frame::from_normal(-at.point.ng).to_world(warp_cosine_hemisphere(random.next_2d()));
      if (world.medium_beyond(at, direction, -1) < 0) continue;
      ++inward;
      const auto hit =
          world.intersect({World::offset_origin(at.point.position, at.point.ng, direction), direction});
      if (!hit)
        ++nothing;
      else if (!divides(*hit))
        ++others;
    }
    if (others > kMeetsOthers * inward || nothing > kMeetsNothing * inward) return false;
  }
  return true;
}

}  // namespace lumirank::world
