// Fur in the matrix against fur in the path tracer.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <fstream>
#include <string>

#include "base/random.h"
#include "lumirank/lumirank.h"
#include "support/scene_file.h"
#include "support/statistics.h"

namespace lumirank {
namespace {

using test::mean_of;
using test::student_quantile;

constexpr double kAlpha = 1e-3;  // false alarms of each test

// 400 leaning hairs of length 0.3 on a black floor around the origin, and a white wall 1.5 away.
std::string fur_and_wall(const test::TemporaryFolder& folder) {
  const std::string file = folder / "fur.txt";
  std::ofstream out(file);
  Rng rng(1, Stage::test);
  for (int k = 0; k < 400; ++k) {
    const float x = 0.6f * (rng.next_float() - 0.5f), z = 0.6f * (rng.next_float() - 0.5f);
    const float a = 0.2f * (rng.next_float() - 0.5f), b = 0.2f * (rng.next_float() - 0.5f);
    for (int i = 0; i < 5; ++i) {
      const float t = static_cast<float>(i) / 4;
      out << x + a * t * t << ' ' << 0.4f * t - 0.05f << ' ' << z + b * t * t << ' '
          << 0.007f * (1 - 0.5f * t) << '\n';
    }
    out << '\n';
  }
  return "<shape type=\"bsplinecurve\"><string name=\"filename\" value=\"" + file +
         "\"/><bsdf type=\"kajiyakay\"><rgb name=\"diffuse_reflectance\" value=\"0.5,0.4,0.3\"/><rgb "
         "name=\"specular_reflectance\" value=\"0.3\"/><float name=\"exponent\" value=\"15\"/></bsdf></shape>"
         "<shape type=\"rectangle\"><transform name=\"to_world\"><scale value=\"3\"/><rotate x=\"1\" "
         "angle=\"-90\"/></transform><bsdf type=\"diffuse\"><rgb name=\"reflectance\" "
         "value=\"0\"/></bsdf></shape>"
         "<shape type=\"rectangle\"><transform name=\"to_world\"><rotate y=\"1\" angle=\"90\"/><translate "
         "x=\"-1.5\" "
         "y=\"0.8\"/></transform><bsdf type=\"diffuse\"><rgb name=\"reflectance\" "
         "value=\"0.8\"/></bsdf></shape>";
}
std::string spot(const char* origin, const char* target) {
  return std::string("<emitter type=\"spot\"><transform name=\"to_world\"><lookat origin=\"") + origin +
         "\" target=\"" + target +
         "\" up=\"0,0,1\"/></transform><rgb name=\"intensity\" value=\"9\"/><float name=\"cutoff_angle\" "
         "value=\"8\"/></emitter>";
}

std::array<double, 3> mean_colour(const Picture& picture) {
  std::array<double, 3> sum{};
  const auto& rgb = picture.planes[0].rgb;
  for (std::size_t k = 0; k < rgb.size(); ++k) sum[k % 3] += rgb[k];
  for (double& s : sum) s /= static_cast<double>(rgb.size() / 3);
  return sum;
}

// Brute force over unclamped columns and the path tracer over the same paths, of at most one bounce: lights
// and receivers are far apart, which keeps the variance of 1/d² finite.
void expect_equal_means(const std::string& body, const char* only) {
  const test::TemporaryFolder folder;
  const Scene scene = test::load_text(fur_and_wall(folder) + body);
  RenderSettings settings;
  settings.only = only;
  settings.max_depth = 3;
  settings.method = "brute-force";
  settings.clamp = 0;
  settings.direct = "matrix";
  settings.lights = 3000;
  ReferenceSettings how;
  how.paths = "columns";
  how.spp = 128;
  constexpr int kSeeds = 32;
  std::vector<double> lights[3], paths[3];
  for (int k = 0; k < kSeeds; ++k) {
    settings.seed = 300 + static_cast<std::uint64_t>(k);
    const auto a = mean_colour(render(scene, settings).picture);
    const auto b = mean_colour(reference(scene, settings, how).picture);
    for (std::size_t c = 0; c < 3; ++c) lights[c].push_back(a[c]), paths[c].push_back(b[c]);
  }
  for (std::size_t c = 0; c < 3; ++c) {
    const auto a = mean_of(lights[c]), b = mean_of(paths[c]);
    const double error = std::hypot(a.standard_error, b.standard_error);
    EXPECT_NEAR(a.mean, b.mean, student_quantile(kAlpha, 3, kSeeds - 1) * error) << only << ", channel " << c;
    // The test has teeth: an error of 4 % would be seen.
    EXPECT_LT(student_quantile(kAlpha, 3, kSeeds - 1) * error, 0.04 * b.mean) << only << ", channel " << c;
  }
}

TEST(HairUnbiased, FurUnderALamp) {
  expect_equal_means(
      test::point_camera("1.5,1.2,1.5", "0,0.15,0", 12, 14) +
          "<shape type=\"rectangle\"><transform name=\"to_world\"><scale value=\"0.3\"/><rotate x=\"1\" "
          "angle=\"90\"/><translate x=\"0.4\" y=\"1.8\" z=\"-0.3\"/></transform><emitter "
          "type=\"area\"><rgb name=\"radiance\" value=\"10\"/></emitter></shape>",
      "direct");
}
TEST(HairUnbiased, LightThatFurSendsToAWall) {
  expect_equal_means(test::point_camera("0.5,0.8,0", "-1.5,0.8,0", 12, 20) + spot("0.2,2,0", "0,0.1,0"),
                     "indirect");
}
TEST(HairUnbiased, LightThatFurGetsFromAWall) {
  expect_equal_means(test::point_camera("1.5,1.2,1.5", "0,0.15,0", 12, 14) + spot("-0.2,1.9,0", "-1.5,0.9,0"),
                     "indirect");
}

// A horizontal hair far below a horizontal lamp, closed form: all of its width sees the same irradiance.
// Radiance of the diffuse lobe is color/π²·∫ L sinθ dω; a lamp of area A at distance d seen face on from
// right above the middle of the hair has L·A/d² ∫ ≈ with sinθ = 1, within (size/d)² = 0.3 %.
TEST(Hair, RadianceOfOneThreadIsThatOfTheFormula) {
  const test::TemporaryFolder folder;
  const std::string file = folder / "hair.txt";
  std::ofstream(file) << "-1 0 0 0.2\n1 0 0 0.2\n";
  const Scene scene = test::load_text(
      test::point_camera("0,0,4", "0,0,0", 4, 1) +
      "<shape type=\"linearcurve\"><string name=\"filename\" value=\"" + file +
      "\"/><bsdf type=\"kajiyakay\"><rgb name=\"diffuse_reflectance\" value=\"0.8\"/><rgb "
      "name=\"specular_reflectance\" value=\"0\"/></bsdf></shape><shape type=\"rectangle\"><transform "
      "name=\"to_world\"><scale value=\"0.2\"/><rotate x=\"1\" angle=\"90\"/><translate "
      "y=\"5\"/></transform><emitter type=\"area\"><rgb name=\"radiance\" value=\"100\"/></emitter></shape>");
  RenderSettings settings;
  settings.method = "brute-force";
  settings.lights = 64;
  const double expected = 0.8 / (3.14159265 * 3.14159265) * 100 * 0.16 / 25;
  const auto seen = mean_colour(render(scene, settings).picture);
  EXPECT_NEAR(seen[1], expected, 0.005 * expected);
  ReferenceSettings how;
  how.spp = 64;
  EXPECT_NEAR(mean_colour(reference(scene, settings, how).picture)[1], expected, 0.01 * expected);
}

}  // namespace
}  // namespace lumirank
