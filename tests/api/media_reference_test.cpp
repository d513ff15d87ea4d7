// The volume path tracer against closed forms.
#include <gtest/gtest.h>

#include <cstring>
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
using test::TemporaryFolder;

constexpr std::size_t kComparisons = 40;  // in this file

// Parallel rays along +x through a window of half a width `half` about the x axis.
std::string parallel_camera(double half) {
  return "<sensor type=\"orthographic\"><float name=\"near_clip\" value=\"0.01\"/><transform "
         "name=\"to_world\">"
         "<scale value=\"" +
         std::to_string(half) +
         "\"/><lookat origin=\"-5,0,0\" target=\"0,0,0\" up=\"0,0,1\"/></transform><film type=\"hdrfilm\">"
         "<integer name=\"width\" value=\"24\"/><integer name=\"height\" value=\"24\"/><rfilter "
         "type=\"box\"/>"
         "</film></sensor>";
}

// The cube [-1, 1]³ of a medium, behind a boundary that is not seen.
std::string cube_of(const std::string& medium) {
  return "<shape type=\"cube\"><bsdf type=\"null\"/>" + medium + "</shape>";
}

std::string homogeneous(const std::string& sigma_t, const std::string& albedo,
                        const std::string& phase = "") {
  return "<medium type=\"homogeneous\" name=\"interior\"><rgb name=\"sigma_t\" value=\"" + sigma_t +
         "\"/><rgb name=\"albedo\" value=\"" + albedo + "\"/>" + phase + "</medium>";
}

// A grid of n³ equal numbers that fills the cube: everything that is tracked, with a known answer.
void write_even_grid(const std::string& file, int n, float value) {
  std::string bytes = "VOL\3";
  const auto put = [&](auto x) { bytes.append(reinterpret_cast<const char*>(&x), sizeof x); };
  put(std::int32_t{1});
  for (int axis = 0; axis < 3; ++axis) put(std::int32_t{n});
  put(std::int32_t{1});
  for (const float corner : {-1.0f, -1.0f, -1.0f, 1.0f, 1.0f, 1.0f}) put(corner);
  for (int k = 0; k < n * n * n; ++k) put(value);
  std::ofstream(file, std::ios::binary) << bytes;
}

std::string even_grid(const std::string& file, const std::string& albedo) {
  return "<medium type=\"heterogeneous\" name=\"interior\"><volume type=\"gridvolume\" name=\"sigma_t\">"
         "<string name=\"filename\" value=\"" +
         file + "\"/><boolean name=\"use_grid_bbox\" value=\"true\"/></volume><rgb name=\"albedo\" value=\"" +
         albedo + "\"/></medium>";
}

Picture render_truth(const Scene& scene, int paths, int max_depth = -1) {
  RenderSettings settings;
  settings.view.max_depth = max_depth;
  ReferenceSettings how;
  how.spp = paths;
  return reference(scene, settings, how).picture;
}

void expect_mean_light(const Picture& picture, const double (&expected)[3], const char* what) {
  for (std::size_t c = 0; c < 3; ++c) {
    std::vector<double> values;
    for (std::size_t p = c; p < picture.planes[0].rgb.size(); p += 3)
      values.push_back(static_cast<double>(picture.planes[0].rgb[p]));
    const auto m = mean_of(values);
    const double allowed =
        normal_quantile(kAlphaOfAFile, kComparisons) * m.standard_error + 2e-4 * std::abs(expected[c]) + 1e-7;
    EXPECT_NEAR(m.mean, expected[c], allowed) << what << ", channel " << c;
  }
}

constexpr const char* kWhiteSky = "<emitter type=\"constant\"><rgb name=\"radiance\" value=\"1\"/></emitter>";

TEST(MediaReference, AbsorptionIsBeerAndLamberts) {
  const TemporaryFolder folder;
  const double expected[3] = {std::exp(-0.4), std::exp(-2.0), std::exp(-6.0)};
  const Scene scene =
      load_text(parallel_camera(0.5) + kWhiteSky + cube_of(homogeneous("0.2, 1, 3", "0, 0, 0")));
  expect_mean_light(render_truth(scene, 64), expected, "absorption");
  write_even_grid(folder / "even.vol", 9, 0.7f);
  const Scene grid =
      load_text(parallel_camera(0.5) + kWhiteSky + cube_of(even_grid(folder / "even.vol", "0, 0, 0")));
  const double gray[3] = {std::exp(-1.4), std::exp(-1.4), std::exp(-1.4)};
  expect_mean_light(render_truth(grid, 64), gray, "absorption of a grid");
}

