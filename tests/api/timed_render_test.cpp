// A render under a time budget: every choice of the clock is in the report, and repeating it gives the bits.
#include <gtest/gtest.h>

#include "api/whole_renders.h"
#include "base/error.h"
#include "lumirank/lumirank.h"
#include "methods/method.h"
#include "pipeline/error_advice.h"
#include "pipeline/layers.h"
#include "pipeline/recipe.h"
#include "support/scene_file.h"

namespace lumirank {
namespace {

using test::load_text;
using test::point_camera;
using test::report_of;

// Something for every stage: a sharp lobe for traced direct light, a mirror for the rest, a lamp.
Scene room() {
  return load_text(
      point_camera("0,0,3.5", "0,-0.3,0", 16, 60) +
      "<shape type=\"cube\"><boolean name=\"flip_normals\" value=\"true\"/><transform name=\"to_world\">"
      "<scale value=\"4\"/></transform></shape>"
      "<shape type=\"sphere\"><point name=\"center\" x=\"-0.8\" y=\"-1\" z=\"0\"/>"
      "<bsdf type=\"roughconductor\"><float name=\"alpha\" value=\"0.05\"/></bsdf></shape>"
      "<shape type=\"sphere\"><point name=\"center\" x=\"1.2\" y=\"-1\" z=\"0\"/>"
      "<bsdf type=\"conductor\"/></shape>"
      "<shape type=\"sphere\"><point name=\"center\" x=\"0\" y=\"3\" z=\"1\"/><float name=\"radius\" "
      "value=\"0.5\"/><emitter type=\"area\"><rgb name=\"radiance\" value=\"9\"/></emitter></shape>");
}

std::vector<std::vector<float>> bits(const RenderResult& result) {
  std::vector<std::vector<float>> planes;
  for (const Plane& p : result.picture.planes) planes.push_back(p.rgb);
  return planes;
}

TEST(TimedRender, EveryStagesChoiceIsRecordedAndRepeatsTheBits) {
  const Scene scene = room();
  struct Budget {
    double seconds;
    int size;
  };
  // With hardly any time, with enough, and with a smaller film.
  for (const auto [seconds, size] : {Budget{0.01, 16}, Budget{0.25, 16}, Budget{0.02, 200}}) {
    RenderSettings s;
    s.method.name = "slice-cuts";
    s.time = seconds;
    s.view.width = size + 1, s.view.height = size;  // no multiple of what a smaller film is divided by
    s.view.max_depth = 4;
    s.traced.rest = RestOfPaths::trace;
    const RenderResult first = render(scene, s);
    const auto report = report_of(first);
    const auto& choices = report["choices"];
    for (const char* what : {"receivers_per_pixel", "lights_asked", "direct_samples", "rest_paths",
                             "film_divisor", "few_columns", "receivers", "virtual_lights"})
      EXPECT_TRUE(choices.contains(what)) << what;
    EXPECT_TRUE(choices.contains("method." + report["method"].get<std::string>()));
    EXPECT_EQ(report.contains("film.rendered_part"), size == 200);
    EXPECT_EQ(report["rest.paths"], choices["rest_paths"][0]);
    EXPECT_EQ(report["traced_direct.samples"], choices["direct_samples"][0]);
    EXPECT_EQ(report["receivers_per_pixel"], choices["receivers_per_pixel"][0]);
    EXPECT_EQ(first.picture.width, size + 1) << "whatever the budget";
    EXPECT_EQ(first.picture.planes[0].rgb.size(), 3u * static_cast<std::size_t>((size + 1) * size));
    for (const int threads : {2}) {
      RenderSettings again = render_settings_from_report(first.report.json());
      again.threads = threads;
      const RenderResult second = render(scene, again);
      EXPECT_EQ(bits(second), bits(first)) << seconds << " s, " << threads << " threads";
      EXPECT_EQ(report_of(second)["choices"], choices) << "a repetition can be repeated";
    }
  }
}

TEST(TimedRender, ABudgetThatIsOverBeforeItBeganGivesAPictureAndSaysSo) {
  std::string said;
  Sinks sinks;
  sinks.warning = [&](const std::string& text) { said += text + "\n"; };
  RenderSettings s;
  s.view.max_depth = 4;
  s.time = 1e-4;  // the pilots alone take longer
  const RenderResult result = render(room(), s, sinks);
  EXPECT_FALSE(result.interrupted);
  // One pass, or one path for each pixel if that is cheaper: the clock decides.
  const auto report = report_of(result);
  EXPECT_EQ(report.value("passes", report.value("spp", 0)), 1) << report;
  EXPECT_NE(said.find("building the scene took"), std::string::npos) << said;
  EXPECT_NE(said.find("would do"), std::string::npos) << said;
  double sum = 0;
  for (const float x : result.picture.planes[0].rgb) sum += x;
  EXPECT_GT(sum, 0);
}

TEST(TimedRender, WhatIsGivenByHandIsNotLowered) {
  RenderSettings s;
  s.view.max_depth = 4;
  s.time = 1e-4;
  set_field(s, "lights", "100000");  // as by default, but asked for
  set_field(s, "spp", "4");
  s.view.width = s.view.height = 2;
  s.lights.count = 3000;
  s.traced.rest = RestOfPaths::skip;
  const auto report = report_of(render(room(), s));
  EXPECT_EQ(report["receivers_per_pixel"], 4);
  EXPECT_EQ(report["virtual_lights.asked"], 3000);
  RenderSettings by_hand;
  set_field(by_hand, "lights", "100000");
  EXPECT_TRUE(by_hand.lights.count.has_value());
  EXPECT_FALSE(render_settings_from_json(to_json(RenderSettings{})).lights.count.has_value())
      << "a report names every setting, asked for or not";
}

TEST(Auto, IsTheMethodThatTheLayersAllow) {
  using pipeline::chosen_method;
  const auto name_of = [](const RenderSettings& s) {
    std::string why;
    const std::string name = chosen_method(s, &why).name;
    EXPECT_NE(why, "");
    return name;
  };
  RenderSettings s;
  EXPECT_EQ(name_of(s), "slice-cuts");
  s.layers = {"albedo", "illuminance"};
  EXPECT_EQ(name_of(s), "slice-cuts");
  for (const char* aov : {"direct", "indirect", "light:*", "light:lamp"}) {
    s.layers = {"albedo", aov};
    EXPECT_EQ(name_of(s), "row-column-sampling") << aov;
  }
  s.layers.clear();
  s.method.parameters = {{"rows", "40"}};
  EXPECT_EQ(name_of(s), "row-column-sampling");
  s.method.parameters = {{"no-such-key", "40"}};
  EXPECT_EQ(name_of(s), "slice-cuts") << "whose make() lists what there is";
  s.method.parameters.clear();
  s.method.name = "power-sampling";
  EXPECT_EQ(name_of(s), "power-sampling");
}

TEST(Layers, AreRefusedBeforeAnythingIsMadeWhereTheMethodCannotGiveThem) {
  const Scene scene = room();
  Sinks sinks;
  int progress = 0;
  sinks.progress = [&](const char*, double) { ++progress; };
  for (const auto& info : methods::all_methods())
    for (const char* aov : {"direct", "indirect", "light:*"}) {
      RenderSettings s;
      s.method.name = info.name;
      s.layers = {aov};
      if (info.contract.combination) {
        EXPECT_NO_THROW(pipeline::check_layers(info, s)) << info.name;
        continue;
      }
      try {
        render(scene, s, sinks);
        ADD_FAILURE() << info.name << " took " << aov;
      } catch (const InputError& e) {
        const std::string text = e.what();
        for (const auto& other : methods::all_methods())
          if (other.contract.combination) {
            EXPECT_NE(text.find(other.name), std::string::npos) << text;
          }
      }
    }
  EXPECT_EQ(progress, 0);
}

TEST(BudgetAdvice, NamesWhatIsCoarseAndTheTimeThatWouldDo) {
  using pipeline::budget_advice;
  EXPECT_EQ(budget_advice(5, 3, 0, {}), "");
  EXPECT_EQ(budget_advice(5, 3, 0, {{"budget.coarse_share", 0.0}, {"budget.seconds_wanted", 2.0}}), "");
  const std::string text =
      budget_advice(5, 3, 0, {{"budget.coarse_share", 0.4}, {"budget.seconds_wanted", 10.0}});
  EXPECT_NE(text.find("40 %"), std::string::npos) << text;
  EXPECT_NE(text.find("12 s would do"), std::string::npos) << text;
  const std::string all =
      budget_advice(3, 2, 20, {{"budget.coarse_share", 1.0}, {"budget.seconds_wanted", 4.0}});
  EXPECT_NE(all.find("in all of the picture"), std::string::npos) << all;
  EXPECT_NE(all.find("20 s would do"), std::string::npos) << "the whole plan's time: " << all;
}

}  // namespace
}  // namespace lumirank
