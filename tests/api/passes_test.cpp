// Renders in passes: bits, repetition, what they refuse, and that their mean is the truth's.
#include <gtest/gtest.h>

#include "api/whole_renders.h"
#include "base/error.h"
#include "lumirank/lumirank.h"
#include "support/scene_file.h"

namespace lumirank {
namespace {

using test::box;
using test::mean_value;
using test::report_of;

RenderSettings few_passes(int passes) {
  RenderSettings s;
  s.view.width = 24, s.view.height = 18;
  s.lights.count = 1000;
  s.passes = passes;
  s.denoise = Denoise::off;
  return s;
}

TEST(Passes, TheSameBitsOnOneAndTwoThreads) {
  const Scene scene = box();
  RenderSettings s = few_passes(3);
  s.threads = 1;
  const RenderResult one = render(scene, s);
  s.threads = 2;
  EXPECT_EQ(one.picture.planes[0].rgb, render(scene, s).picture.planes[0].rgb);
  const auto report = report_of(one);
  EXPECT_EQ(report["method"], "row-guided-sampling");
  EXPECT_EQ(report["passes"], 3);
  EXPECT_GT(report["error.noise"], 0);
}

TEST(Passes, ABudgetIsRepeatedBitByBit) {
  const Scene scene = box();
  RenderSettings s = few_passes(0);
  s.time = 0.4;
  const RenderResult first = render(scene, s);
  EXPECT_GE(report_of(first)["passes"], 1);
  const RenderSettings again = render_settings_from_report(first.report.json());
  EXPECT_EQ(first.picture.planes[0].rgb, render(scene, again).picture.planes[0].rgb);
}

// A window of the film, for which a small one is tried out under a budget.
TEST(Passes, ShowAWindowOfTheFilm) {
  RenderSettings s = few_passes(3);
  s.view.width = 64, s.view.height = 48;
  s.view.crop = {30, 21, 17, 13};
  const RenderResult window = render(box(), s);
  EXPECT_EQ(window.picture.width, 17);
  EXPECT_EQ(window.picture.height, 13);
  const double usual = mean_value(window.picture);
  EXPECT_GT(usual, 0);
  s.passes = 0, s.time = 0.4;
  EXPECT_NEAR(mean_value(render(box(), s).picture), usual, 0.1 * usual);
}

// Which of both goes on, and after how many passes, is the clock's choice; here it is written down by hand.
TEST(Passes, PathsThatGoOnAreThePicture) {
  const Scene scene = box();
  RenderSettings s;
  s.view.width = 24, s.view.height = 18;
  s.denoise = Denoise::off;
  s.time = 0.8;
  s.traced.rest = RestOfPaths::skip;
  RenderSettings truth;
  truth.view = s.view;
  truth.seed = 5;
  const double expected = mean_value(reference(scene, truth, {.spp = 256}).picture);
  struct Case {
    std::int64_t own_emission, share_of_passes, passes;
  };
  for (const auto& [own_emission, share_of_passes, passes] :
       {Case{0, 0, 2}, Case{1, 0, 2}, Case{0, 400, 2}, Case{1, 400, 3}}) {
    SCOPED_TRACE(testing::Message() << own_emission << ", " << share_of_passes);
    s.choices = {{"film_divisor", {1}},
                 {"interleaved", {1}},
                 {"eighths_of_pass", std::vector<std::int64_t>(static_cast<std::size_t>(passes), 8)},
                 {"passes", {passes}},
                 {"passes_before_paths", {passes}},
                 {"trial_paths", {2}},
                 {"beside_half_light_paths", {0}},
                 {"beside_aim", {0}},
                 {"by_paths", {1}},
                 {"own_emission", {own_emission}},
                 {"more_paths", {126}},
                 {"share_of_passes", {share_of_passes}}};
    const RenderResult result = render(scene, s);
    EXPECT_EQ(report_of(result)["method"], "path-tracing");
    EXPECT_EQ(report_of(result)["paths"], 128);
    EXPECT_EQ(report_of(result)["choices"]["by_paths"][0], 1);
    EXPECT_EQ(report_of(result)["passes"], passes);
    EXPECT_FLOAT_EQ(report_of(result)["share_of_passes"].get<float>(),
                    static_cast<float>(share_of_passes) / 1000);
    EXPECT_NEAR(mean_value(result.picture), expected, 0.03 * expected);
    const RenderSettings again = render_settings_from_report(result.report.json());
    EXPECT_EQ(result.picture.planes[0].rgb, render(scene, again).picture.planes[0].rgb);
  }
}

TEST(Passes, OtherMethodsHaveThemToo) {
  RenderSettings s = few_passes(2);
  s.method.name = "slice-cuts";
  const auto report = report_of(render(box(), s));
  EXPECT_EQ(report["method"], "slice-cuts");
  EXPECT_EQ(report["passes"], 2);
}

TEST(Passes, StopWhereTheNoiseIsAsAsked) {
  RenderSettings s = few_passes(0);
  s.method.target_error = 0.1;
  const auto report = report_of(render(box(), s));
  EXPECT_LT(report["error.noise"], 0.1);
  EXPECT_GE(report["passes"], 4);
}

TEST(Passes, StopByAnotherMetric) {
  RenderSettings s = few_passes(0);
  s.method.target_error = 0.05;
  s.method.error_metric = ErrorMetric::relmse;
  const auto report = report_of(render(box(), s));
  EXPECT_LT(report["error.estimate"], 0.05);
  EXPECT_NE(report["error.of"].get<std::string>().find("relMSE"), std::string::npos);
  s.method.name = "slice-cuts";
  s.passes = 0;
  EXPECT_THROW(render(box(), s), InputError);
}

// Without clamping nothing of the light is lost: the mean over pixels, whose noise is a hundredth, is the
// path tracer's.
TEST(Passes, HaveTheWholeLight) {
  const Scene scene = box();
  RenderSettings s = few_passes(64);
  s.lights.clamp = 0;
  s.traced.rest = RestOfPaths::trace;
  const double ours = mean_value(render(scene, s).picture);
  ReferenceSettings how;
  how.spp = 1024;
  const double truth = mean_value(reference(scene, s, how).picture);
  EXPECT_NEAR(ours, truth, 0.03 * truth);
}

// A room behind glass: what comes straight through panes is what the interfaces let through, to some tenths
// of a percent of the light.
TEST(Passes, LightComesThroughPanes) {
  const auto slab = [](const char* transform, const char* bsdf) {
    return std::string("<shape type=\"cube\"><transform name=\"to_world\">") + transform + "</transform>" +
           bsdf + "</shape>";
  };
  const char* matt =
      "<bsdf type=\"twosided\"><bsdf type=\"diffuse\"><rgb name=\"reflectance\" value=\"0.5, 0.5, "
      "0.5\"/></bsdf></bsdf>";
  const Scene scene =
      test::load_text(test::point_camera("0,1,1.5", "0,0,-0.2", 12, 40) +
                      slab("<scale x=\"2\" y=\"0.1\" z=\"2\"/><translate y=\"-0.1\"/>", matt) +
                      slab("<scale x=\"0.1\" y=\"2\" z=\"2\"/><translate x=\"-1.5\"/>", matt) +
                      slab("<scale x=\"2\" y=\"0.01\" z=\"2\"/><translate y=\"1.8\"/>",
                           "<bsdf type=\"dielectric\"><float name=\"int_ior\" value=\"1.5\"/></bsdf>") +
                      "<emitter type=\"constant\"><rgb name=\"radiance\" value=\"1, 1, 1\"/></emitter>");
  RenderSettings s;
  s.lights.count = 1000;
  s.passes = 64;
  s.denoise = Denoise::off;
  s.traced.rest = RestOfPaths::trace;
  ReferenceSettings how;
  how.spp = 2048;
  const double truth = mean_value(reference(scene, s, how).picture);
  const RenderResult straight = render(scene, s);
  EXPECT_EQ(report_of(straight)["panes.straight"], 1);
  EXPECT_NEAR(mean_value(straight.picture), truth, 0.015 * truth);
  s.traced.panes = Panes::exact;
  EXPECT_EQ(report_of(render(scene, s))["panes.straight"], 0);
}

TEST(Passes, RefuseWhatIsOfOnePassAlone) {
  RenderSettings s = few_passes(2);
  s.layers = {"albedo"};
  EXPECT_THROW(render(box(), s), InputError);
  s = few_passes(2);
  s.view.shutter_close = 0.5;
  EXPECT_THROW(render(box(), s), InputError);
}

}  // namespace
}  // namespace lumirank