TEST(MediaRender, ColorOfGlassIsBeersLaw) {
  // Glass that does not refract; a floor, out of sight, has lights. `render` knows no medium then.
  const std::string glass =
      "<shape type=\"cube\"><bsdf type=\"dielectric\"><float name=\"int_ior\" value=\"1.5\"/>"
      "<float name=\"ext_ior\" value=\"1.5\"/></bsdf>" +
      homogeneous("0.1, 0.5, 1", "0, 0, 0") + "</shape>";
  const std::string floor =
      "<shape type=\"rectangle\"><transform name=\"to_world\"><translate z=\"-9\"/></transform></shape>";
  const Scene scene = load_text(parallel_camera(0.9) + kWhiteSky + glass + floor);
  RenderSettings settings;
  settings.passes = 1;
  settings.denoise = Denoise::off;
  const double expected[3] = {std::exp(-0.2), std::exp(-1.0), std::exp(-2.0)};
  const RenderResult result = render(scene, settings);
  EXPECT_EQ(result.report.method, "row-guided-sampling");
  expect_mean_light(result.picture, expected, "color");
}

TEST(MediaReference, NothingIsLostInAFurnace) {
  // With an albedo of 1 under an even sky every path finds the sky at last, whatever the phase function.
  const TemporaryFolder folder;
  const double one[3] = {1, 1, 1};
  const std::string forward = "<phase type=\"hg\"><float name=\"g\" value=\"0.7\"/></phase>";
  const std::string mixed = "<phase type=\"blendphase\"><float name=\"weight\" value=\"0.3\"/>" + forward +
                            "<phase type=\"hg\"><float name=\"g\" value=\"-0.4\"/></phase></phase>";
  for (const std::string& phase : {std::string(), forward, mixed})
    expect_mean_light(render_truth(load_text(parallel_camera(0.9) + kWhiteSky +
                                             cube_of(homogeneous("0.5, 2, 4", "1, 1, 1", phase))),
                                   48),
                      one, "furnace");
  write_even_grid(folder / "even.vol", 9, 1.5f);
  expect_mean_light(render_truth(load_text(parallel_camera(0.9) + kWhiteSky +
                                           cube_of(even_grid(folder / "even.vol", "1, 1, 1"))),
                                 48),
                    one, "furnace of a grid");
}

TEST(MediaReference, AColoredFurnaceKeepsWhite) {
  // Where channels have different extinctions, paths are weighted over the three choices of one.
  const double one[3] = {1, 1, 1};
  expect_mean_light(
      render_truth(load_text(parallel_camera(0.9) + kWhiteSky + cube_of(homogeneous("0, 1, 20", "1, 1, 1"))),
                   64),
      one, "colored furnace");
}

TEST(MediaReference, GlassAroundAMediumKeepsWhite) {
  const double one[3] = {1, 1, 1};
  const Scene scene =
      load_text(parallel_camera(0.7) + kWhiteSky + "<shape type=\"sphere\"><bsdf type=\"dielectric\"/>" +
                homogeneous("0.5, 1, 2", "1, 1, 1") + "</shape>");
  expect_mean_light(render_truth(scene, 64), one, "glass");
}

// Light comes down the z axis, the eye looks along x: the way of the light to the ray is 1 - z, that of the
// ray is 2.
double scattered_once(double sigma_t, double albedo, double half) {
  const double before =
      (std::exp(-sigma_t * (1 - half)) - std::exp(-sigma_t * (1 + half))) / (2 * half * sigma_t);
  return albedo / (4 * kPiD) * before * (1 - std::exp(-2 * sigma_t));
}

TEST(MediaReference, SingleScatteringInASlab) {
  const TemporaryFolder folder;
  const std::string sun =
      "<emitter type=\"directional\"><vector name=\"direction\" x=\"0\" y=\"0\" z=\"-1\"/>"
      "<rgb name=\"irradiance\" value=\"1, 1, 1\"/></emitter>";
  const double sigma[3] = {0.3, 1, 2}, albedo[3] = {0.9, 0.5, 1};
  double expected[3];
  for (int c = 0; c < 3; ++c) expected[c] = scattered_once(sigma[c], albedo[c], 0.4);
  expect_mean_light(
      render_truth(load_text(parallel_camera(0.4) + sun + cube_of(homogeneous("0.3, 1, 2", "0.9, 0.5, 1"))),
                   64, 2),
      expected, "single scattering");
  write_even_grid(folder / "even.vol", 12, 1);
  for (int c = 0; c < 3; ++c) expected[c] = scattered_once(1, albedo[c], 0.4);
  expect_mean_light(render_truth(load_text(parallel_camera(0.4) + sun +
                                           cube_of(even_grid(folder / "even.vol", "0.9, 0.5, 1"))),
                                 64, 2),
                    expected, "single scattering in a grid");
}

