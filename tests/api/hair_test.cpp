// Fur in the matrix against fur in the path tracer.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <string>

#include "api/whole_renders.h"
#include "base/random.h"
#include "lumirank/lumirank.h"
#include "support/channel_means.h"
#include "support/scene_file.h"

namespace lumirank {
namespace {

using test::kAlpha;
using test::mean_color;
using test::mean_of;
using test::student_quantile;

const std::string kKajiyaKay =
    "<bsdf type=\"kajiyakay\"><rgb name=\"diffuse_reflectance\" value=\"0.5,0.4,0.3\"/><rgb "
    "name=\"specular_reflectance\" value=\"0.3\"/><float name=\"exponent\" value=\"15\"/></bsdf>";
const std::string kBlond =
    "<bsdf type=\"hair\"><float name=\"eumelanin\" value=\"0.1\"/><float name=\"pheomelanin\" "
    "value=\"0.3\"/><float name=\"longitudinal_roughness\" value=\"0.8\"/><float "
    "name=\"azimuthal_roughness\" value=\"0.6\"/></bsdf>";

// 400 leaning hairs of length 0.3 on a black floor around the origin, and a white wall 0.9 away.
std::string fur_and_wall(const test::TemporaryFolder& folder, const std::string& bsdf) {
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
  return "<shape type=\"bsplinecurve\"><string name=\"filename\" value=\"" + file + "\"/>" + bsdf +
         "</shape>"
         "<shape type=\"rectangle\"><transform name=\"to_world\"><scale value=\"3\"/><rotate x=\"1\" "
         "angle=\"-90\"/></transform><bsdf type=\"diffuse\"><rgb name=\"reflectance\" "
         "value=\"0\"/></bsdf></shape>"
         "<shape type=\"rectangle\"><transform name=\"to_world\"><rotate y=\"1\" angle=\"90\"/><translate "
         "x=\"-0.9\" "
         "y=\"0.8\"/></transform><bsdf type=\"diffuse\"><rgb name=\"reflectance\" "
         "value=\"0.8\"/></bsdf></shape>";
}
std::string spot(const char* origin, const char* target, int cutoff) {
  return std::string("<emitter type=\"spot\"><transform name=\"to_world\"><lookat origin=\"") + origin +
         "\" target=\"" + target +
         "\" up=\"0,0,1\"/></transform><rgb name=\"intensity\" value=\"9\"/><float name=\"cutoff_angle\" "
         "value=\"" +
         std::to_string(cutoff) + "\"/></emitter>";
}

RenderSettings unclamped(const char* only) {
  RenderSettings settings;
  settings.traced.rest = RestOfPaths::skip;
  set_field(settings, "only", only);
  settings.view.max_depth = 3;
  settings.method.name = "brute-force";
  settings.lights.clamp = 0;
  settings.traced.direct = DirectLight::matrix;
  settings.lights.count = 1500;
  return settings;
}

// Brute force over unclamped columns and the path tracer over the same paths, of at most one bounce: lights
// and receivers are far apart, which keeps the variance of 1/d² finite. Student's t over independent seeds: a
// false alarm in one of 1000 runs of each test, its three channels together. (Each sees the other's fur from
// the axis and its own as a ribbon, so they agree in the limit of thin hair: of the hairs' radius over the
// way between them, here a tenth, little is left.)
void expect_equal_means(const std::string& body, const char* only, int spp,
                        const std::string& bsdf = kKajiyaKay) {
  const test::TemporaryFolder folder;
  const Scene scene = test::load_text(fur_and_wall(folder, bsdf) + body);
  RenderSettings settings = unclamped(only);
  ReferenceSettings how;
  how.paths = ReferencePaths::columns;
  how.spp = spp;
  constexpr int kSeeds = 32;
  test::ChannelMeans lights, paths;
  for (int k = 0; k < kSeeds; ++k) {
    settings.seed = 300 + static_cast<std::uint64_t>(k);
    lights.add(render(scene, settings).picture);
    paths.add(reference(scene, settings, how).picture);
  }
  test::expect_equal_means(lights, paths, 0.04, only);
}

TEST(HairUnbiased, FurUnderALamp) {
  expect_equal_means(
      test::point_camera("1.5,1.2,1.5", "0,0.15,0", 12, 14) +
          "<shape type=\"rectangle\"><transform name=\"to_world\"><scale value=\"0.3\"/><rotate x=\"1\" "
          "angle=\"90\"/><translate x=\"0.4\" y=\"1.8\" z=\"-0.3\"/></transform><emitter "
          "type=\"area\"><rgb name=\"radiance\" value=\"10\"/></emitter></shape>",
      "direct", 64);
}
TEST(HairUnbiased, LightThatFurSendsToAWall) {
  expect_equal_means(test::point_camera("0.5,0.8,0", "-1.5,0.8,0", 12, 20) + spot("0.2,2,0", "0,0.1,0", 8),
                     "indirect", 192);
}
TEST(HairUnbiased, LightThatFurGetsFromAWall) {
  expect_equal_means(
      test::point_camera("1.5,1.2,1.5", "0,0.15,0", 12, 14) + spot("-0.1,1.9,0", "-0.9,0.9,0", 27),
      "indirect", 640);
}

// Light that went through, which the tests above have not; a light on hair and a receiver on hair.
TEST(HairUnbiased, LightThatBlondFurSendsToAWall) {
  expect_equal_means(test::point_camera("0.5,0.8,0", "-1.5,0.8,0", 12, 20) + spot("0.2,2,0", "0,0.1,0", 8),
                     "indirect", 192, kBlond);
}
TEST(HairUnbiased, LightThatBlondFurGetsFromAWall) {
  expect_equal_means(
      test::point_camera("1.5,1.2,1.5", "0,0.15,0", 12, 14) + spot("-0.1,1.9,0", "-0.9,0.9,0", 27),
      "indirect", 384, kBlond);
}

// One straight hair in the beam of a lamp, and the wall beside it, by direct integration over the hair:
// radiance = ρ/π ∫ f·sinθ_lamp·sinθ_wall·cosθ/d² · I/d_lamp² · 2r dl. The lamp stands 20° off the hair's
// axis: a round cap of r at both of its ends would add πr/(2L sin 20°) = 11 % to what it catches.
TEST(HairUnbiased, LightThatOneHairSendsToAWallIsThatOfTheFormula) {
  constexpr float kRadius = 0.01f, kLength = 0.4f, kIntensity = 9, kWall = -0.5f;
  const float off_axis = 20 * kPi / 180, edge = std::tan(5 * kPi / 180);
  const Vec3f lamp{3 * std::sin(off_axis), 3 * std::cos(off_axis), 0};
  const Vec3f eye{0, 0, 0.6f}, forward = normalize(Vec3f{kWall, 0, 0} - eye), up{0, 1, 0};
  const Vec3f right = cross(forward, up);
  constexpr int kPixels = 24, kSteps = 200;
  double sum = 0;
  for (int i = 0; i < kPixels * kPixels; ++i) {
    const auto across = [&](int k) { return ((static_cast<float>(k) + 0.5f) * 2 / kPixels - 1) * edge; };
    const Vec3f d = forward + right * across(i % kPixels) + up * across(i / kPixels);
    const Vec3f x = eye + d * ((kWall - eye.x) / d.x);
    for (int k = 0; k < kSteps; ++k) {
      const Vec3f p{0, kLength * ((static_cast<float>(k) + 0.5f) / kSteps - 0.5f), 0};
      const Vec3f in = lamp - p, out = x - p;
      const float sines = std::hypot(in.x, in.z) / length(in) * std::hypot(out.x, out.z) / length(out);
      sum += sines * std::abs(out.x) / length(out) / (length_squared(out) * length_squared(in));
    }
  }
  const double expected = sum / (kPixels * kPixels * kSteps) * 2 * kRadius * kLength * kIntensity *
                          (0.5 * kInvPi * kInvPi) * (0.8 * kInvPi);

  const test::TemporaryFolder folder;
  const std::string file = folder / "hair.txt";
  std::ofstream(file) << "0 -0.2 0 0.01\n0 0.2 0 0.01\n";
  const std::string origin = std::to_string(lamp.x) + "," + std::to_string(lamp.y) + ",0";
  const Scene scene = test::load_text(
      test::point_camera("0,0,0.6", "-0.5,0,0", 8, 10) + spot(origin.c_str(), "0,0,0", 6) +
      "<shape type=\"linearcurve\"><string name=\"filename\" value=\"" + file +
      "\"/><bsdf type=\"kajiyakay\"><rgb name=\"diffuse_reflectance\" value=\"0.5\"/><rgb "
      "name=\"specular_reflectance\" value=\"0\"/></bsdf></shape><shape type=\"rectangle\"><transform "
      "name=\"to_world\"><scale value=\"5\"/><rotate y=\"1\" angle=\"90\"/><translate "
      "x=\"-0.5\"/></transform><bsdf type=\"diffuse\"><rgb name=\"reflectance\" "
      "value=\"0.8\"/></bsdf></shape>");
  RenderSettings settings = unclamped("indirect");
  ReferenceSettings how;
  how.paths = ReferencePaths::columns;
  how.spp = 1024;
  constexpr int kSeeds = 24;
  std::vector<double> lights, paths;
  for (int k = 0; k < kSeeds; ++k) {
    settings.seed = 500 + static_cast<std::uint64_t>(k);
    lights.push_back(mean_color(render(scene, settings).picture)[1]);
    paths.push_back(mean_color(reference(scene, settings, how).picture)[1]);
  }
  for (const auto& values : {lights, paths}) {
    const auto got = mean_of(values);
    const double tolerance = student_quantile(kAlpha, 2, kSeeds - 1) * got.standard_error;
    EXPECT_NEAR(got.mean, expected, tolerance);
    EXPECT_LT(tolerance, 0.04 * expected);
  }
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
  settings.traced.rest = RestOfPaths::skip;
  settings.method.name = "brute-force";
  settings.lights.count = 64;
  const double expected = 0.8 / (3.14159265 * 3.14159265) * 100 * 0.16 / 25;
  const auto seen = mean_color(render(scene, settings).picture);
  EXPECT_NEAR(seen[1], expected, 0.005 * expected);
  ReferenceSettings how;
  how.spp = 64;
  EXPECT_NEAR(mean_color(reference(scene, settings, how).picture)[1], expected, 0.01 * expected);
}

}  // namespace
}  // namespace lumirank
