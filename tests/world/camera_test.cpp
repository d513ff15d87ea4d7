#include "world/camera.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/error.h"

namespace lumirank::world {
namespace {

scenedesc::SensorDesc sensor(int width, int height, float fov) {
  scenedesc::SensorDesc s;
  s.film.width = width, s.film.height = height;
  s.fov_x = fov;
  return s;
}

double degrees_between(Vec3f a, Vec3f b) {
  return std::atan2(length(cross(a, b)), dot(a, b)) * 180 / 3.14159265358979;
}

TEST(Camera, TheImageIsNotMirrored) {
  // Looking from +z at the origin with +y up: the world's +x is on the right of the picture, +y at the top.
  auto s = sensor(200, 100, 60);
  s.to_world = Transform::look_at({0, 0, 5}, {0, 0, 0}, {0, 1, 0});
  const Camera camera(s);
  EXPECT_GT(camera.ray({150, 50}, {}).direction.x, 0);
  EXPECT_LT(camera.ray({50, 50}, {}).direction.x, 0);
  EXPECT_GT(camera.ray({100, 10}, {}).direction.y, 0);
  EXPECT_LT(camera.ray({100, 90}, {}).direction.y, 0);
  // A point projected by hand: (1, 0.5, 0) is 5 in front, 1 to the right and 0.5 up; the half width sees
  // 5·tan 30°.
  const double half = 5 * std::tan(30 * 3.14159265358979 / 180);
  const Vec2f film{static_cast<float>(100 + 100 * 1 / half), static_cast<float>(50 - 100 * 0.5 / half)};
  const geometry::Ray r = camera.ray(film, {});
  EXPECT_LT(degrees_between(r.direction, Vec3f{1, 0.5f, 0} - Vec3f{0, 0, 5}), 1e-4);
  EXPECT_EQ(r.origin, (Vec3f{0, 0, 5}));
}

TEST(Camera, TheWidthSpansTheFieldOfView) {
  for (const float fov : {20.0f, 60.0f, 120.0f}) {
    const Camera camera(sensor(300, 200, fov));
    EXPECT_NEAR(degrees_between(camera.ray({0, 100}, {}).direction, camera.ray({300, 100}, {}).direction),
                fov, 1e-3);
    // tan of the half height = tan of the half width × height/width.
    const double vertical =
        2 * std::atan(std::tan(fov * 3.14159265358979 / 360) * 200 / 300) * 180 / 3.14159265358979;
    EXPECT_NEAR(degrees_between(camera.ray({150, 0}, {}).direction, camera.ray({150, 200}, {}).direction),
                vertical, 1e-3);
    // A corner: the tangents add in squares.
    const double tan_x = std::tan(fov * 3.14159265358979 / 360);
    const double corner = std::atan(tan_x * std::hypot(1.0, 2.0 / 3)) * 180 / 3.14159265358979;
    EXPECT_NEAR(degrees_between(camera.ray({0, 0}, {}).direction, {0, 0, 1}), corner, 1e-3);
    // Without a transform +x points left.
    EXPECT_GT(camera.ray({0, 100}, {}).direction.x, 0);
  }
}

TEST(Camera, ClippingPlanesAreMeasuredAlongTheAxis) {
  auto s = sensor(100, 100, 90);
  s.near_clip = 2, s.far_clip = 10;
  const geometry::Ray r = Camera(s).ray({0, 50}, {});  // 45° off the axis
  EXPECT_NEAR(r.t_min, 2 * std::sqrt(2.0), 1e-5);
  EXPECT_NEAR(r.t_max, 10 * std::sqrt(2.0), 1e-4);
}

TEST(Camera, PrincipalPointOffsetIsAddedToTheFilmPosition) {
  auto s = sensor(100, 50, 90);
  s.principal_point_offset = {0.1f, -0.2f};
  const Camera shifted(s);
  const Camera plain(sensor(100, 50, 90));
  const Vec3f a = shifted.ray({40, 20}, {}).direction, b = plain.ray({40 + 10, 20 - 10}, {}).direction;
  EXPECT_LT(length(a - b), 1e-6f);
}

TEST(Camera, ThinLensRaysMeetInThePlaneOfFocus) {
  auto s = sensor(100, 100, 60);
  s.kind = scenedesc::SensorKind::thinlens;
  s.aperture_radius = 0.3f, s.focus_distance = 4;
  s.to_world = Transform::look_at({1, 2, 3}, {0, 0, 0}, {0, 1, 0});
  const Camera camera(s);
  auto pinhole = s;
  pinhole.kind = scenedesc::SensorKind::perspective;
  const Camera sharp(pinhole);
  const Vec3f axis = normalize(Vec3f{-1, -2, -3});
  for (const Vec2f film : {Vec2f{50, 50}, Vec2f{10, 80}}) {
    const geometry::Ray p = sharp.ray(film, {});
    const Vec3f focus = p.origin + p.direction * (4 / dot(p.direction, axis));
    double widest = 0;
    for (const Vec2f lens : {Vec2f{0, 0.5f}, Vec2f{1, 0.5f}, Vec2f{0.5f, 0.1f}, Vec2f{0.7f, 0.7f}}) {
      const geometry::Ray r = camera.ray(film, lens);
      const Vec3f at = r.origin + r.direction * (4 / dot(r.direction, axis));
      EXPECT_LT(length(at - focus), 1e-5f);
      const Vec3f off = r.origin - Vec3f{1, 2, 3};
      EXPECT_NEAR(dot(off, axis), 0, 1e-6);
      widest = std::max(widest, static_cast<double>(length(off)));
    }
    EXPECT_NEAR(widest, 0.3, 1e-5);  // (0, ½) and (1, ½) lie on the rim
  }
}

TEST(Camera, OrthographicFilmSpansTheTransform) {
  auto s = sensor(200, 100, 90);
  s.kind = scenedesc::SensorKind::orthographic;
  s.to_world = Transform::look_at({0, 0, 5}, {0, 0, 0}, {0, 1, 0}) * Transform::scale(3, 3, 1);
  s.near_clip = 0.5f, s.far_clip = 20;
  const Camera camera(s);
  const geometry::Ray left = camera.ray({0, 50}, {}), right = camera.ray({200, 50}, {}),
                      top = camera.ray({100, 0}, {});
  EXPECT_NEAR(left.origin.x, -3, 1e-5);
  EXPECT_NEAR(right.origin.x, 3, 1e-5);
  EXPECT_NEAR(top.origin.y, 1.5, 1e-5);  // half as high as wide
  EXPECT_NEAR(top.origin.z, 4.5, 1e-5);  // starts at the near plane
  EXPECT_NEAR(top.t_max, 19.5, 1e-5);
  EXPECT_EQ(left.direction, right.direction);
  EXPECT_NEAR(left.direction.z, -1, 1e-6);
}

TEST(Camera, RefusesNonsense) {
  const auto refused = [](auto&& change) {
    auto s = sensor(100, 100, 60);
    change(s);
    EXPECT_THROW(Camera{s}, InputError);
  };
  refused([](auto& s) { s.film.width = 0; });
  refused([](auto& s) { s.film.height = -5; });
  refused([](auto& s) { s.film.width = s.film.height = 1 << 20; });
  refused([](auto& s) { s.fov_x = 0; });
  refused([](auto& s) { s.fov_x = 180; });
  refused([](auto& s) { s.fov_x = std::nanf(""); });
  refused([](auto& s) { s.to_world = Transform::scale(1, 0, 1); });
  refused([](auto& s) { s.film.crop_x = 90, s.film.crop_width = 20, s.film.crop_height = 10; });
  refused([](auto& s) { s.kind = scenedesc::SensorKind::thinlens, s.aperture_radius = -1; });
  refused([](auto& s) { s.kind = scenedesc::SensorKind::thinlens, s.focus_distance = 0; });
  refused([](auto& s) { s.near_clip = 10, s.far_clip = 5; });
}

// project() undoes ray(), and its density is that of the pixels' corners: how much area across the ray a
// small square on the film takes at the point.
TEST(Camera, ProjectionUndoesRays) {
  auto perspective = sensor(300, 200, 70);
  perspective.to_world =
      Transform::look_at({1, 2, 5}, {0, 0.5, 0}, {0, 1, 0}) * Transform::scale(2, 0.5, 1.5);
  perspective.principal_point_offset = {0.1f, -0.2f};
  auto lens = perspective;
  lens.kind = scenedesc::SensorKind::thinlens, lens.aperture_radius = 0.2f, lens.focus_distance = 3;
  auto flat = perspective;
  flat.kind = scenedesc::SensorKind::orthographic;
  for (const auto& s : {perspective, lens, flat}) {
    const Camera camera(s);
    for (const Vec2f film : {Vec2f{150, 100}, Vec2f{10, 20}, Vec2f{290.5f, 133}})
      for (const Vec2f u : {Vec2f{0.2f, 0.7f}, Vec2f{0.9f, 0.4f}})
        for (const float t : {1.5f, 7.0f}) {
          const geometry::Ray ray = camera.ray(film, u);
          const auto seen = camera.project(ray.origin + ray.direction * t, u);
          ASSERT_TRUE(seen);
          EXPECT_NEAR(seen->film.x, film.x, 1e-2);
          EXPECT_NEAR(seen->film.y, film.y, 1e-2);
          EXPECT_NEAR(length(seen->to_eye + ray.direction), 0, 1e-5);
          EXPECT_NEAR(seen->distance, t, 1e-4 * t);
          const auto across = [&](Vec2f at) {  // where its ray crosses the plane through the point
            const geometry::Ray r = camera.ray(at, u);
            const Vec3f point = ray.origin + ray.direction * t;
            return r.origin +
                   r.direction * (dot(point - r.origin, ray.direction) / dot(r.direction, ray.direction));
          };
          const Vec3f x = across(film + Vec2f{1, 0}) - across(film - Vec2f{1, 0});
          const Vec3f y = across(film + Vec2f{0, 1}) - across(film - Vec2f{0, 1});
          const float area = length(cross(x, y)) / 4;
          EXPECT_NEAR(seen->density * area, 1, 3e-3);
          EXPECT_NEAR(camera.density(ray, t) / seen->density, 1, 1e-3);
        }
  }
}

TEST(Camera, WhatIsNotBetweenTheClippingPlanesIsNotSeen) {
  auto s = sensor(100, 100, 60);
  s.near_clip = 1, s.far_clip = 4;
  const Camera camera(s);
  EXPECT_TRUE(camera.project({0.3f, 0.2f, 2}, {}));
  EXPECT_FALSE(camera.project({0.3f, 0.2f, 0.9f}, {}));
  EXPECT_FALSE(camera.project({0.3f, 0.2f, 4.1f}, {}));
  EXPECT_FALSE(camera.project({0.3f, 0.2f, -2}, {}));
}

}  // namespace
}  // namespace lumirank::world
