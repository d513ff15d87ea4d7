// The error that a render states of itself.
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "api/scene.h"
#include "api/whole_renders.h"
#include "lumirank/lumirank.h"
#include "methods/common/column_pass.h"
#include "methods/common/exact_rows.h"
#include "pipeline/error_advice.h"
#include "pipeline/prepared.h"
#include "support/scene_file.h"
#include "support/statistics.h"

namespace lumirank {
namespace {

using nlohmann::json;
using test::box;
using test::kAlpha;
using test::mean_of;
using test::student_quantile;

std::vector<Rgb> sums_of(const matrix::LightingMatrix& matrix) {
  std::vector<matrix::ScaledColumn> columns;
  for (std::size_t j = 0; j < matrix.columns(); ++j)
    columns.push_back({static_cast<matrix::Index>(j), Rgb(1)});
  std::vector<Rgb> sums(matrix.rows());
  const methods::RunOptions options;
  const methods::RunClock clock(options);
  methods::render_columns(matrix, columns, {options, clock, 0, {}}, sums);
  return sums;
}

// The same receivers see many sets of lights. What infinitely many would give, clamped as these are, is the
// mean over all other sets, 299,000 lights: its own error adds 1/299 of theirs in quadrature. Clamping bounds
// the spikes of 1/d², whose variance is infinite; what it takes is known at every row.
TEST(StatedError, PartsAreThoseOfTheTrueError) {
  const Scene scene = box();
  RenderSettings settings;
  settings.traced.rest = RestOfPaths::skip;
  settings.view.width = settings.view.height = 64;
  settings.view.crop[0] = 26, settings.view.crop[1] = 12, settings.view.crop[2] = 12,
  settings.view.crop[3] = 8;
  settings.view.spp = 1;
  settings.traced.direct = DirectLight::matrix;
  std::vector<scenedesc::Warning> warnings;
  const world::World world = world::World::build(scene.impl().desc, {}, warnings);
  const world::View view = pipeline::make_view(scene.impl().desc, settings.view);
  const auto receivers = pipeline::trace_rows(world, view, pipeline::make_recipe(settings, view), {});
  // Not aimed at the receivers: learning where to aim takes longer than tracing.
  const auto lights_of = [&](std::uint64_t seed, std::size_t count) {
    transport::LightSettings ls;
    ls.seed = seed, ls.count = count, ls.max_depth = view.max_depth;
    return transport::trace_virtual_lights(world, ls);
  };
  const auto matrix_of = [&](const transport::VirtualLights& lights, float clamp) {
    transport::SceneMatrixSettings ms;
    ms.clamp = clamp, ms.max_depth = view.max_depth;
    return transport::SceneMatrix(world, *receivers, lights, ms);
  };
  const auto sum = [](std::span<const Rgb> values) {
    double s = 0;
    for (const Rgb& v : values) s += static_cast<double>(v.r) + v.g + v.b;
    return s;
  };
  constexpr std::size_t kSeeds = 300;
  std::vector<std::vector<Rgb>> sums;
  std::vector<Rgb> all_sums(receivers->size());
  std::vector<double> stated;
  for (std::size_t seed = 0; seed < kSeeds; ++seed) {
    const transport::VirtualLights lights = lights_of(100 + seed, 1000);
    const auto matrix = matrix_of(lights, 0.03f);
    const auto rows = methods::read_rows(matrix, matrix.rows(), 1);
    ASSERT_EQ(rows.size(), all_sums.size());
    sums.push_back(sums_of(matrix));
    for (std::size_t i = 0; i < all_sums.size(); ++i) all_sums[i] += sums.back()[i];
    const double clamping = rows.clamping().value;
    // Relative to the unclamped sum; the comparison below is to the clamped one.
    stated.push_back(rows.lights().value / (1 - clamping));

    const double whole = sum(sums_of(matrix_of(lights, 0)));
    EXPECT_NEAR(clamping, 1 - sum(sums.back()) / whole, 1e-4);  // rounding of single precision
  }
  std::vector<double> difference;
  for (std::size_t seed = 0; seed < kSeeds; ++seed) {
    std::vector<Rgb> others(all_sums.size());
    for (std::size_t i = 0; i < others.size(); ++i)
      others[i] = (all_sums[i] - sums[seed][i]) * (1.0f / static_cast<float>(kSeeds - 1));
    difference.push_back(stated[seed] - methods::relative_l1_difference(sums[seed], others));
  }
  const double t = student_quantile(kAlpha, 1, kSeeds - 1);
  const auto d = mean_of(difference);
  EXPECT_NEAR(d.mean, 0, t * d.standard_error) << "stated " << mean_of(stated).mean;
  EXPECT_LT(t * d.standard_error, 0.2 * mean_of(stated).mean);  // the test has teeth
}

double number(const json& report, const char* key) { return report.at(key).get<double>(); }

TEST(StatedError, IsUnderTheTargetAndTheSameOnOneTwoAndFourThreads) {
  const Scene scene = box();
  RenderSettings settings;
  settings.traced.rest = RestOfPaths::skip;
  settings.view.width = 64, settings.view.height = 48;
  settings.lights.count = 10000;
  settings.method = {.name = "slice-cuts", .target_error = 0.08};
  settings.threads = 1;
  const RenderResult one = render(scene, settings);
  const json report = json::parse(one.report.json());
  EXPECT_LE(number(report, "error.estimate"), 0.08);
  EXPECT_NEAR(number(report, "error.estimate"),
              std::hypot(number(report, "error.sampling"), number(report, "error.lights")) +
                  number(report, "error.clamping"),
              1e-12);
  EXPECT_FALSE(report.contains("target"));
  EXPECT_FALSE(report.contains("error.advice"));
  for (int threads : {2, 4}) {
    settings.threads = threads;
    const RenderResult many = render(scene, settings);
    EXPECT_EQ(one.picture.planes[0].rgb, many.picture.planes[0].rgb) << threads << " threads";
    for (const char* key : {"error.estimate", "error.sampling", "error.lights", "error.clamping"})
      EXPECT_EQ(report.at(key), json::parse(many.report.json()).at(key)) << threads << " threads, " << key;
  }
}

TEST(StatedError, OfEveryMethodThatIsAskedForIt) {
  const Scene scene = box();
  RenderSettings settings;
  settings.traced.rest = RestOfPaths::skip;
  settings.view.width = 32, settings.view.height = 24;
  settings.lights.count = 3000;
  settings.method.target_error = 0.3;
  for (const char* method : {"brute-force", "instant-radiosity", "power-sampling", "row-column-sampling"}) {
    settings.method.name = method;
    const json report = json::parse(render(scene, settings).report.json());
    EXPECT_LE(number(report, "error.estimate"), 0.3) << method;
    EXPECT_GT(number(report, "error.lights"), 0) << method;
    // All columns: single precision is what is left.
    if (method[0] == 'b' || method[0] == 'i') {
      EXPECT_LT(number(report, "error.sampling"), 1e-4) << method;
    }
  }
  // Given rows are all clustered by, so that their error says nothing of others: unless one is asked for,
  // none is stated.
  settings.method.target_error = 0;
  settings.method.parameters = {{"rows", "30"}, {"columns", "50"}};
  const json fixed = json::parse(render(scene, settings).report.json());
  EXPECT_TRUE(fixed.contains("error.lights"));
  EXPECT_FALSE(fixed.contains("error.estimate"));
  settings.method.target_error = 0.3;
  EXPECT_TRUE(json::parse(render(scene, settings).report.json()).contains("error.estimate"));
}

TEST(StatedError, TooFewLightsGetAdviceWithANumber) {
  const Scene scene = box();
  RenderSettings settings;
  settings.traced.rest = RestOfPaths::skip;
  settings.view.width = 32, settings.view.height = 24;
  settings.method.name = "row-column-sampling";
  settings.lights.count = 300;
  settings.method.target_error = 0.04;
  std::vector<std::string> warnings;
  Sinks sinks;
  sinks.warning = [&](const std::string& text) { warnings.push_back(text); };
  const json report = json::parse(render(scene, settings, sinks).report.json());
  EXPECT_GT(number(report, "error.estimate"), 0.04);
  EXPECT_EQ(report.at("target"), "not reached");
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_EQ(report.at("error.advice"), warnings[0]);
  EXPECT_NE(warnings[0].find("--lights "), std::string::npos) << warnings[0];
  settings.method.name = "instant-radiosity";
  settings.method.parameters = {{"lights", "300"}};
  render(scene, settings, sinks);
  ASSERT_EQ(warnings.size(), 2u);
  EXPECT_NE(warnings[1].find("--set lights="), std::string::npos) << warnings[1];
}

TEST(StatedError, MethodsThatDoNotAimAtItSaySo) {
  const Scene scene = box();
  RenderSettings settings;
  settings.traced.rest = RestOfPaths::skip;
  settings.view.width = 16, settings.view.height = 12;
  settings.lights.count = 300;
  std::vector<std::string> warnings;
  Sinks sinks;
  sinks.warning = [&](const std::string& text) { warnings.push_back(text); };
  for (const methods::MethodInfo& info : methods::all_methods()) {
    settings.method.name = info.name;
    for (const double error : {0.0, 5.0}) {  // of which nobody falls short
      settings.method.target_error = error;
      warnings.clear();
      const json report = json::parse(render(scene, settings, sinks).report.json());
      // In passes, which row-guided sampling has by itself, any error is reached.
      const bool expected = error > 0 && !info.error_parameters.empty() && info.name != "row-guided-sampling";
      ASSERT_EQ(warnings.size(), expected ? 1u : 0u) << info.name;
      if (!expected) continue;
      EXPECT_TRUE(report.contains("error.estimate")) << info.name;
      for (const std::string& part : {info.name, std::string("--error"), info.error_parameters})
        EXPECT_NE(warnings[0].find(part), std::string::npos) << warnings[0];
    }
  }
}

TEST(ErrorAdvice, NumbersFollowTheRoot) {
  using pipeline::lights_for_error;
  // Half of 0.08 is left to sampling: √(0.04² + l²) = 0.08 at l = 0.0693; from 0.2 by 8.33 times as many
  // lights.
  EXPECT_EQ(lights_for_error({0.08, 1000, "--lights"}, 0.2, 0), 8400);
  // Clamping alone: 0.05 + c = 0.1 at half of 0.1, so four times as many.
  EXPECT_EQ(lights_for_error({0.1, 1000, "--lights"}, 0, 0.1), 4000);
  EXPECT_EQ(lights_for_error({0.1, 1000, "--lights"}, 0.01, 0), 1000);
}

TEST(ErrorAdvice, NamesWhatHelps) {
  using pipeline::error_advice;
  const auto advice = [](double sampling, double lights, double clamping) {
    return error_advice({0.05, 1000, "--lights"},
                        {{"error.estimate", std::hypot(sampling, lights) + clamping},
                         {"error.sampling", sampling},
                         {"error.lights", lights},
                         {"error.clamping", clamping}});
  };
  EXPECT_EQ(advice(0.03, 0.02, 0.01), "");
  EXPECT_NE(advice(0.06, 0.02, 0.01).find("more time"), std::string::npos);
  EXPECT_NE(advice(0.02, 0.08, 0.01).find("--lights "), std::string::npos);
  EXPECT_EQ(advice(0.02, 0.08, 0.01).find("--clamp"), std::string::npos);
  EXPECT_NE(advice(0.02, 0.01, 0.06).find("--clamp"), std::string::npos);
  EXPECT_NE(advice(0.02, 9, 0.01).find("larger error"), std::string::npos);
  EXPECT_EQ(error_advice({0.05, 1000, "--lights"}, {}), "");
  const std::string fixed = error_advice(
      {0.05, 1000, "--lights", "nodes"},
      {{"error.estimate", 0.07}, {"error.sampling", 0.06}, {"error.lights", 0}, {"error.clamping", 0.01}});
  EXPECT_NE(fixed.find("nodes (--set)"), std::string::npos) << fixed;
  EXPECT_EQ(fixed.find("more time"), std::string::npos) << fixed;
}

}  // namespace
}  // namespace lumirank