TEST(MediaReference, ACameraInAMediumLooksThroughIt) {
  // A wall at a distance of 5 to 6 that shines, with the camera in the medium that fills everything.
  const std::string medium =
      "<medium type=\"homogeneous\" id=\"fog\"><rgb name=\"sigma_t\" value=\"0.1, 0.2, 0.4\"/>"
      "<rgb name=\"albedo\" value=\"0, 0, 0\"/></medium>";
  std::string camera = parallel_camera(0.5);
  camera.insert(camera.find("<film"), "<ref id=\"fog\"/>");
  const Scene scene =
      load_text(medium + camera +
                "<shape type=\"cube\"><emitter type=\"area\"><rgb name=\"radiance\" value=\"1\"/></emitter>"
                "</shape>");
  // The cube's near face is 4 away, of which the film sees nothing before its near plane.
  const double seen = 4 - 0.5 * 0.01;
  const double expected[3] = {std::exp(-0.1 * seen), std::exp(-0.2 * seen), std::exp(-0.4 * seen)};
  expect_mean_light(render_truth(scene, 16), expected, "camera in fog");
}

TEST(MediaReference, WhatAFogLampLightsAgreesWithAMeshOfIt) {
  // The same light once as a point that only light sampling finds and once as a small sphere that directions
  // find too: the two ways of a path to a lamp are weighted rightly.
  const std::string fog = homogeneous("0.5, 0.5, 0.5", "0.8, 0.8, 0.8",
                                      "<phase type=\"hg\"><float name=\"g\" value=\"0.5\"/></phase>");
  const double radius = 0.05, intensity = 1;
  const std::string radiance = std::to_string(intensity / (kPiD * radius * radius));
  const auto mean_light = [&](const std::string& lamp) {
    const Picture picture = render_truth(load_text(parallel_camera(0.9) + cube_of(fog) + lamp), 256);
    std::vector<double> values;
    // Not where the sphere itself is seen.
    for (std::size_t y = 0; y < 24; ++y)
      for (std::size_t x = 0; x < 24; ++x)
        if (x < 8 || x > 15 || y < 8 || y > 15)
          values.push_back(static_cast<double>(picture.planes[0].rgb[3 * (24 * y + x)]));
    return mean_of(values);
  };
  const auto point = mean_light(
      "<emitter type=\"point\"><point name=\"position\" x=\"0\" y=\"0\" z=\"0\"/>"
      "<rgb name=\"intensity\" value=\"1\"/></emitter>");
  const auto sphere = mean_light(
      "<shape type=\"sphere\"><float name=\"radius\" value=\"0.05\"/><emitter type=\"area\">"
      "<rgb name=\"radiance\" value=\"" +
      radiance + "\"/></emitter></shape>");
  // The sphere shadows what scatters behind it by about its share of the directions: under 1 %.
  EXPECT_NEAR(point.mean, sphere.mean,
              0.01 * point.mean + 4 * std::hypot(point.standard_error, sphere.standard_error));
}

// What a point lamp of intensity 1 lights of the cube, scattered once towards the parallel camera: the mean
// over the window by the midpoint rule.
double scattered_from(Vec3f lamp, double sigma_t, double albedo, double g, double half) {
  constexpr int kAcross = 24, kAlong = 2000;
  double sum = 0;
  for (int j = 0; j < kAcross; ++j)
    for (int k = 0; k < kAcross; ++k) {
      const double y = half * ((2 * j + 1.0) / kAcross - 1), z = half * ((2 * k + 1.0) / kAcross - 1);
      for (int n = 0; n < kAlong; ++n) {
        const double x = (2 * n + 1.0) / kAlong - 1;
        const double to[3] = {lamp.x - x, lamp.y - y, lamp.z - z};
        const double d2 = to[0] * to[0] + to[1] * to[1] + to[2] * to[2], d = std::sqrt(d2);
        // The path goes on along +x and turns to the lamp.
        const double base = 1 + g * g - 2 * g * to[0] / d;
        const double phase = (1 - g * g) / (4 * kPiD * base * std::sqrt(base));
        sum += std::exp(-sigma_t * (x + 1 + d)) * phase / d2;
      }
    }
  return sum * albedo * sigma_t * (2.0 / kAlong) / (kAcross * kAcross);
}

