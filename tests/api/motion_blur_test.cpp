// An open shutter: closed forms, the methods against the reference over the same instants, and what is
// refused.
#include <gtest/gtest.h>

#include <cmath>

#include "lumirank/animate.h"
#include "lumirank/compare.h"
#include "lumirank/session.h"
#include "support/refused.h"
#include "support/scene_file.h"
#include "support/statistics.h"

namespace lumirank {
namespace {

using test::refused;
using test::TemporaryFolder;

// Its file stays: it is read again at every instant.
class MovingScene {
 public:
  explicit MovingScene(const std::string& body) : file_(folder_ / "scene.xml") {
    std::ofstream(file_) << "<scene version=\"3.0.0\">" << body << "</scene>";
    LoadOptions options;
    options.frames_per_second = 1;  // seconds are frames
    scene_ = Scene::load(file_, options);
  }
  const Scene& operator*() const { return scene_; }

 private:
  TemporaryFolder folder_;
  std::string file_;
  Scene scene_;
};

std::string move_x(double from, double to, const std::string& before = "", double y = 0, double z = 0) {
  const auto key = [&](int time, double x) {
    return "<transform time=\"" + std::to_string(time) + "\">" + before + "<translate x=\"" +
           std::to_string(x) + "\" y=\"" + std::to_string(y) + "\" z=\"" + std::to_string(z) +
           "\"/></transform>";
  };
  return "<animation name=\"to_world\">" + key(0, from) + key(1, to) + "</animation>";
}

std::string camera(int width, int height, const std::string& to_world, double fov) {
  return "<sensor type=\"perspective\"><float name=\"fov\" value=\"" + std::to_string(fov) + "\"/>" +
         to_world + "<film type=\"hdrfilm\"><integer name=\"width\" value=\"" + std::to_string(width) +
         "\"/><integer name=\"height\" value=\"" + std::to_string(height) +
         "\"/><rfilter type=\"box\"/></film></sensor>";
}

// A lamp, a ball and the camera move over a floor; two walls send light on.
std::string all_moves() {
  const std::string rotate = "<rotate x=\"1\" angle=\"90\"/>", small = "<scale value=\"0.4\"/>";
  const auto eye = [](int time, double x) {
    return "<transform time=\"" + std::to_string(time) + "\"><lookat origin=\"" + std::to_string(x) +
           ",2.5,5\" target=\"0,0.6,0\" up=\"0,1,0\"/></transform>";
  };
  return camera(12, 8, "<animation name=\"to_world\">" + eye(0, -0.4) + eye(1, 0.4) + "</animation>", 45) +
         "<shape type=\"rectangle\"><transform name=\"to_world\"><rotate x=\"1\" angle=\"-90\"/><scale "
         "value=\"3\"/></transform></shape>"
         "<shape type=\"rectangle\"><transform name=\"to_world\"><scale value=\"3\"/><translate "
         "z=\"-2\"/></transform></shape>"
         "<shape type=\"sphere\"><float name=\"radius\" value=\"0.5\"/>" +
         move_x(-1.2, 1.2, "", 0.6) + "</shape><shape type=\"rectangle\">" +
         move_x(1.5, -1.5, small + rotate, 2.5) +
         "<emitter type=\"area\"><rgb name=\"radiance\" value=\"20,14,8\"/></emitter></shape>";
}

RenderSettings open_for_a_frame(const char* method, std::uint64_t seed = 1) {
  RenderSettings settings;
  settings.seed = seed;
  settings.view.spp = 16;
  settings.view.max_depth = 3;
  settings.view.shutter_close = 1;
  settings.view.shutter_samples = 8;
  settings.lights.count = 1600;
  settings.lights.clamp = 0;
  settings.method.name = method;
  settings.traced.rest = RestOfPaths::skip;
  settings.traced.direct = DirectLight::matrix;
  return settings;
}

// Relative L1.
double difference(const Picture& a, const Picture& b) {
  double off = 0, all = 0;
  for (std::size_t k = 0; k < a.planes[0].rgb.size(); ++k)
    off += std::abs(a.planes[0].rgb[k] - b.planes[0].rgb[k]), all += b.planes[0].rgb[k];
  return off / all;
}

double sum_of(const Picture& picture) {
  double sum = 0;
  for (const float v : picture.planes[0].rgb) sum += v;
  return sum;
}

// Differences are 0 in the mean, to one in a thousand in all, and known to `precision`.
void expect_none(const std::vector<std::vector<double>>& differences, double precision) {
  for (std::size_t k = 0; k < differences.size(); ++k) {
    const auto mean = test::mean_of(differences[k]);
    const double half = test::student_quantile(1e-3, differences.size(), differences[k].size() - 1);
    EXPECT_NEAR(mean.mean, 0, half * mean.standard_error) << k;
    EXPECT_LT(mean.standard_error, precision) << k;
  }
}

// A shining strip of width 0.5 that crosses 2 in the time: what a place sees of it, from 0 at ±1.25 to a
// quarter of the time within ±0.75.
double trapezoid(double from, double to) {
  constexpr int kSteps = 64;
  double sum = 0;
  for (int k = 0; k < kSteps; ++k) {
    const double x = std::abs(from + (to - from) * (k + 0.5) / kSteps);
    sum += std::clamp((1.25 - x) / 0.5, 0.0, 1.0) * 0.25;
  }
  return sum / kSteps;
}

TEST(MotionBlur, AMovingStripIsATrapezoid) {
  constexpr int kWidth = 24, kHeight = 4, kSeeds = 12;
  // 4 wide at the strip's distance of 4.
  const MovingScene scene(
      camera(
          kWidth, kHeight,
          "<transform name=\"to_world\"><lookat origin=\"0,0,4\" target=\"0,0,0\" up=\"0,1,0\"/></transform>",
          2 * std::atan(0.5) * 180 / 3.14159265358979) +
      "<shape type=\"rectangle\">" + move_x(-1, 1, "<scale x=\"0.25\" y=\"3\"/>") +
      "<emitter type=\"area\"><rgb name=\"radiance\" value=\"1,2,4\"/></emitter></shape>");
  for (const bool traced : {true, false}) {
    std::vector<test::RunningMean> columns(kWidth);
    for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
      RenderSettings settings = open_for_a_frame("brute-force", seed);
      settings.view.max_depth = 1;
      settings.view.shutter_samples = 16;
      ReferenceSettings how;
      how.spp = 32;
      const Picture picture =
          traced ? reference(*scene, settings, how).picture : render(*scene, settings).picture;
      for (int x = 0; x < kWidth; ++x) {
        double sum = 0;
        for (int y = 0; y < kHeight; ++y)
          sum += picture.planes[0].rgb[static_cast<std::size_t>(3 * (y * kWidth + x) + 1)];
        columns[static_cast<std::size_t>(x)].add(sum / kHeight);
      }
    }
    const double quantile = test::student_quantile(1e-4, 2 * kWidth, kSeeds - 1);
    double widest = 0;
    for (int x = 0; x < kWidth; ++x) {
      const auto& c = columns[static_cast<std::size_t>(x)];
      const double want = 2 * trapezoid(-2 + 4.0 * x / kWidth, -2 + 4.0 * (x + 1) / kWidth);
      widest = std::max(widest, c.standard_error());
      EXPECT_NEAR(c.mean(), want, quantile * c.standard_error() + 1e-3) << x << " traced " << traced;
    }
    EXPECT_LT(widest, 0.03);
  }
}

TEST(MotionBlur, AStillSceneIsItself) {
  const std::string still =
      camera(
          8, 8,
          "<transform name=\"to_world\"><lookat origin=\"0,3,4\" target=\"0,0,0\" up=\"0,1,0\"/></transform>",
          40) +
      "<shape type=\"rectangle\"><transform name=\"to_world\"><rotate x=\"1\" angle=\"-90\"/><scale "
      "value=\"3\"/></transform></shape><shape type=\"cube\"><transform name=\"to_world\"><scale "
      "value=\"0.5\"/></transform></shape><emitter type=\"point\"><point name=\"position\" x=\"1\" y=\"3\" "
      "z=\"1\"/><rgb name=\"intensity\" value=\"9\"/></emitter>";
  const MovingScene scene(still);
  RenderSettings open = open_for_a_frame("brute-force"), closed = open;
  closed.view.shutter_close = 0;
  ReferenceSettings how;
  how.spp = 8;
  // The same paths at any instant.
  EXPECT_EQ(reference(*scene, open, how).picture.planes[0].rgb,
            reference(*scene, closed, how).picture.planes[0].rgb);
  // The same light on average; lights are others at each instant.
  constexpr int kSeeds = 8;
  std::vector<std::vector<double>> differences(2);
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    open.seed = closed.seed = seed;
    const double truth = sum_of(render(*scene, closed).picture);
    for (std::size_t m = 0; m < 2; ++m) {
      open.method.name = m == 0 ? "brute-force" : "multidimensional-lightcuts";
      differences[m].push_back(sum_of(render(*scene, open).picture) / truth - 1);
    }
  }
  expect_none(differences, 0.005);
}

