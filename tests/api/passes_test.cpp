// Renders in passes: bits, repetition, what they refuse, and that their mean is the truth's.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "base/error.h"
#include "lumirank/lumirank.h"

namespace lumirank {
namespace {

Scene example_box() { return Scene::load(std::string(LUMIRANK_EXAMPLES) + "/box.xml"); }

RenderSettings few_passes(int passes) {
  RenderSettings s;
  s.view.width = 24, s.view.height = 18;
  s.lights.count = 1000;
  s.passes = passes;
  s.denoise = Denoise::off;
  return s;
}

nlohmann::json said(const RenderResult& result) { return nlohmann::json::parse(result.report.json()); }

double mean_of(const Picture& picture) {
  double sum = 0;
  for (const float v : picture.planes[0].rgb) sum += static_cast<double>(v);
  return sum / static_cast<double>(picture.planes[0].rgb.size());
}

TEST(Passes, TheSameBitsOnOneAndTwoThreads) {
  const Scene scene = example_box();
  RenderSettings s = few_passes(3);
  s.threads = 1;
  const RenderResult one = render(scene, s);
  s.threads = 2;
  EXPECT_EQ(one.picture.planes[0].rgb, render(scene, s).picture.planes[0].rgb);
  const auto report = said(one);
  EXPECT_EQ(report["method"], "row-guided-sampling");
  EXPECT_EQ(report["passes"], 3);
  EXPECT_GT(report["error.noise"], 0);
}

TEST(Passes, ABudgetIsRepeatedBitByBit) {
  const Scene scene = example_box();
  RenderSettings s = few_passes(0);
  s.time = 0.4;
  const RenderResult first = render(scene, s);
  EXPECT_GE(said(first)["passes"], 1);
  const RenderSettings again = render_settings_from_report(first.report.json());
  EXPECT_EQ(first.picture.planes[0].rgb, render(scene, again).picture.planes[0].rgb);
}

TEST(Passes, OtherMethodsHaveThemToo) {
  RenderSettings s = few_passes(2);
  s.method.name = "slice-cuts";
  const auto report = said(render(example_box(), s));
  EXPECT_EQ(report["method"], "slice-cuts");
  EXPECT_EQ(report["passes"], 2);
}

TEST(Passes, StopWhereTheNoiseIsAsAsked) {
  RenderSettings s = few_passes(0);
  s.method.target_error = 0.1;
  const auto report = said(render(example_box(), s));
  EXPECT_LT(report["error.noise"], 0.1);
  EXPECT_GE(report["passes"], 4);
}

// Without clamping nothing of the light is lost: the mean over pixels, whose noise is a hundredth, is the
// path tracer's.
TEST(Passes, HaveTheWholeLight) {
  const Scene scene = example_box();
  RenderSettings s = few_passes(64);
  s.lights.clamp = 0;
  s.traced.rest = RestOfPaths::trace;
  const double ours = mean_of(render(scene, s).picture);
  ReferenceSettings how;
  how.spp = 1024;
  const double truth = mean_of(reference(scene, s, how).picture);
  EXPECT_NEAR(ours, truth, 0.03 * truth);
}

TEST(Passes, RefuseWhatIsOfOnePassAlone) {
  RenderSettings s = few_passes(2);
  s.layers = {"albedo"};
  EXPECT_THROW(render(example_box(), s), InputError);
  s = few_passes(2);
  s.view.shutter_close = 0.5;
  EXPECT_THROW(render(example_box(), s), InputError);
}

}  // namespace
}  // namespace lumirank