TEST(MediaReference, ALampInFogLightsAsItsIntegralSays) {
  const TemporaryFolder folder;
  const std::string lamp =
      "<emitter type=\"point\"><point name=\"position\" x=\"0.3\" y=\"0.1\" z=\"0.5\"/>"
      "<rgb name=\"intensity\" value=\"1\"/></emitter>";
  const Vec3f at{0.3f, 0.1f, 0.5f};
  const double sigma[3] = {0.3, 1, 4}, albedo[3] = {0.9, 0.5, 1};
  double expected[3];
  for (int c = 0; c < 3; ++c) expected[c] = scattered_from(at, sigma[c], albedo[c], 0.6, 0.4);
  const std::string forward = "<phase type=\"hg\"><float name=\"g\" value=\"0.6\"/></phase>";
  expect_mean_light(render_truth(load_text(parallel_camera(0.4) + lamp +
                                           cube_of(homogeneous("0.3, 1, 4", "0.9, 0.5, 1", forward))),
                                 256, 2),
                    expected, "a lamp in fog");
  write_even_grid(folder / "even.vol", 12, 1);
  for (int c = 0; c < 3; ++c) expected[c] = scattered_from(at, 1, albedo[c], 0, 0.4);
  expect_mean_light(render_truth(load_text(parallel_camera(0.4) + lamp +
                                           cube_of(even_grid(folder / "even.vol", "0.9, 0.5, 1"))),
                                 256, 2),
                    expected, "a lamp in a grid");
}

// A grid that is dense on one side and empty on the other: what collisions are supposed to do there is far
// from what they do, and only weights may depend on it.
void write_uneven_grid(const std::string& file, int n) {
  std::string bytes = "VOL\3";
  const auto put = [&](auto x) { bytes.append(reinterpret_cast<const char*>(&x), sizeof x); };
  put(std::int32_t{1});
  for (int axis = 0; axis < 3; ++axis) put(std::int32_t{n});
  put(std::int32_t{1});
  for (const float corner : {-1.0f, -1.0f, -1.0f, 1.0f, 1.0f, 1.0f}) put(corner);
  for (int z = 0; z < n; ++z)
    for (int y = 0; y < n; ++y)
      for (int x = 0; x < n; ++x)
        put((x + y + z) % 3 == 0 ? 12.0f * static_cast<float>(x) / static_cast<float>(n) : 0.0f);
  std::ofstream(file, std::ios::binary) << bytes;
}

TEST(MediaReference, WhatTwoWaysOfTheSameLampFindIsTheSameInUnevenSmoke) {
  // As a point, and as a mesh that the directions of paths find too. The mesh is so dim and large beside the
  // other that neither is found by luck.
  const TemporaryFolder folder;
  write_uneven_grid(folder / "uneven.vol", 10);
  const std::string smoke = cube_of(even_grid(folder / "uneven.vol", "0.9, 0.8, 0.7"));
  const auto mean_light = [&](const std::string& lamp) {
    const Picture picture = render_truth(load_text(parallel_camera(0.5) + smoke + lamp), 128);
    std::vector<double> values;
    for (const float v : picture.planes[0].rgb) values.push_back(static_cast<double>(v));
    return mean_of(values);
  };
  const auto point = mean_light(
      "<emitter type=\"point\"><point name=\"position\" x=\"0\" y=\"0\" z=\"0.8\"/>"
      "<rgb name=\"intensity\" value=\"1\"/></emitter>");
  const double radius = 0.04;
  const auto sphere = mean_light(
      "<shape type=\"sphere\"><point name=\"center\" x=\"0\" y=\"0\" z=\"0.8\"/>"
      "<float name=\"radius\" value=\"0.04\"/><emitter type=\"area\"><rgb name=\"radiance\" value=\"" +
      std::to_string(1 / (kPiD * radius * radius)) + "\"/></emitter></shape>");
  EXPECT_NEAR(point.mean, sphere.mean,
              0.005 * point.mean + 4 * std::hypot(point.standard_error, sphere.standard_error));
}

}  // namespace
}  // namespace lumirank
