// Cameras: from a film position to a ray.
#pragma once

#include "base/transform.h"
#include "base/vec.h"
#include "geometry/ray_scene.h"
#include "scenedesc/schema/scene_desc.h"
#include "world/units.h"

namespace lumirank::world {

class Camera {
 public:
  // Rays are in the world's units.
  explicit Camera(const scenedesc::SensorDesc& sensor, const Units& units = {});

  int width() const { return width_; }
  int height() const { return height_; }
  // `film` in pixels, (0,0) the upper left corner of the full (uncropped) film; `lens` in the unit square.
  geometry::Ray ray(Vec2f film, Vec2f lens) const;

 private:
  scenedesc::SensorDesc sensor_;
  int width_, height_;
  double tan_x_ = 0, tan_y_ = 0;
};

}  // namespace lumirank::world
