// A film of other proportions keeps the field of view that the format states.
#include "scenedesc/schema/film_size.h"

#include <gtest/gtest.h>

#include <cmath>

#include "gltf_maker.h"
#include "pbrt_scene.h"

namespace lumirank::scenedesc {
namespace {

double half_width(const SensorDesc& s) { return std::tan(s.fov_x * M_PI / 360); }
double half_height(const SensorDesc& s) { return half_width(s) * s.film.height / s.film.width; }

TEST(FilmSize, KeepsTheStatedAxis) {
  // From 400 × 200, tan 0.8 × 0.4, to other proportions; all numbers by hand.
  const struct {
    FieldAxis axis;
    int width, height;
    double half_width;
  } cases[] = {{FieldAxis::x, 100, 100, 0.8},
               {FieldAxis::y, 100, 100, 0.4},
               {FieldAxis::smaller, 100, 300, 0.4},
               {FieldAxis::smaller, 300, 100, 1.2},
               {FieldAxis::larger, 100, 200, 0.4},
               {FieldAxis::larger, 300, 100, 0.8},
               {FieldAxis::diagonal, 30, 40, 0.6 * std::hypot(0.8, 0.4)},
               {FieldAxis::all, 100, 100, 0.8},
               {FieldAxis::all, 400, 100, 1.6},
               {FieldAxis::y, 800, 400, 0.8}};
  for (const auto& c : cases) {
    SensorDesc s;
    s.film.width = 400, s.film.height = 200;
    s.fov_x = static_cast<float>(2 * std::atan(0.8) * 180 / M_PI);
    s.kept_axis = c.axis;
    SensorDesc flat = s;
    set_film_size(s, c.width, c.height);
    EXPECT_NEAR(half_width(s), c.half_width, 1e-6) << static_cast<int>(c.axis) << ", " << c.width;
    flat.kind = SensorKind::orthographic;
    set_film_size(flat, c.width, c.height);
    EXPECT_NEAR(flat.to_world.vector({1, 0, 0}).x, c.half_width / 0.8, 1e-6);
  }
}

TEST(FilmSize, EachFormatHasItsAxis) {
  SensorDesc pbrt =
      pbrt_world("",
                 "Camera \"perspective\" \"float fov\" 90 Film \"rgb\" \"integer xresolution\" 200 "
                 "\"integer yresolution\" 100")
          .sensors.at(0);
  set_film_size(pbrt, 100, 300);
  EXPECT_NEAR(half_width(pbrt), 1, 1e-6);  // the shorter side
  GltfMaker m = square();
  SensorDesc framed = parse(m).sensors.at(0);
  const double width = half_width(framed), height = half_height(framed);
  set_film_size(framed, 1600, 100);
  EXPECT_NEAR(half_height(framed), height, 1e-6);
  set_film_size(framed, 100, 1600);
  EXPECT_GE(half_width(framed), width);
  EXPECT_GE(half_height(framed), height);
  m.root["cameras"] = {
      {{"type", "perspective"}, {"perspective", {{"yfov", 1.0}, {"aspectRatio", 2}, {"znear", 0.1}}}}};
  m.root["nodes"][0]["camera"] = 0;
  SensorDesc gltf = parse(m).sensors.at(0);
  set_film_size(gltf, 100, 100);
  EXPECT_NEAR(half_height(gltf), std::tan(0.5), 1e-6);
}

}  // namespace
}  // namespace lumirank::scenedesc
