#include "world/emitter_media.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <variant>

namespace lumirank::world {
namespace {

using emitters::AreaEmitter;

// From which an emitter near by shines; none of those far away.
struct PlaceOf {
  std::optional<Vec3f> operator()(const AreaEmitter& area) const {
    const auto largest = std::max_element(area.triangles.begin(), area.triangles.end(),
                                          [](const auto& a, const auto& b) { return a.area < b.area; });
    if (largest == area.triangles.end()) return std::nullopt;
    return World::offset_origin(largest->p0 + (largest->e1 + largest->e2) / 3, largest->normal,
                                largest->normal);
  }
  std::optional<Vec3f> operator()(const emitters::DirectionalEmitter&) const { return std::nullopt; }
  std::optional<Vec3f> operator()(const emitters::EnvironmentEmitter&) const { return std::nullopt; }
  template <typename Point>
  std::optional<Vec3f> operator()(const Point& point) const {
    return point.position;
  }
};

constexpr int kFromFarAway = -2;

}  // namespace

EmitterMedia::EmitterMedia(const World& world, Vec3f eye, int eye_medium)
    : world_(world), eye_(eye), eye_medium_(eye_medium) {
  if (world.media().empty()) return;
  const std::size_t placements = world.rays().placements().size();
  std::size_t p = 0;
  while (p < placements && !world.divides_media(static_cast<std::uint32_t>(p))) ++p;
  if (p == placements) return;
  for (const emitters::Emitter& emitter : world.emitters()) {
    const auto* const area = std::get_if<AreaEmitter>(&emitter.kind);
    const auto place = std::visit(PlaceOf{}, emitter.kind);
    if (!place) {
      near_.push_back(kFromFarAway);
    } else if (area && world.divides_media(area->placement)) {
      SurfaceHit shining;
      shining.hit.instance = area->placement, shining.point.ng = area->triangles.front().normal;
      near_.push_back(world.medium_beyond(shining, shining.point.ng, eye_medium));
    } else {
      near_.push_back(around(*place));
    }
  }
}

int EmitterMedia::of(int emitter, const geometry::Ray& ray) const {
  if (near_.empty()) return eye_medium_;
  const int medium = near_[static_cast<std::size_t>(emitter)];
  return medium == kFromFarAway ? look(ray).medium : medium;
}

EmitterMedia::Found EmitterMedia::look(geometry::Ray ray) const {
  constexpr int kMaxSurfaces = 256;
  bool sure = true;
  for (int k = 0; k < kMaxSurfaces; ++k) {
    const auto hit = world_.intersect(ray);
    if (!hit) return {eye_medium_, sure && std::isfinite(ray.t_max)};
    if (world_.divides_media(hit->hit.instance))
      return {world_.medium_beyond(*hit, -ray.direction, eye_medium_), sure};
    if (world_.materials().passage(hit->material) == scatter::MaterialSet::Passage::opaque) sure = false;
    ray.t_max -= hit->hit.t;
    ray.origin = World::offset_origin(hit->point.position, hit->point.ng, ray.direction);
  }
  return {eye_medium_, false};
}

int EmitterMedia::around(Vec3f place) const {
  const float distance = length(eye_ - place);
  Found to_eye{eye_medium_, true};
  if (distance > 0) to_eye = look({place, (eye_ - place) / distance, 0, distance});
  if (to_eye.sure) return to_eye.medium;
  for (int axis = 0; axis < 3; ++axis)
    for (const float sign : {-1.0f, 1.0f}) {
      Vec3f direction{0, 0, 0};
      direction[axis] = sign;
      if (const Found found = look({place, direction}); found.sure) return found.medium;
    }
  return to_eye.medium;
}

}  // namespace lumirank::world
