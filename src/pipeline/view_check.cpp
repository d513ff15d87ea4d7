#include "pipeline/view_check.h"

#include <algorithm>
#include <cstdio>

namespace lumirank::pipeline {

using world::View;

namespace {

constexpr int kGrid = 64;  // rays along each side: milliseconds

std::string shortly(float value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.4g", static_cast<double>(value));
  return text;
}

// Where the scene's box lies along the camera's axis, in the units of the clipping planes.
struct Depths {
  double min = kInfinity, max = -kInfinity;
};
Depths depths(const world::World& world, const View& view) {
  Depths out;
  const auto to_camera = world.units().to_world(view.sensor.to_world).inverse();
  if (!to_camera) return out;
  const Bounds3f& box = world.bounds();
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3f p{corner & 1 ? box.hi.x : box.lo.x, corner & 2 ? box.hi.y : box.lo.y,
                  corner & 4 ? box.hi.z : box.lo.z};
    const double z = to_camera->place(p).z;
    out.min = std::min(out.min, z), out.max = std::max(out.max, z);
  }
  return out;
}

std::string cut_off(const View& view, bool near, bool far) {
  const std::string which = near && far ? "clipping planes"
                            : near      ? "near clipping plane"
                                        : "far clipping plane";
  return "the camera sees nothing: all that would be in its view is cut off by the " + which +
         " (near_clip " + shortly(view.sensor.near_clip) + ", far_clip " + shortly(view.sensor.far_clip) +
         (near && far ? "); widen them"
          : near      ? "); lower near_clip"
                      : "); raise far_clip");
}

}  // namespace

std::string empty_view(const world::World& world, const View& view) {
  const world::Camera camera(view.sensor, world.units());
  scenedesc::SensorDesc open = view.sensor;
  open.near_clip = 0, open.far_clip = kInfinity;
  const world::Camera unclipped(open, world.units());
  int before = 0, beyond = 0;  // rays that meet only what the near, the far plane cuts off
  for (int y = 0; y < kGrid; ++y)
    for (int x = 0; x < kGrid; ++x) {
      const auto along = [](int k, int from, int size) {
        return static_cast<float>(from) + (static_cast<float>(k) + 0.5f) / kGrid * static_cast<float>(size);
      };
      const Vec2f film{along(x, view.crop_x, view.width), along(y, view.crop_y, view.height)};
      if (world.rays().intersect(camera.ray(film, {0.5f, 0.5f}))) return {};
      geometry::Ray ray = unclipped.ray(film, {0.5f, 0.5f});
      const auto hit = world.rays().intersect(ray);
      if (!hit) continue;
      // Behind the near plane the first surface may be followed by others, all of them out of reach.
      ray = camera.ray(film, {0.5f, 0.5f});
      ray.t_max = kInfinity;
      ++(world.rays().intersect(ray) ? beyond : before);
    }
  if (before + beyond > 0) return cut_off(view, before > 0, beyond > 0);
  const Depths all = depths(world, view);
  if (all.min > view.sensor.far_clip) return cut_off(view, false, true);
  if (all.max > 0 && all.max < view.sensor.near_clip) return cut_off(view, true, false);
  if (world.environment() >= 0) return {};
  return "none of " + std::to_string(kGrid * kGrid) +
         " rays spread over the picture meets a surface: it may show nothing; turn the camera towards the "
         "scene";
}

}  // namespace lumirank::pipeline
