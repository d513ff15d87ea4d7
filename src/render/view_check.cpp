#include "render/view_check.h"

#include <cstdio>

namespace lumirank::rendering {
namespace {

constexpr int kGrid = 64;  // rays along each side: milliseconds

std::string shortly(float value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.4g", static_cast<double>(value));
  return text;
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
  const std::string planes =
      "(near_clip " + shortly(view.sensor.near_clip) + ", far_clip " + shortly(view.sensor.far_clip) + ")";
  if (before + beyond > 0) {
    const char* which = beyond == 0   ? "the near clipping plane"
                        : before == 0 ? "the far clipping plane"
                                      : "the clipping planes";
    return std::string("the camera sees nothing: all that is in its view is cut off by ") + which + " " +
           planes +
           (beyond == 0   ? "; lower near_clip"
            : before == 0 ? "; raise far_clip"
                          : "; widen them");
  }
  if (world.environment() >= 0) return {};
  return "none of " + std::to_string(kGrid * kGrid) +
         " rays spread over the picture meets a surface: it may show nothing; turn the camera towards the "
         "scene";
}

}  // namespace lumirank::rendering
