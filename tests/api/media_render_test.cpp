// Pictures of participating media by columns, against the volume path tracer.
#include <gtest/gtest.h>

#include "lumirank/compare.h"
#include "lumirank/lumirank.h"
#include "support/scene_file.h"
#include "support/statistics.h"

namespace lumirank {
namespace {

using test::load_text;
using test::mean_of;
using test::normal_quantile;
using test::point_camera;

// A room of 2×2×2 with a lamp in its ceiling, filled with fog (the camera is in it), or with a ball of smoke.
std::string room(const std::string& medium, bool fills) {
  const auto wall = [&](const std::string& transform, const std::string& color) {
    return "<shape type=\"rectangle\"><transform name=\"to_world\">" + transform +
           "</transform><bsdf type=\"twosided\"><bsdf type=\"diffuse\"><rgb name=\"reflectance\" value=\"" +
           color + "\"/></bsdf></bsdf></shape>";
  };
  std::string scene = medium;
  std::string camera = point_camera("0,0.1,-0.9", "0,0,1", 8, 70);
  if (fills) camera.insert(camera.find("<film"), "<ref id=\"fog\"/>");
  scene += camera;
  scene += wall("<translate z=\"1\"/>", "0.7, 0.7, 0.7");
  scene += wall("<translate z=\"1\"/><rotate y=\"1\" angle=\"90\"/>", "0.7, 0.2, 0.2");
  scene += wall("<translate z=\"1\"/><rotate y=\"1\" angle=\"-90\"/>", "0.2, 0.7, 0.2");
  scene += wall("<translate z=\"1\"/><rotate x=\"1\" angle=\"90\"/>", "0.6, 0.6, 0.6");
  scene += wall("<translate z=\"1\"/><rotate x=\"1\" angle=\"-90\"/>", "0.6, 0.6, 0.6");
  scene += wall("<translate z=\"1\"/><rotate y=\"1\" angle=\"180\"/>", "0.5, 0.5, 0.5");
  scene +=
      "<shape type=\"rectangle\"><transform name=\"to_world\"><scale value=\"0.4\"/><rotate x=\"1\" "
      "angle=\"90\"/>"
      "<translate y=\"0.98\"/></transform><bsdf type=\"diffuse\"/><emitter type=\"area\">"
      "<rgb name=\"radiance\" value=\"8, 7, 5\"/></emitter></shape>";
  if (!fills)
    scene +=
        "<shape type=\"sphere\"><float name=\"radius\" value=\"0.5\"/><bsdf type=\"null\"/>"
        "<ref name=\"interior\" id=\"fog\"/></shape>";
  return scene;
}

std::string fog(const std::string& sigma_t, double g) {
  return "<medium type=\"homogeneous\" id=\"fog\"><rgb name=\"sigma_t\" value=\"" + sigma_t +
         "\"/><rgb name=\"albedo\" value=\"0.9, 0.8, 0.7\"/><phase type=\"hg\"><float name=\"g\" value=\"" +
         std::to_string(g) + "\"/></phase></medium>";
}

std::vector<double> values_of(const Picture& picture) {
  return {picture.planes[0].rgb.begin(), picture.planes[0].rgb.end()};
}

// All columns, means over seeds, agree with the path tracer, in the mean over each of four blocks of the
// picture.
void expect_agreement(const std::string& text, LightPart only, const char* what,
                      const MethodSettings& method = {.name = "brute-force"}) {
  const Scene scene = load_text(text);
  RenderSettings settings;
  settings.view.only = only;
  settings.view.spp = 4;
  settings.view.max_depth = 5;
  settings.method = method;
  settings.lights.count = 300;
  settings.lights.clamp = 0;
  constexpr int kSeeds = 24;
  std::vector<std::vector<double>> ours;
  for (int seed = 1; seed <= kSeeds; ++seed) {
    settings.seed = static_cast<std::uint64_t>(seed);
    ours.push_back(values_of(render(scene, settings).picture));
  }
  ReferenceSettings how;
  how.spp = 512;
  std::vector<std::vector<double>> truth;
  for (int seed = 1; seed <= 8; ++seed) {
    settings.seed = static_cast<std::uint64_t>(100 + seed);
    truth.push_back(values_of(reference(scene, settings, how).picture));
  }
  for (int block = 0; block < 4; ++block) {
    const auto mean_in_block = [&](const std::vector<double>& picture) {
      double sum = 0;
      for (int y = 0; y < 4; ++y)
        for (int x = 0; x < 4; ++x)
          for (int c = 0; c < 3; ++c)
            sum += picture[static_cast<std::size_t>(3 * ((y + block / 2 * 4) * 8 + x + block % 2 * 4) + c)];
      return sum / 48;
    };
    std::vector<double> a, b;
    for (const auto& picture : ours) a.push_back(mean_in_block(picture));
    for (const auto& picture : truth) b.push_back(mean_in_block(picture));
    const auto of_ours = mean_of(a), of_truth = mean_of(b);
    EXPECT_NEAR(of_ours.mean, of_truth.mean,
                normal_quantile(1e-4, 20) * std::hypot(of_ours.standard_error, of_truth.standard_error))
        << what << ", block " << block;
    // The test can tell: a tenth more would be seen.
    EXPECT_LT(of_ours.standard_error, 0.05 * of_truth.mean) << what;
  }
}

TEST(MediaRender, FogAgreesWithThePathTracer) {
  expect_agreement(room(fog("0.5, 0.6, 0.8", 0), true), LightPart::direct, "direct light in fog");
  expect_agreement(room(fog("0.5, 0.6, 0.8", 0), true), LightPart::indirect, "indirect light in fog");
}

TEST(MediaRender, ABallOfSmokeAgreesWithThePathTracer) {
  expect_agreement(room(fog("1.5, 2, 3", 0.4), false), LightPart::all, "a ball of smoke");
}

// What every eye ray sums over is all pieces of light rays then, so this is about the pieces.
TEST(MediaRender, PiecesOfLightRaysAgreeWithThePathTracer) {
  const MethodSettings all{.name = "scalable-virtual-ray-lights",
                           .parameters = {{"error-bound", "0"}, {"max-nodes", "100000"}}};
  expect_agreement(room(fog("1.5, 2, 3", 0.4), false), LightPart::indirect, "pieces of light rays", all);
}

// By bounds, each in its own way: with all nodes they sum the same entries.
TEST(MediaRender, CutsEndInTheSameSums) {
  const Scene scene = load_text(room(fog("0.5, 0.6, 0.8", 0.3), true));
  RenderSettings settings;
  settings.view.spp = 1;
  settings.lights.count = 200;
  const auto sums = [&](const MethodSettings& method) {
    settings.method = method;
    return values_of(render(scene, settings).picture);
  };
  const auto all = sums(
      {.name = "scalable-virtual-ray-lights", .parameters = {{"error-bound", "0"}, {"max-nodes", "100000"}}});
  const auto expect_same = [&](const MethodSettings& method) {
    const auto other = sums(method);
    for (std::size_t k = 0; k < all.size(); ++k)
      ASSERT_NEAR(other[k], all[k], 1e-4 * all[k] + 1e-7) << method.name << ' ' << k;
  };
  expect_same({.name = "lightcuts",
               .parameters = {{"error-bound", "0"}, {"max-nodes", "100000"}, {"reconstruction", "off"}}});
  expect_same(
      {.name = "multidimensional-lightcuts", .parameters = {{"error-bound", "0"}, {"max-pairs", "1000000"}}});
  expect_same({.name = "slice-cuts",
               .parameters = {{"alpha", "0"}, {"initial-columns", "100000"}, {"max-columns", "100000"}}});
}

TEST(MediaRender, RowsAndColumnsConvergeToAllColumns) {
  const Scene scene = load_text(room(fog("0.5, 0.6, 0.8", 0), true));
  RenderSettings settings;
  settings.view.spp = 1;
  settings.lights.count = 400;
  settings.method.name = "brute-force";
  const auto all = values_of(render(scene, settings).picture);
  const auto error = [&](int columns) {
    settings.method.name = "row-column-sampling";
    settings.method.parameters = {{"rows", "100"}, {"columns", std::to_string(columns)}};
    const auto some = values_of(render(scene, settings).picture);
    double difference = 0, sum = 0;
    for (std::size_t k = 0; k < all.size(); ++k) difference += std::abs(all[k] - some[k]), sum += all[k];
    return difference / sum;
  };
  const double few = error(40), many = error(300);
  EXPECT_LT(many, 0.6 * few);
  EXPECT_LT(many, 0.05);
}

// In media each method against all columns, at all rows of some pixels and at all rows.
TEST(MediaRender, MethodsAreCompared) {
  const test::TemporaryFolder folder;
  const Scene scene = load_text(room(fog("0.5, 0.6, 0.8", 0.3), true));
  CompareSettings settings;
  settings.base.view.spp = 1;
  settings.base.lights.count = 300;
  settings.methods = {"row-column-sampling", "lightcuts", "virtual-ray-lights", "brute-force"};
  settings.reference = {ComparisonReference::Kind::receivers, 60, 64, ""};
  const Comparison sampled = compare(scene, settings, folder / "sampled");
  ASSERT_EQ(sampled.runs.size(), 4u);
  for (const ComparisonRun& run : sampled.runs) EXPECT_LT(run.error.relative_l1, 0.4) << run.method;
  EXPECT_LT(sampled.runs[3].error.relative_l1, 1e-5);
  settings.reference = {ComparisonReference::Kind::brute_force, 60, 0, ""};
  settings.methods = {"brute-force"};
  const Comparison whole = compare(scene, settings, folder / "whole");
  EXPECT_LT(whole.runs.at(0).error.relative_l1, 1e-6);
  // Rows are eye segments as well as the 64 receivers.
  EXPECT_GT(whole.runs[0].entries / 300, 1.5 * 64);
}

TEST(MediaRender, SaysWhatItCannotDo) {
  const Scene scene = load_text(room(fog("0.5, 0.6, 0.8", 0), true));
  const auto refused = [&](auto&& change) {
    RenderSettings settings;
    settings.view.width = settings.view.height = 4;
    settings.lights.count = 50;
    change(settings);
    EXPECT_THROW(render(scene, settings), InputError);
  };
  refused([](RenderSettings& s) { s.layers = {"direct"}; });
  refused([](RenderSettings& s) { s.traced.compensate = 4; });
  refused([](RenderSettings& s) { s.lights.type = LightType::sphere; });
  EXPECT_THROW(reference(scene, {}, {.spp = 1, .paths = ReferencePaths::rest}), InputError);
}

}  // namespace
}  // namespace lumirank