TEST(MotionBlur, BruteForceAgreesWithTheReference) {
  const MovingScene scene(all_moves());
  // By quarters of the picture.
  constexpr int kSeeds = 8;
  std::vector<std::vector<double>> differences(4);
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    RenderSettings settings = open_for_a_frame("brute-force", seed);  // the seed decides the instants
    settings.lights.count = 4800;
    ReferenceSettings how;
    how.spp = 1024;
    const RenderResult made = render(*scene, settings), truth = reference(*scene, settings, how);
    EXPECT_EQ(made.report.numbers.at("shutter.instants"), 8);
    EXPECT_EQ(truth.report.numbers.at("shutter.instants"), 8);
    double sums[4] = {}, wanted[4] = {};
    for (int y = 0; y < 8; ++y)
      for (int x = 0; x < 12; ++x)
        for (int c = 0; c < 3; ++c) {
          const auto k = static_cast<std::size_t>(3 * (12 * y + x) + c);
          sums[2 * (y / 4) + x / 6] += made.picture.planes[0].rgb[k];
          wanted[2 * (y / 4) + x / 6] += truth.picture.planes[0].rgb[k];
        }
    for (std::size_t q = 0; q < 4; ++q) differences[q].push_back(sums[q] / wanted[q] - 1);
  }
  expect_none(differences, 0.01);
}

