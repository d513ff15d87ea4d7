// What "auto" renders by paths alone: scenes with participating media.
#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <cmath>

#include "base/error.h"
#include "lumirank/lumirank.h"
#include "support/scene_file.h"

namespace lumirank {
namespace {

using test::load_text;
using test::point_camera;

const std::string kGround =
    "<shape type=\"rectangle\"><transform name=\"to_world\"><scale value=\"4\"/><translate z=\"-2\"/>"
    "</transform></shape><emitter type=\"constant\"><rgb name=\"radiance\" value=\"1\"/></emitter>";

// A ball of a medium before a white wall, under a sky that is the same everywhere.
std::string ball(const std::string& albedo, int size) {
  return "<medium type=\"homogeneous\" id=\"smoke\"><rgb name=\"sigma_t\" value=\"2, 1, 0.5\"/>"
         "<rgb name=\"albedo\" value=\"" +
         albedo + "\"/></medium>" + point_camera("0,0,3", "0,0,0", size, 50) + kGround +
         "<shape type=\"sphere\"><bsdf type=\"null\"/><ref name=\"interior\" id=\"smoke\"/></shape>";
}

RenderSettings by_default(int paths) {
  RenderSettings settings;
  settings.denoise = Denoise::off;
  settings.view.spp = paths;
  return settings;
}

TEST(PathRender, IsTheReferenceBeforeADenoiser) {
  const Scene scene = load_text(ball("0.9, 0.8, 0.7", 12));
  const RenderSettings settings = by_default(24);
  const RenderResult ours = render(scene, settings);
  EXPECT_EQ(ours.report.method, "path-tracing");
  EXPECT_EQ(ours.report.notes.at("method.why"), "the scene has participating media");
  EXPECT_EQ(ours.report.numbers.at("spp"), 24);
  EXPECT_EQ(ours.picture.planes[0].rgb, reference(scene, settings, {.spp = 24}).picture.planes[0].rgb);
}

TEST(PathRender, AMediumThatOnlyAbsorbsIsSeen) {
  const auto middle = [](const std::string& text) {
    const Picture picture = render(load_text(text), by_default(16)).picture;
    const std::size_t at =
        3 * static_cast<std::size_t>(picture.width * (picture.height / 2) + picture.width / 2);
    return std::array<float, 3>{picture.planes[0].rgb[at], picture.planes[0].rgb[at + 1],
                                picture.planes[0].rgb[at + 2]};
  };
  const auto through = middle(ball("0, 0, 0", 9));
  const auto before = middle(point_camera("0,0,3", "0,0,0", 9, 50) + kGround);
  // Two radii of extinctions 2, 1 and 1/2, nearly; and the ball's shadow on the wall behind it.
  for (std::size_t c = 0; c < 3; ++c) {
    EXPECT_LT(through[c], std::exp(std::array{-4.0f, -2.0f, -1.0f}[c]) * 1.1f * before[c]);
    EXPECT_GT(through[c], std::exp(std::array{-4.0f, -2.0f, -1.0f}[c]) * 0.5f * before[c]);
  }
}

TEST(PathRender, WhoAsksForTheMatrixGetsIt) {
  const Scene scene = load_text(ball("0.9, 0.8, 0.7", 8));
  RenderSettings settings = by_default(1);
  settings.lights.count = 200;
  EXPECT_EQ(render(scene, settings).report.method, "row-column-sampling");
}

TEST(PathRender, ABudgetsChoicesRepeatTheBits) {
  const Scene scene = load_text(ball("0.9, 0.8, 0.7", 200));
  for (const double seconds : {1e-3, 0.2}) {
    RenderSettings settings;
    settings.denoise = Denoise::off;
    settings.time = seconds;
    std::string warnings;
    Sinks sinks;
    sinks.warning = [&](const std::string& text) { warnings += text; };
    const RenderResult first = render(scene, settings, sinks);
    EXPECT_EQ(first.picture.width, 200);
    if (seconds < 0.01) {
      EXPECT_NE(warnings.find("the budget of 0.001 s is"), std::string::npos) << warnings;  // short, or over
      EXPECT_EQ(first.report.numbers.at("film.rendered_part"), 0.25);
    }
    settings.choices = first.report.choices;
    EXPECT_EQ(render(scene, settings).picture.planes[0].rgb, first.picture.planes[0].rgb);
  }
}

TEST(PathRender, InterruptedItIsThePathsSoFar) {
  const Scene scene = load_text(ball("0.9, 0.8, 0.7", 64));
  RenderSettings settings = by_default(4096);
  std::atomic<bool> cancel = false;
  Sinks sinks;
  sinks.cancel = &cancel;
  sinks.progress = [&](const char* phase, double part) {
    if (std::string(phase) == "paths" && part > 0.01) cancel = true;
  };
  const RenderResult result = render(scene, settings, sinks);
  EXPECT_TRUE(result.interrupted);
  const double paths = result.report.numbers.at("spp");
  EXPECT_GT(paths, 0);
  EXPECT_LT(paths, 4096);
  EXPECT_EQ(result.picture.planes[0].rgb,
            reference(scene, settings, {.spp = static_cast<int>(paths)}).picture.planes[0].rgb);
}

TEST(PathRender, AnErrorAskedForEndsIt) {
  const Scene scene = load_text(ball("0.9, 0.8, 0.7", 16));
  RenderSettings settings;
  settings.denoise = Denoise::off;
  settings.method.target_error = 0.05;
  const RenderResult result = render(scene, settings);
  EXPECT_LT(result.report.numbers.at("error.noise"), 0.05);
  EXPECT_LT(result.report.numbers.at("spp"), 5000);
}

// A floor that sees its only lamp through a ball of glass: columns carry none of the light that is seen.
std::string lamp_in_glass(int size) {
  const std::string at = "<point name=\"center\" x=\"0\" y=\"0\" z=\"1\"/><float name=\"radius\" value=\"";
  return point_camera("0,-2,3", "0,0,0", size, 50) +
         "<shape type=\"rectangle\"><transform name=\"to_world\"><scale value=\"4\"/></transform></shape>"
         "<shape type=\"sphere\">" +
         at +
         "0.2\"/><emitter type=\"area\"><rgb name=\"radiance\" value=\"20\"/></emitter></shape>"
         "<shape type=\"sphere\">" +
         at + "0.5\"/><bsdf type=\"dielectric\"/></shape>";
}

// A ball and the eye, both within a ball of glass under a sky: whatever comes in has passed the glass.
std::string under_glass(int size) {
  return point_camera("0,0,1.6", "0,0,0", size, 40) +
         "<emitter type=\"constant\"/>"
         "<shape type=\"sphere\"><float name=\"radius\" value=\"0.5\"/></shape>"
         "<shape type=\"sphere\"><float name=\"radius\" value=\"2\"/><bsdf type=\"dielectric\"/></shape>";
}

TEST(PathRender, WhereColumnsCarryLittlePathsGoAlone) {
  const Scene scene = load_text(under_glass(24));
  for (const double seconds : {1.0, 0.0}) {
    RenderSettings settings;
    settings.denoise = Denoise::off;
    settings.time = seconds;
    const RenderResult first = render(scene, settings);
    EXPECT_EQ(first.report.method, "path-tracing");
    EXPECT_EQ(first.report.notes.at("method.why"), "columns cannot carry much of its light");
    EXPECT_EQ(first.report.numbers.at("paths.light_paths"), 0);
    const RenderResult again = render(scene, render_settings_from_report(first.report.json()));
    EXPECT_EQ(again.report.method, "path-tracing");
    EXPECT_EQ(first.picture.planes[0].rgb, again.picture.planes[0].rgb);
  }
}

// A budget that is gone before the render begins leaves the least there is, and counts.
TEST(PathRender, WhatWasSpentBeforeCounts) {
  const Scene scene = load_text(under_glass(24));
  RenderSettings settings;
  settings.denoise = Denoise::off;
  settings.time = 1000, settings.time_spent = 2000;
  const RenderResult late = render(scene, settings);
  EXPECT_GE(late.report.seconds.at("total"), 2000);
  EXPECT_LT(late.report.seconds.at("total"), 2900);  // not another thousand
  settings.time_spent = -1;
  EXPECT_THROW(render(scene, settings), InputError);
}

// Lamps in glass are found from there alone, and then passes come first.
TEST(PathRender, WhereLampsAreHiddenPassesComeFirst) {
  const Scene scene = load_text(lamp_in_glass(24));
  RenderSettings settings;
  settings.denoise = Denoise::off;
  settings.time = 1;
  const RenderResult timed = render(scene, settings);
  EXPECT_NE(timed.report.notes.at("method.why"), "columns cannot carry much of its light");
  const RenderResult again = render(scene, render_settings_from_report(timed.report.json()));
  EXPECT_EQ(timed.report.method, again.report.method);
  EXPECT_EQ(timed.picture.planes[0].rgb, again.picture.planes[0].rgb);
}

}  // namespace
}  // namespace lumirank
