// Cameras: from a film position to a ray.
#pragma once

#include <optional>

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
  Vec3f eye() const { return sensor_.to_world.point({0, 0, 0}); }  // the middle of the lens

  // Where a point is seen through a place on the lens: the ray() of `film` and `lens` meets it. Empty if it
  // is behind the camera or not between its clipping planes; the film may be missed.
  struct Seen {
    Vec2f film;
    Vec3f to_eye;        // unit, from the point
    float distance = 0;  // to the ray's origin
    float density = 0;   // pixels per area across the ray, at the point
  };
  std::optional<Seen> project(Vec3f point, Vec2f lens) const;
  // The same density at a distance along one of its rays.
  float density(const geometry::Ray& ray, float distance) const;

 private:
  bool orthographic() const { return sensor_.kind == scenedesc::SensorKind::orthographic; }
  Vec3f lens_point(Vec2f lens) const;  // local

  scenedesc::SensorDesc sensor_;
  Transform to_camera_;
  int width_, height_;
  double tan_x_ = 0, tan_y_ = 0;
  double pixels_per_area_ = 0;  // of the local film: on the plane z = 1, or of an orthographic camera z = 0
  double scale_ = 1;            // of volumes, or of an orthographic film's area, by the transform
};

}  // namespace lumirank::world
