// The layer "illuminance" against closed forms and the path tracer, and its false colors.
#include <gtest/gtest.h>

#include <cmath>

#include "base/photometry.h"
#include "image/image_io.h"
#include "image/scale_bar.h"
#include "lumirank/lumirank.h"
#include "support/scene_file.h"
#include "support/statistics.h"

namespace lumirank {
namespace {

using test::load_text;
using test::mean_of;
using test::point_camera;
using test::student_quantile;

std::vector<float> lux_of(const Picture& picture) {
  for (const Plane& plane : picture.planes)
    if (plane.name == "illuminance") return plane.rgb;
  throw InputError("no illuminance");
}

RenderSettings lux_settings(const std::string& method) {
  RenderSettings s;
  s.traced.rest = RestOfPaths::skip;
  s.method.name = method;
  s.lights.count = 64;
  s.layers = {"illuminance"};
  return s;
}

std::string lamp(const char* more = "") {
  return std::string("<emitter type=\"ies\"><string name=\"filename\" value=\"") + LUMIRANK_TEST_DATA +
         "/ies/even.ies\"/><transform name=\"to_world\"><lookat origin=\"0,2,0\" target=\"0,0,0\" "
         "up=\"0,0,1\"/></transform>" +
         more + "</emitter>";
}

// 1000 cd at 2 m over a floor: 250 lux below it, and by the cosine and the distance 250 cos³θ at x = 2 tanθ,
// whatever the floor is made of, by every method.
TEST(Illuminance, InverseSquareAndThirdPowerOfTheCosineBelowAnIesLight) {
  for (const char* bsdf : {"<bsdf type=\"diffuse\"><rgb name=\"reflectance\" value=\"0\"/></bsdf>",
                           "<bsdf type=\"conductor\"/>", "<bsdf type=\"roughplastic\"/>"})
    for (const double x : {0.0, 1.0, 3.0}) {
      const std::string at = std::to_string(x);
      const Scene scene =
          load_text(point_camera(at + ",3,1", at + ",0,0", 4, 0.01) +
                    "<shape type=\"rectangle\"><transform name=\"to_world\"><rotate x=\"1\" angle=\"-90\"/>"
                    "<scale value=\"9\"/></transform>" +
                    bsdf + "</shape>" + lamp());
      const double cosine = 2 / std::hypot(2.0, x);
      for (const char* method : {"brute-force", "auto"})
        for (const float lux : lux_of(render(scene, lux_settings(method)).picture))
          EXPECT_NEAR(lux / (250 * std::pow(cosine, 3)), 1, 2e-4) << method << " " << x;  // the pixels' size
    }
}

TEST(Illuminance, ColorsKeepTheLuxAndTheScaleDims) {
  const auto mean_lux = [](const char* more) {
    const Scene scene = load_text(point_camera("0,3,1", "0,0,0", 2, 0.01) +
                                  "<shape type=\"rectangle\"><transform name=\"to_world\"><rotate x=\"1\" "
                                  "angle=\"-90\"/></transform></shape>" +
                                  lamp(more));
    return lux_of(render(scene, lux_settings("brute-force")).picture)[0];
  };
  EXPECT_NEAR(mean_lux("<rgb name=\"color\" value=\"1, 0.5, 0.1\"/>"), 250, 0.05);
  EXPECT_NEAR(mean_lux("<float name=\"scale\" value=\"0.4\"/>"), 100, 0.02);
}

// A radiance of 1 from all directions is an irradiance of π; lumens as the conventions say.
TEST(Illuminance, UnderAnEvenSky) {
  const Scene scene =
      load_text(point_camera("0,1,1", "0,0,0", 4, 1) +
                "<shape type=\"rectangle\"><transform name=\"to_world\"><rotate x=\"1\" "
                "angle=\"-90\"/></transform></shape>"
                "<emitter type=\"constant\"><rgb name=\"radiance\" value=\"0.5\"/></emitter>");
  RenderSettings settings = lux_settings("brute-force");
  settings.lights.count = 20000;
  settings.view.only = LightPart::direct;
  const auto lux = lux_of(render(scene, settings).picture);
  // 20,000 evenly spread directions over the sphere.
  for (const float l : lux) EXPECT_NEAR(l / (3.14159265358979 * 0.5 * kLumensPerUnit), 1, 0.01);
}

// A room of one gray: π · radiance / reflectance is the irradiance, by columns to the rounding, by the path
// tracer in the mean.
TEST(Illuminance, AgreesWithThePathTracerInAGrayRoom) {
  const Scene scene = load_text(
      point_camera("-0.8,0.9,-0.5", "1,0.9,0.3", 8, 30) +
      "<shape type=\"cube\"><boolean name=\"flip_normals\" value=\"true\"/><transform name=\"to_world\">"
      "<translate y=\"1\"/><scale value=\"1.5\"/></transform>"
      "<bsdf type=\"diffuse\"><rgb name=\"reflectance\" value=\"0.5\"/></bsdf></shape>" +
      lamp());
  RenderSettings settings = lux_settings("brute-force");
  settings.lights.count = 4000;
  settings.view.max_depth = 5;
  settings.lights.clamp = 0;
  ReferenceSettings how;
  how.spp = 128;
  how.paths = ReferencePaths::columns;
  constexpr int kSeeds = 24;
  std::vector<double> columns, paths;
  for (std::uint64_t k = 0; k < kSeeds; ++k) {
    settings.seed = 900 + k;
    settings.layers = {"illuminance"};
    const Picture picture = render(scene, settings).picture;
    const auto lux = lux_of(picture);
    const double factor = 3.14159265358979 * kLumensPerUnit / 0.5;
    double sum = 0;
    for (std::size_t p = 0; p < lux.size(); ++p) {
      sum += lux[p];
      EXPECT_NEAR(lux[p], factor * picture.planes[0].rgb[p], 1e-4 * lux[p]);
    }
    columns.push_back(sum / static_cast<double>(lux.size()));
    settings.layers.clear();
    sum = 0;
    const Picture traced = reference(scene, settings, how).picture;
    for (const float x : traced.planes[0].rgb) sum += factor * x;
    paths.push_back(sum / static_cast<double>(lux.size()));
  }
  const auto a = mean_of(columns), b = mean_of(paths);
  const double allowed =
      student_quantile(1e-4, 1, kSeeds - 1) * std::hypot(a.standard_error, b.standard_error);
  EXPECT_NEAR(a.mean, b.mean, allowed);
  EXPECT_LT(allowed, 0.02 * b.mean) << "the test has lost its teeth";
}

TEST(Illuminance, RoundRangesAndTheirColors) {
  image::Image values(1000, 10);
  for (std::size_t k = 0; k < values.pixels.size(); ++k)
    values.pixels[k] = Rgb(270.0f * static_cast<float>(k % 1000) / 1000);
  EXPECT_EQ(image::round_range(values).low, 0);
  EXPECT_FLOAT_EQ(image::round_range(values).high, 300);
  for (std::size_t k = 0; k < 40; ++k) values.pixels[k] = Rgb(1e6f);  // one in 250 is brighter
  EXPECT_FLOAT_EQ(image::round_range(values).high, 300);
  EXPECT_EQ(image::round_range(image::Image(4, 4)).high, 1);
  const image::Image shown = image::with_scale(values, {0, 300}, "lux");
  EXPECT_EQ(shown.width, 1000);
  EXPECT_GT(shown.height, 10);
  // The bar below the picture has the colors of the picture: 150 lux in its middle.
  int same = 0;
  for (int y = 10; y < shown.height; ++y)
    same +=
        max_component(shown.at(500, y) -
                      image::with_scale(image::Image(1, 1, Rgb(150.15f)), {0, 300}, "lux").at(0, 0)) < 1e-3f;
  EXPECT_GT(same, 5);
}

}  // namespace
}  // namespace lumirank
