// Clamped columns and the path-traced compensation for what clamping took add up to the path tracer's
// picture.
#include <gtest/gtest.h>

#include "api/whole_renders.h"
#include "lumirank/error.h"
#include "lumirank/lumirank.h"
#include "support/channel_means.h"
#include "support/scene_file.h"

namespace lumirank {
namespace {

using test::kAlpha;
using test::mean_color;
using test::mean_of;
using test::student_quantile;

std::string glossy_wall(const std::string& transform, const std::string& specular) {
  return "<shape type=\"rectangle\"><transform name=\"to_world\">" + transform +
         "</transform><bsdf type=\"twosided\"><bsdf type=\"ward\"><rgb name=\"diffuse_reflectance\" "
         "value=\"0.4, "
         "0.3, 0.2\"/><rgb name=\"specular_reflectance\" value=\"" +
         specular +
         "\"/><float name=\"alpha_u\" value=\"0.15\"/><float name=\"alpha_v\" "
         "value=\"0.35\"/></bsdf></bsdf></shape>";
}

// A glossy floor and two glossy walls that meet in the middle of the picture, lit by a spot: entries are
// large along the edges and in the walls' mirror directions.
Scene glossy_corner() {
  return test::load_text(
      test::point_camera("0.4,0.5,1.2", "0,0.1,0", 7, 16) +
      glossy_wall("<rotate x=\"1\" angle=\"-90\"/>", "0.5, 0.5, 0.5") +
      glossy_wall("<translate x=\"0\" y=\"1\" z=\"-0.5\"/>", "0.4, 0.45, 0.5") +
      glossy_wall("<rotate y=\"1\" angle=\"90\"/><translate x=\"-0.5\" y=\"1\" z=\"0\"/>", "0.2, 0.2, 0.2") +
      "<emitter type=\"spot\"><transform name=\"to_world\"><lookat origin=\"0.5, 1.2, 0.8\" target=\"-0.1, "
      "0, "
      "-0.1\" up=\"0, 1, 0.2\"/></transform><rgb name=\"intensity\" value=\"5, 6, 7\"/><float "
      "name=\"cutoff_angle\" value=\"35\"/></emitter>");
}

RenderSettings settings_for(const std::string& light_type) {
  RenderSettings settings;
  settings.traced.rest = RestOfPaths::skip;
  settings.view.only = LightPart::indirect;
  settings.method.name = "brute-force";
  settings.view.max_depth = 5;
  settings.lights.count = 1500;
  settings.view.spp = 4;
  settings.lights.clamp = 0.02;
  set_field(settings, "light-type", light_type);
  return settings;
}

void expect_whole(const std::string& light_type) {
  const Scene scene = glossy_corner();
  RenderSettings settings = settings_for(light_type);
  ReferenceSettings how;
  how.paths = ReferencePaths::columns;
  how.spp = 512;
  constexpr int kSeeds = 24;
  std::vector<double> clamped[3], whole[3], paths[3];
  for (std::uint64_t k = 0; k < kSeeds; ++k) {
    settings.seed = 100 + k;
    settings.traced.compensate = 0;
    const auto a = mean_color(render(scene, settings).picture);
    settings.traced.compensate = 256;
    const auto b = mean_color(render(scene, settings).picture);
    const auto c = mean_color(reference(scene, settings, how).picture);
    for (std::size_t i = 0; i < 3; ++i)
      clamped[i].push_back(a[i]), whole[i].push_back(b[i]), paths[i].push_back(c[i]);
  }
  for (std::size_t i = 0; i < 3; ++i) {
    const auto w = mean_of(whole[i]), p = mean_of(paths[i]);
    const double error =
        student_quantile(kAlpha, 3, kSeeds - 1) * std::hypot(w.standard_error, p.standard_error);
    EXPECT_NEAR(w.mean, p.mean, error) << light_type << ", channel " << i;
    // The test has teeth: much was clamped, and an error of a twentieth would be seen.
    EXPECT_LT(mean_of(clamped[i]).mean, 0.85 * p.mean) << light_type << ", channel " << i;
    EXPECT_LT(error, 0.05 * p.mean) << light_type << ", channel " << i;
  }
}

TEST(Compensation, GivesBackWhatClampingTookFromGlossyLights) { expect_whole("point"); }
TEST(Compensation, GivesBackWhatDiffuseLightsLeaveOutAsWell) { expect_whole("diffuse-point"); }

TEST(Compensation, IsRefusedWhereItCannotBeWhole) {
  const Scene scene = glossy_corner();
  const auto message = [&](auto&& change) {
    RenderSettings settings = settings_for("point");
    settings.traced.compensate = 1;
    change(settings);
    try {
      render(scene, settings);
    } catch (const InputError& e) {
      return std::string(e.what());
    }
    return std::string();
  };
  EXPECT_NE(message([](RenderSettings& s) { s.time = 1; }).find("time budget"), std::string::npos);
  EXPECT_NE(message([](RenderSettings& s) { s.lights.clamp = 0; }).find("without clamping"),
            std::string::npos);
  EXPECT_NE(message([](RenderSettings& s) { s.view.only = LightPart::direct; }).find("indirect light"),
            std::string::npos);
}

}  // namespace
}  // namespace lumirank
