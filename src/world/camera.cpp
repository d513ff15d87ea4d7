// Film coordinates grow to the right and down, while the camera's local +x points left and +y up (Mitsuba's
// convention), so both are mirrored here: the left edge of the film looks towards +x.
#include "world/camera.h"

#include <cmath>

#include "base/error.h"
#include "base/warp.h"

namespace lumirank::world {

namespace {

void check(const scenedesc::SensorDesc& s) {
  const auto bad = [&](const std::string& message, const std::string& remedy) {
    throw InputError(s.where, message, remedy);
  };
  const auto& film = s.film;
  if (film.width < 1 || film.height < 1)
    bad("the film is " + std::to_string(film.width) + " × " + std::to_string(film.height) + " pixels",
        "width and height must be at least 1");
  if (static_cast<long long>(film.width) * film.height > (1ll << 28))
    bad("the film has more than 268 million pixels",
        "render a smaller one, or parts of it with a crop window");
  if (film.crop_width < 0 || film.crop_height < 0 || film.crop_x < 0 || film.crop_y < 0 ||
      static_cast<long long>(film.crop_x) + film.crop_width > film.width ||
      static_cast<long long>(film.crop_y) + film.crop_height > film.height)
    bad("the crop window does not lie within the film", "give a window inside the film");
  if (!s.to_world.is_finite() || !s.to_world.inverse())
    bad("the camera's to_world is singular or not finite", "give an invertible transform");
  if (!(s.near_clip >= 0 && s.near_clip < s.far_clip))
    bad("the near clipping plane is negative or not before the far one", "give 0 ≤ near_clip < far_clip");
  if (!std::isfinite(s.principal_point_offset.x) || !std::isfinite(s.principal_point_offset.y))
    bad("the principal point offset is not finite", "give finite numbers");
  if (s.kind != scenedesc::SensorKind::orthographic && !(s.fov_x > 0 && s.fov_x < 180))
    bad("the field of view is not between 0 and 180 degrees", "give an angle in between");
  if (s.kind == scenedesc::SensorKind::thinlens && !(s.aperture_radius >= 0))
    bad("the aperture radius is negative", "give 0 or more");
  if (s.kind == scenedesc::SensorKind::thinlens && !(s.focus_distance > 0))
    bad("the focus distance is not positive", "give a positive distance");
}
}  // namespace

Camera::Camera(const scenedesc::SensorDesc& sensor, const Units& units)
    : sensor_(sensor), width_(sensor.film.width), height_(sensor.film.height) {
  check(sensor);
  // Clipping planes, lens and focus are lengths along the local axes, which the transform scales.
  sensor_.to_world = units.to_world(sensor.to_world);
  const double aspect = static_cast<double>(width_) / height_;
  tan_x_ =
      sensor.kind == scenedesc::SensorKind::orthographic ? 1.0 : std::tan(0.5 * sensor.fov_x * kPiD / 180.0);
  tan_y_ = tan_x_ / aspect;
  to_camera_ = *sensor_.to_world.inverse();
  pixels_per_area_ = static_cast<double>(width_) * height_ / (4 * tan_x_ * tan_y_);
  const Vec3f x = sensor_.to_world.vector({1, 0, 0}), y = sensor_.to_world.vector({0, 1, 0});
  scale_ =
      orthographic()
          ? static_cast<double>(std::abs(dot(cross(x, y), normalize(sensor_.to_world.vector({0, 0, 1})))))
          : std::abs(sensor_.to_world.determinant3());
}

Vec3f Camera::lens_point(Vec2f lens) const {
  if (sensor_.kind != scenedesc::SensorKind::thinlens || !(sensor_.aperture_radius > 0)) return {0, 0, 0};
  const Vec2f disc = warp_disk(lens) * sensor_.aperture_radius;
  return {disc.x, disc.y, 0};
}

geometry::Ray Camera::ray(Vec2f film, Vec2f lens) const {
  // From -1 at the left and lower edges to +1 at the right and upper ones. The offset is added to the film
  // position, as in Mitsuba 3: a positive offset moves what lies on the axis to the left and up.
  const double right = 2.0 * (film.x / static_cast<double>(width_) + sensor_.principal_point_offset.x) - 1.0;
  const double up = 1.0 - 2.0 * (film.y / static_cast<double>(height_) + sensor_.principal_point_offset.y);
  const double x = -right * tan_x_, y = up * tan_y_;
  geometry::Ray ray;
  if (orthographic()) {
    ray.origin = sensor_.to_world.point({static_cast<float>(x), static_cast<float>(y), 0});
    ray.direction = normalize(sensor_.to_world.vector({0, 0, 1}));
    // The clipping planes are measured along the local axis; a scaled transform stretches them.
    const float stretch = length(sensor_.to_world.vector({0, 0, 1}));
    ray.origin += ray.direction * (sensor_.near_clip * stretch);
    ray.t_max = (sensor_.far_clip - sensor_.near_clip) * stretch;
    return ray;
  }
  const Vec3f from = lens_point(lens);
  Vec3f towards{static_cast<float>(x), static_cast<float>(y), 1};  // on the plane z = 1
  if (sensor_.kind == scenedesc::SensorKind::thinlens && sensor_.aperture_radius > 0) {
    towards = towards * sensor_.focus_distance - from;
    towards = towards / towards.z;
  }
  ray.origin = sensor_.to_world.point(from);
  const Vec3f direction = sensor_.to_world.vector(towards);
  const float stretch = length(direction);  // of one unit along the local axis
  ray.direction = direction / stretch;
  ray.t_min = sensor_.near_clip * stretch;
  ray.t_max = sensor_.far_clip * stretch;
  return ray;
}

std::optional<Camera::Seen> Camera::project(Vec3f point, Vec2f lens) const {
  const Vec3f local = to_camera_.point(point);
  if (!(local.z > sensor_.near_clip && local.z < sensor_.far_clip)) return std::nullopt;
  Seen seen;
  double x = local.x, y = local.y;
  Vec3f origin;
  if (orthographic()) {
    origin = point - normalize(sensor_.to_world.vector({0, 0, 1})) *
                         ((local.z - sensor_.near_clip) * length(sensor_.to_world.vector({0, 0, 1})));
  } else {
    const Vec3f from = lens_point(lens);
    // In the focus all places on the lens see a point at the same place.
    const double focus = sensor_.kind == scenedesc::SensorKind::thinlens && sensor_.aperture_radius > 0
                             ? static_cast<double>(sensor_.focus_distance)
                             : 1.0;
    const double z = local.z;
    x = from.x / focus + (x - from.x) / z;
    y = from.y / focus + (y - from.y) / z;
    origin = sensor_.to_world.point(from);
  }
  seen.film = {static_cast<float>((0.5 * (1 - x / tan_x_) - sensor_.principal_point_offset.x) * width_),
               static_cast<float>((0.5 * (1 - y / tan_y_) - sensor_.principal_point_offset.y) * height_)};
  seen.distance = length(origin - point);
  if (!(seen.distance > 0)) return std::nullopt;
  seen.to_eye = (origin - point) / seen.distance;
  seen.density = density({origin, -seen.to_eye}, seen.distance);
  return seen;
}

float Camera::density(const geometry::Ray& ray, float distance) const {
  if (orthographic()) return static_cast<float>(pixels_per_area_ / scale_);
  const double along = to_camera_.vector(ray.direction).z;
  return static_cast<float>(pixels_per_area_ /
                            (along * along * along * scale_ * static_cast<double>(distance) * distance));
}

}  // namespace lumirank::world