TEST(MotionBlur, MultidimensionalLightcutsConvergeToBruteForce) {
  const MovingScene scene(all_moves());
  const Picture all = render(*scene, open_for_a_frame("brute-force")).picture;
  std::vector<double> errors;
  for (const char* pairs : {"30", "300", "3000", "1000000"}) {
    RenderSettings settings = open_for_a_frame("multidimensional-lightcuts");
    settings.method.parameters = {{"max-pairs", pairs}, {"error-bound", "0"}};
    errors.push_back(difference(render(*scene, settings).picture, all));
  }
  for (std::size_t k = 1; k < 3; ++k) EXPECT_LT(errors[k], 0.7 * errors[k - 1]) << k;
  EXPECT_LT(errors.back(), 1e-5);
  EXPECT_GT(errors.front(), 0.01);
}

TEST(MotionBlur, HasTheSameBitsOnAnyNumberOfThreads) {
  const MovingScene scene(all_moves());
  for (const char* method : {"brute-force", "multidimensional-lightcuts"}) {
    RenderSettings settings = open_for_a_frame(method);
    settings.traced.direct = DirectLight::automatic;
    settings.traced.rest = RestOfPaths::trace;
    settings.lights.count = 400;
    settings.threads = 1;
    const auto one = render(*scene, settings).picture.planes[0].rgb;
    settings.threads = 3;
    EXPECT_EQ(render(*scene, settings).picture.planes[0].rgb, one) << method;
    settings.seed = 2;
    EXPECT_NE(render(*scene, settings).picture.planes[0].rgb, one) << method;
  }
}

