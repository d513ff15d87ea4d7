// The path tracer against closed forms.
#include <gtest/gtest.h>

#include <fstream>

#include "api/whole_renders.h"
#include "base/vec.h"
#include "lumirank/lumirank.h"
#include "support/scene_file.h"
#include "support/statistics.h"

namespace lumirank {
namespace {

using test::kAlphaOfAFile;
using test::load_text;
using test::mean_of;
using test::normal_quantile;
using test::point_camera;

std::vector<double> channel(const Picture& picture, std::size_t c) {
  std::vector<double> values;
  for (std::size_t p = c; p < picture.planes[0].rgb.size(); p += 3)
    values.push_back(picture.planes[0].rgb[p]);
  return values;
}

// Pixels are independent; the mean over them must lie within the confidence interval.
void expect_mean(const Picture& picture, const double (&expected)[3], const char* what) {
  for (std::size_t c = 0; c < 3; ++c) {
    const auto values = channel(picture, c);
    const auto m = mean_of(values);
    // Single precision sets a floor under the interval of noise-free pictures.
    const double allowed =
        normal_quantile(kAlphaOfAFile, 30) * m.standard_error + 2e-5 * std::abs(expected[c]) + 1e-7;
    EXPECT_NEAR(m.mean, expected[c], allowed) << what << ", channel " << c;
  }
}

constexpr const char* kClosedBox =
    "<shape type=\"cube\"><boolean name=\"flip_normals\" value=\"true\"/>"
    "<bsdf type=\"diffuse\"><rgb name=\"reflectance\" value=\"0.5, 0.2, 0.8\"/></bsdf>"
    "<emitter type=\"area\"><rgb name=\"radiance\" value=\"1, 2, 0.5\"/></emitter></shape>";

TEST(Reference, FurnaceOfAShiningBox) {
  // Inside a closed surface that emits L and reflects ρ everywhere, every bounce adds a factor ρ: L / (1 -
  // ρ).
  const Scene scene = load_text(point_camera("0,0,0", "0.3,0.2,1", 32, 60) + kClosedBox);
  RenderSettings settings;
  settings.view.max_depth = -1;
  ReferenceSettings how;
  how.spp = 64;
  expect_mean(reference(scene, settings, how).picture, {1 / 0.5, 2 / 0.8, 0.5 / 0.2}, "furnace");
}

TEST(Reference, FurnaceStopsAtTheDepthLimit) {
  // Depth d holds the bounces 0 … d - 1: L Σ_{k<d} ρ^k.
  const Scene scene = load_text(point_camera("0,0,0", "0.3,0.2,1", 32, 60) + kClosedBox);
  for (int depth : {1, 2, 4}) {
    RenderSettings settings;
    settings.view.max_depth = depth;
    ReferenceSettings how;
    how.spp = 32;
    double expected[3];
    const double albedo[3] = {0.5, 0.2, 0.8}, radiance[3] = {1, 2, 0.5};
    for (int c = 0; c < 3; ++c)
      expected[c] = radiance[c] * (1 - std::pow(albedo[c], depth)) / (1 - albedo[c]);
    expect_mean(reference(scene, settings, how).picture, expected, "depth");
  }
}

TEST(Reference, PartsOfTheFurnace) {
  // Direct light has one bounce, L·ρ; indirect all later ones, L·ρ²/(1 - ρ).
  const Scene scene = load_text(point_camera("0,0,0", "0.3,0.2,1", 32, 60) + kClosedBox);
  RenderSettings settings;
  settings.view.max_depth = -1;
  ReferenceSettings how;
  how.spp = 64;
  settings.view.only = LightPart::direct;
  expect_mean(reference(scene, settings, how).picture, {0.5, 0.4, 0.4}, "direct");
  settings.view.only = LightPart::indirect;
  expect_mean(reference(scene, settings, how).picture, {0.5, 0.1, 1.6}, "indirect");
}

TEST(Reference, HalfOpenSurfacesLoseNothingInAFurnace) {
  // A white ball that lets half of the light pass, in a ball that shines evenly: it can't be seen. What is
  // found behind a surface that a path went straight through counts once.
  const std::string ball =
      "<shape type=\"sphere\"><bsdf type=\"mask\"><float name=\"opacity\" value=\"0.5\"/><bsdf "
      "type=\"twosided\"><bsdf type=\"diffuse\"><rgb name=\"reflectance\" "
      "value=\"1\"/></bsdf></bsdf></bsdf></shape>"
      "<shape type=\"sphere\"><float name=\"radius\" value=\"9\"/><boolean name=\"flip_normals\" "
      "value=\"true\"/>"
      "<bsdf type=\"diffuse\"><rgb name=\"reflectance\" value=\"0\"/></bsdf><emitter type=\"area\"><rgb "
      "name=\"radiance\" value=\"1\"/></emitter></shape>";
  const std::string camera = point_camera("0,0,5", "0,0,0", 16, 15);
  const std::string elsewhere =
      "<shape type=\"sphere\"><point name=\"center\" x=\"0\" y=\"0\" z=\"7.5\"/><float name=\"radius\" "
      "value=\"0.1\"/><bsdf type=\"null\"/><medium name=\"interior\" type=\"homogeneous\"><float "
      "name=\"sigma_t\" "
      "value=\"1\"/></medium></shape>";
  RenderSettings settings;
  settings.view.max_depth = -1;
  ReferenceSettings how;
  how.spp = 256;
  expect_mean(reference(load_text(camera + ball), settings, how).picture, {1, 1, 1}, "paths");
  expect_mean(reference(load_text(camera + ball + elsewhere), settings, how).picture, {1, 1, 1},
              "paths of scenes with a medium");
}

TEST(Reference, HiddenEmittersAreSeenInMirrorsAlone) {
  const std::string integrator =
      "<integrator type=\"path\"><boolean name=\"hide_emitters\" value=\"true\"/></integrator>";
  const std::string sky = "<emitter type=\"constant\"><rgb name=\"radiance\" value=\"2, 1, 3\"/></emitter>";
  const std::string lamp =
      "<shape type=\"rectangle\"><transform name=\"to_world\"><scale value=\"9\"/><translate "
      "z=\"2\"/></transform>"
      "<emitter type=\"area\"><rgb name=\"radiance\" value=\"7\"/></emitter></shape>";
  // Turned by 45°: it shows the sky above.
  const std::string mirror =
      "<shape type=\"rectangle\"><transform name=\"to_world\"><scale value=\"9\"/><rotate x=\"1\" "
      "angle=\"-45\"/>"
      "</transform><bsdf type=\"conductor\"><float name=\"eta\" value=\"0\"/><float name=\"k\" "
      "value=\"1\"/></bsdf>"
      "</shape>";
  const std::string camera = integrator + point_camera("0,0,5", "0,0,0", 16, 10);
  RenderSettings settings;
  ReferenceSettings how;
  how.spp = 16;
  expect_mean(reference(load_text(camera + sky + lamp), settings, how).picture, {0, 0, 0}, "nothing");
  expect_mean(reference(load_text(camera + sky + lamp + mirror), settings, how).picture, {2, 1, 3}, "mirror");
  settings.method.name = "instant-radiosity";
  settings.lights.count = 100;
  expect_mean(render(load_text(camera + sky + lamp + mirror), settings).picture, {2, 1, 3}, "columns");
}

TEST(Reference, DiffusePlaneUnderTheSky) {
  // A plane that reflects ρ under constant radiance L from the whole hemisphere: ρ·L.
  const Scene scene =
      load_text(point_camera("0,2,0.01", "0,0,0", 16, 20) +
                "<shape type=\"rectangle\"><transform name=\"to_world\"><rotate x=\"1\" angle=\"-90\"/>"
                "<scale value=\"100\"/></transform><bsdf type=\"diffuse\"><rgb name=\"reflectance\" "
                "value=\"0.6, 0.3, 0.1\"/></bsdf></shape>"
                "<emitter type=\"constant\"><rgb name=\"radiance\" value=\"2, 1, 3\"/></emitter>");
  RenderSettings settings;
  settings.view.max_depth = -1;
  ReferenceSettings how;
  how.spp = 64;
  expect_mean(reference(scene, settings, how).picture, {1.2, 0.3, 0.3}, "sky");
}

// A floor whose smooth normals face away from the eye, as at the silhouettes of coarse meshes: they are
// turned until they face it, and under a lamp at infinity that is ρ/π · E · n·l, for the path tracer and by
// columns.
TEST(Reference, NormalsThatFaceAwayAreTurnedToTheEye) {
  const Vec3f n = normalize(Vec3f{0.985f, 0.174f, 0}), wo = normalize(Vec3f{-4.9f, 1, 0});
  const test::TemporaryFolder folder;
  std::ofstream(folder / "floor.obj")
      << "v -9 0 -9\nv -9 0 9\nv 9 0 9\nv 9 0 -9\nvn " << n.x << ' ' << n.y << " 0\nf 1//1 2//1 3//1 4//1\n";
  std::ofstream(folder / "scene.xml")
      << "<scene version=\"3.0.0\">" << point_camera("-4.9,1,0", "0,0,0", 16, 0.05)
      << "<shape type=\"obj\"><string name=\"filename\" value=\"floor.obj\"/><bsdf type=\"diffuse\"><rgb "
         "name=\"reflectance\" value=\"0.6, 0.3, 0.1\"/></bsdf></shape><emitter type=\"directional\"><vector "
         "name=\"direction\" x=\"0\" y=\"-1\" z=\"0\"/><rgb name=\"irradiance\" value=\"2, 1, 3\"/></emitter>"
         "</scene>";
  const Scene scene = Scene::load(folder / "scene.xml");
  const float toward = dot(n, wo);
  ASSERT_LT(toward, -0.9);
  const double f = normalize(n + wo * (0.01f - toward)).y / M_PI;
  RenderSettings settings;
  settings.method.name = "brute-force";
  settings.lights.count = 100;
  for (const Picture& picture :
       {reference(scene, settings, ReferenceSettings{.spp = 4}).picture, render(scene, settings).picture})
    for (std::size_t c = 0; c < 3; ++c)
      for (const double value : channel(picture, c)) EXPECT_NEAR(value, (c == 0 ? 1.2 : 0.3) * f, 2e-3 * f);
}

// Irradiance over π of a rectangle [-a,a]×[-b,b] of unit radiance at height h above the point below its
// center: four times the corner form factor between a differential element and a parallel rectangle.
double parallel_rectangle(double a, double b, double h) {
  const double x = a / h, y = b / h, sx = std::sqrt(1 + x * x), sy = std::sqrt(1 + y * y);
  return 4 / (2 * M_PI) * (x / sx * std::atan(y / sx) + y / sy * std::atan(x / sy));
}

TEST(Reference, LampOverAFloor) {
  // Direct light at the point below a lamp: ρ·L·F. The camera sees a spot of 2 mm from 0.5 m, in which F
  // changes by less than 1e-5; it looks past the lamp from the side.
  const Scene scene = load_text(
      point_camera("0.6,0.4,0", "0,0,0", 16, 0.2) +
      "<shape type=\"rectangle\"><transform name=\"to_world\"><rotate x=\"1\" angle=\"-90\"/><scale "
      "value=\"5\"/>"
      "</transform><bsdf type=\"diffuse\"><rgb name=\"reflectance\" value=\"0.6, 0.3, 0.1\"/></bsdf></shape>"
      "<shape type=\"rectangle\"><transform name=\"to_world\"><rotate x=\"1\" angle=\"90\"/><scale x=\"0.5\" "
      "y=\"1\" "
      "z=\"0.25\"/><translate y=\"1\"/></transform><emitter type=\"area\"><rgb name=\"radiance\" value=\"10, "
      "20, 30\"/>"
      "</emitter></shape>");
  RenderSettings settings;
  settings.view.max_depth = 2;
  ReferenceSettings how;
  how.spp = 64;
  const double f = parallel_rectangle(0.5, 0.25, 1);
  expect_mean(reference(scene, settings, how).picture, {0.6 * 10 * f, 0.3 * 20 * f, 0.1 * 30 * f}, "lamp");
}

TEST(Reference, MirrorShowsTheLampAndColumnsLeaveOutItsLightOnTheFloor) {
  // Columns and rest together are all paths: checked as means over a picture with a mirror beside a diffuse
  // floor.
  const std::string body =
      point_camera("0,1.5,4", "0,0.5,0", 24, 45) +
      "<shape type=\"rectangle\"><transform name=\"to_world\"><rotate x=\"1\" angle=\"-90\"/><scale "
      "value=\"3\"/></transform>"
      "<bsdf type=\"diffuse\"/></shape>"
      "<shape type=\"rectangle\"><transform name=\"to_world\"><translate z=\"-1\"/></transform>"
      "<bsdf type=\"conductor\"/></shape>"
      "<shape type=\"rectangle\"><transform name=\"to_world\"><rotate x=\"1\" angle=\"90\"/><scale "
      "value=\"0.5\"/>"
      "<translate y=\"2\" z=\"0.5\"/></transform><emitter type=\"area\"><rgb name=\"radiance\" "
      "value=\"5\"/></emitter></shape>";
  const Scene scene = load_text(body);
  RenderSettings settings;
  settings.view.max_depth = 5;
  ReferenceSettings how;
  how.spp = 256;
  const auto run = [&](const char* paths, std::uint64_t seed) {
    how.paths = reference_paths(paths);
    settings.seed = seed;
    const Picture picture = reference(scene, settings, how).picture;
    return channel(picture, 1);
  };
  const auto all = run("all", 1), columns = run("columns", 2), rest = run("rest", 3);
  std::vector<double> difference;
  double rest_sum = 0;
  for (std::size_t p = 0; p < all.size(); ++p) {
    difference.push_back(all[p] - columns[p] - rest[p]);
    rest_sum += rest[p];
  }
  const auto m = mean_of(difference);
  EXPECT_NEAR(m.mean, 0, normal_quantile(kAlphaOfAFile, 30) * m.standard_error);
  EXPECT_GT(rest_sum, 0) << "the mirror throws light of the lamp on the floor";
}

TEST(Reference, StatesItsErrorHonestly) {
  // The stated error of a short run against a run with 64 times the samples, whose own error is an eighth:
  // relative L1 averages over 24² pixels, so the statement holds within 25 %.
  const Scene scene = test::box();
  RenderSettings settings;
  settings.view.width = settings.view.height = 24;
  ReferenceSettings how;
  how.spp = 8;
  const RenderResult small = reference(scene, settings, how);
  how.spp = 512;
  settings.seed = 2;
  const RenderResult large = reference(scene, settings, how);
  double difference = 0, total = 0;
  for (std::size_t k = 0; k < small.picture.planes[0].rgb.size(); ++k) {
    difference += std::abs(small.picture.planes[0].rgb[k] - large.picture.planes[0].rgb[k]);
    total += large.picture.planes[0].rgb[k];
  }
  const std::string& report = small.report.json();
  const double stated = std::stod(report.substr(report.find("error.relative_l1\": ") + 20));
  EXPECT_NEAR(stated / (difference / total), 1, 0.25);
}

}  // namespace
}  // namespace lumirank
