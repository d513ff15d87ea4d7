// Shots of smoke that moves, by clusters of light rays that are the same in every frame.
#include <gtest/gtest.h>

#include <cstdint>
#include <fstream>
#include <functional>

#include "image/image_io.h"
#include "lumirank/animate.h"
#include "support/refused.h"
#include "support/scene_file.h"
#include "support/statistics.h"

namespace lumirank {
namespace {

using test::mean_of;
using test::normal_quantile;
using test::point_camera;
using test::refused;
using test::TemporaryFolder;

constexpr int kSide = 8;

// A Mitsuba grid of 6³ numbers.
void write_grid(const std::string& file, const std::function<float(int x, int y, int z)>& density) {
  std::ofstream out(file, std::ios::binary);
  const auto put = [&](const auto& number) { out.write(reinterpret_cast<const char*>(&number), 4); };
  out.write("VOL\3", 4);
  for (const std::int32_t n : {1, 6, 6, 6, 1}) put(n);
  for (const float bound : {-0.5f, -0.5f, -0.5f, 0.5f, 0.5f, 0.5f}) put(bound);
  for (int z = 0; z < 6; ++z)
    for (int y = 0; y < 6; ++y)
      for (int x = 0; x < 6; ++x) put(density(x, y, z));
}

// A block of smoke in a room with a lamp in its ceiling; three frames.
Scene smoky_room(const TemporaryFolder& folder, bool moves, const std::string& what_else = "") {
  for (int frame = 0; frame < 3; ++frame)
    write_grid(folder / ("smoke.000" + std::to_string(frame) + ".vol"), [&](int x, int y, int z) {
      const int at = moves ? x + 2 * frame : x;
      return at % 3 == 0 ? 0.0f : 0.3f + 0.2f * static_cast<float>((at + y + z) % 4);
    });
  const auto wall = [](const std::string& turned, const std::string& color) {
    return "<shape type=\"rectangle\"><transform name=\"to_world\"><translate z=\"1\"/>" + turned +
           "</transform><bsdf type=\"twosided\"><bsdf type=\"diffuse\"><rgb name=\"reflectance\" value=\"" +
           color + "\"/></bsdf></bsdf></shape>";
  };
  std::ofstream(folder / "scene.xml")
      << "<scene version=\"3.0.0\"><medium type=\"heterogeneous\" id=\"smoke\"><volume type=\"gridvolume\" "
         "name=\"sigma_t\"><string name=\"filename\" value=\"smoke.####.vol\"/><boolean "
         "name=\"use_grid_bbox\" value=\"true\"/></volume><volume type=\"constvolume\" name=\"albedo\"><rgb "
         "name=\"value\" value=\"0.9, 0.8, 0.7\"/></volume><float name=\"scale\" value=\"5\"/><phase "
         "type=\"hg\"><float name=\"g\" value=\"0.3\"/></phase></medium>"
      << point_camera("0,0.1,-0.9", "0,0,1", kSide, 70) << wall("", "0.7, 0.7, 0.7")
      << wall("<rotate y=\"1\" angle=\"90\"/>", "0.7, 0.2, 0.2")
      << wall("<rotate x=\"1\" angle=\"90\"/>", "0.6, 0.6, 0.6")
      << wall("<rotate y=\"1\" angle=\"180\"/>", "0.5, 0.5, 0.5")
      << "<shape type=\"rectangle\"><transform name=\"to_world\"><scale value=\"0.4\"/><rotate x=\"1\" "
         "angle=\"90\"/><translate y=\"0.98\"/></transform><bsdf type=\"diffuse\"/><emitter "
         "type=\"area\"><rgb "
         "name=\"radiance\" value=\"8, 7, 5\"/></emitter></shape>"
         "<shape type=\"cube\"><transform name=\"to_world\"><scale value=\"0.5\"/></transform><bsdf "
         "type=\"null\"/><ref name=\"interior\" id=\"smoke\"/></shape>"
      << what_else << "</scene>";
  return Scene::load(folder / "scene.xml");
}

AnimateSettings clustered(std::uint64_t lights, int columns) {
  AnimateSettings settings;
  settings.render.lights.count = lights;
  settings.render.lights.clamp = 0;
  settings.render.view.spp = 4;
  settings.render.view.max_depth = 5;
  settings.endings = {".pfm"};
  settings.tensor = TensorSettings{.overlap = 0, .rows = 16, .columns = columns};
  return settings;
}

std::vector<std::vector<Rgb>> frames_of(const Scene& scene, const AnimateSettings& settings) {
  const TemporaryFolder out;
  animate(scene, settings, out / "shot");
  std::vector<std::vector<Rgb>> frames;
  for (int k = 0; k < 3; ++k)
    frames.push_back(image::read_image(out / ("shot/frame_000" + std::to_string(k) + ".pfm")).color.pixels);
  return frames;
}

double mean_light(const std::vector<Rgb>& pixels, int half) {
  double sum = 0;
  for (int y = 0; y < kSide; ++y)
    for (int x = 0; x < kSide / 2; ++x)
      sum += static_cast<double>(mean(pixels[static_cast<std::size_t>(kSide * y + x + half * kSide / 2)]));
  return sum / (kSide * kSide / 2);
}

// All columns, over seeds: the mean over each half of every frame's picture.
TEST(MovingSmoke, EveryFrameAgreesWithThePathTracer) {
  const TemporaryFolder folder;
  const Scene scene = smoky_room(folder, true);
  AnimateSettings settings = clustered(250, 0);
  std::vector<std::vector<double>> ours(6), truth(6);
  for (std::uint64_t seed = 1; seed <= 24; ++seed) {
    settings.render.seed = seed;
    const auto frames = frames_of(scene, settings);
    for (std::size_t k = 0; k < 6; ++k) ours[k].push_back(mean_light(frames[k / 2], static_cast<int>(k % 2)));
  }
  ReferenceSettings how;
  how.spp = 256;
  for (std::size_t frame = 0; frame < 3; ++frame) {
    const Scene now = scene.at(static_cast<double>(frame) / 24);
    for (std::uint64_t seed = 1; seed <= 8; ++seed) {
      RenderSettings at = settings.render;
      at.seed = 100 + seed;
      const Picture picture = reference(now, at, how).picture;
      std::vector<Rgb> pixels;
      for (std::size_t i = 0; i < kSide * kSide; ++i)
        pixels.push_back({picture.planes[0].rgb[3 * i], picture.planes[0].rgb[3 * i + 1],
                          picture.planes[0].rgb[3 * i + 2]});
      for (std::size_t half = 0; half < 2; ++half)
        truth[2 * frame + half].push_back(mean_light(pixels, static_cast<int>(half)));
    }
  }
  for (std::size_t k = 0; k < 6; ++k) {
    const auto a = mean_of(ours[k]), b = mean_of(truth[k]);
    EXPECT_NEAR(a.mean, b.mean,
                normal_quantile(1e-4, 6) * std::hypot(a.standard_error, b.standard_error) + 2e-3 * b.mean)
        << "frame " << k / 2 << ", half " << k % 2;
    EXPECT_LT(a.standard_error, 0.04 * b.mean) << "the test can tell";
  }
  // Frames differ by more than they err.
  EXPECT_GT(std::abs(mean_of(truth[0]).mean - mean_of(truth[2]).mean), 0.01 * mean_of(truth[0]).mean);
}

TEST(MovingSmoke, ClustersApproachAllColumns) {
  const TemporaryFolder folder;
  const Scene scene = smoky_room(folder, true);
  const auto all = frames_of(scene, clustered(400, 0));
  double before = 1;
  for (const int columns : {20, 80, 320}) {
    const auto some = frames_of(scene, clustered(400, columns));
    double off = 0, light = 0;
    for (std::size_t k = 0; k < 3; ++k)
      for (std::size_t i = 0; i < all[k].size(); ++i)
        for (int c = 0; c < 3; ++c)
          off += std::abs(static_cast<double>(some[k][i][c] - all[k][i][c])),
              light += static_cast<double>(all[k][i][c]);
    EXPECT_LT(off / light, before) << columns;
    before = off / light;
  }
  EXPECT_LT(before, 0.05);
}

TEST(MovingSmoke, StandsStillWhereNothingMoves) {
  const TemporaryFolder folder;
  const auto frames = frames_of(smoky_room(folder, false), clustered(400, 30));
  for (std::size_t k = 1; k < 3; ++k) EXPECT_EQ(frames[k], frames[0]);
}

TEST(MovingSmoke, SaysWhatItCannotDo) {
  const auto why = [](const std::string& what_else, const std::function<void(AnimateSettings&)>& change) {
    const TemporaryFolder folder;
    AnimateSettings settings = clustered(100, 10);
    change(settings);
    return refused([&] { frames_of(smoky_room(folder, true, what_else), settings); });
  };
  EXPECT_NE(why("<shape type=\"sphere\"><animation name=\"to_world\"><transform time=\"0\"><scale "
                "value=\"0.1\"/></transform><transform time=\"0.0833333\"><scale value=\"0.2\"/></transform>"
                "</animation></shape>",
                [](AnimateSettings&) {})
                .find("stand still"),
            std::string::npos);
  EXPECT_NE(why("", [](AnimateSettings& s) { s.render.method.target_error = 0.1; }).find("--error"),
            std::string::npos);
  EXPECT_NE(
      why("", [](AnimateSettings& s) { s.render.lights.type = LightType::sphere; }).find("points and rays"),
      std::string::npos);
}

}  // namespace
}  // namespace lumirank