TEST(MotionBlur, ACropIsThatWindowOfTheWhole) {
  const MovingScene scene(all_moves());
  RenderSettings settings = open_for_a_frame("brute-force");
  const Picture whole = render(*scene, settings).picture;
  settings.view.crop = {3, 2, 5, 4};
  const Picture part = render(*scene, settings).picture;
  for (std::size_t y = 0; y < 4; ++y)
    for (std::size_t k = 0; k < 15; ++k)
      EXPECT_EQ(part.planes[0].rgb[15 * y + k], whole.planes[0].rgb[36 * (y + 2) + 9 + k]);
}

// Frames of a shot are those pictures.
TEST(MotionBlur, ShotsHaveIt) {
  const MovingScene scene(all_moves());
  AnimateSettings settings;
  settings.render = open_for_a_frame("auto");
  settings.render.view.shutter_close = 0.25;
  settings.frames_per_second = 1;
  settings.endings = {".pfm"};
  const TemporaryFolder folder;
  EXPECT_EQ(animate(*scene, settings, folder / "shot").rendered, 2);
  write_picture(folder / "still.pfm", render((*scene).at(0), settings.render).picture);
  const auto bytes = [](const std::string& file) {
    std::ifstream in(file, std::ios::binary);
    return std::string{std::istreambuf_iterator<char>(in), {}};
  };
  EXPECT_EQ(bytes(folder / "shot/frame_0000.pfm"), bytes(folder / "still.pfm"));
  settings.frames_per_second = 2;
  EXPECT_NE(refused([&] { animate(*scene, settings, folder / "other"); }).find("other frames"),
            std::string::npos);
  settings.frames_per_second = 1;
  settings.tensor = TensorSettings{};
  EXPECT_NE(refused([&] { animate(*scene, settings, folder / "other"); }).find("--shutter"),
            std::string::npos);
}

TEST(MotionBlur, TheShutterCountsFromTheMomentInFrames) {
  const MovingScene scene(all_moves());
  // Half a frame from a quarter on is the same as a quarter before to a quarter after the middle.
  RenderSettings early = open_for_a_frame("brute-force"), centered = early;
  early.view.shutter_close = 0.5;
  centered.view.shutter_open = -0.25, centered.view.shutter_close = 0.25;
  const Picture a = render((*scene).at(0.25), early).picture, b = render((*scene).at(0.5), centered).picture;
  EXPECT_EQ(a.planes[0].rgb, b.planes[0].rgb);
  EXPECT_GT(difference(a, render((*scene).at(0.5), early).picture), 0.05);
}

TEST(MotionBlur, WhatItCannotDoIsRefused) {
  const MovingScene scene(all_moves());
  const auto with = [&](const auto& change) {
    RenderSettings settings = open_for_a_frame("auto");
    change(settings);
    return refused([&] { render(*scene, settings); });
  };
  EXPECT_NE(with([](auto& s) {
              s.method.name = "slice-cuts";
            }).find("choose one of brute-force, multidimensional-lightcuts"),
            std::string::npos);
  EXPECT_NE(with([](auto& s) { s.time = 1; }).find("time budget"), std::string::npos);
  EXPECT_NE(with([](auto& s) { s.layers = {"albedo"}; }).find("no layer 'albedo'"), std::string::npos);
  EXPECT_NE(with([](auto& s) { s.traced.compensate = 1, s.lights.clamp = 0.1; }).find("--compensate"),
            std::string::npos);
  EXPECT_NE(with([](auto& s) { s.view.shutter_open = 2; }).find("closes before it opens"), std::string::npos);
  EXPECT_EQ(with([](auto& s) { s.lights.count = 50; }), "");
  const RenderSettings settings = open_for_a_frame("auto");
  EXPECT_NE(refused([&] { prepare(*scene, settings); }).find("one moment"), std::string::npos);
  CompareSettings several;
  several.base = settings;
  const TemporaryFolder folder;
  EXPECT_NE(refused([&] { compare(*scene, several, folder / "out"); }).find("not compared"),
            std::string::npos);
  EXPECT_FALSE(std::filesystem::exists(folder / "out"));
}

}  // namespace
}  // namespace lumirank
