// Local compensation: what columns leave to traced paths, and what those bring, add up to the path tracer's
// picture.
#include <gtest/gtest.h>

#include <cstring>
#include <nlohmann/json.hpp>

#include "lumirank/error.h"
#include "lumirank/lumirank.h"
#include "support/channel_means.h"
#include "support/scene_file.h"

namespace lumirank {
namespace {

std::string two_sided_wall(const std::string& transform, const std::string& bsdf) {
  return "<shape type=\"rectangle\"><transform name=\"to_world\">" + transform +
         "</transform><bsdf type=\"twosided\">" + bsdf + "</bsdf></shape>";
}

const std::string kMatt = "<bsdf type=\"diffuse\"><rgb name=\"reflectance\" value=\"0.6, 0.5, 0.4\"/></bsdf>";
const std::string kShining =
    "<bsdf type=\"ward\"><rgb name=\"diffuse_reflectance\" value=\"0.3, 0.3, 0.2\"/><rgb "
    "name=\"specular_reflectance\" value=\"0.4, 0.4, 0.5\"/><float name=\"alpha_u\" value=\"0.1\"/><float "
    "name=\"alpha_v\" value=\"0.4\"/></bsdf>";
const std::string kSpot =
    "<emitter type=\"spot\"><transform name=\"to_world\"><lookat origin=\"0.5, 1.2, 0.8\" target=\"-0.1, "
    "0.3, "
    "-0.5\" up=\"0, 1, 0.2\"/></transform><rgb name=\"intensity\" value=\"5, 6, 7\"/><float "
    "name=\"cutoff_angle\" value=\"35\"/></emitter>";

// Where a lit wall meets a floor. The camera's window shows the edge, or the floor in front of it.
Scene corner(const std::string& floor, const std::string& target) {
  return test::load_text(test::point_camera("0.4,0.5,1.2", target, 8, 14) +
                         two_sided_wall("<rotate x=\"1\" angle=\"-90\"/>", floor) +
                         two_sided_wall("<translate x=\"0\" y=\"1\" z=\"-0.5\"/>", kMatt) + kSpot);
}

RenderSettings brute_force(const std::string& light_type) {
  RenderSettings settings;
  settings.traced.rest = RestOfPaths::skip;
  settings.method.name = "brute-force";
  settings.view.max_depth = 5;
  settings.lights.count = 800;
  set_field(settings, "light-type", light_type);
  settings.lights.clamp = 0;
  return settings;
}

// Means over seeds of the renderer with `settings` and of the path tracer agree, and would not if a `teeth`
// of the light were missing.
void expect_whole(const Scene& scene, RenderSettings settings, double teeth) {
  ReferenceSettings how;
  how.paths = ReferencePaths::columns;
  how.spp = 512;
  constexpr int kSeeds = 32;
  test::ChannelMeans whole, paths;
  for (std::uint64_t k = 0; k < kSeeds; ++k) {
    settings.seed = 100 + k;
    whole.add(render(scene, settings).picture);
    paths.add(reference(scene, settings, how).picture);
  }
  test::expect_equal_means(whole, paths, teeth);
}

// The floor shows the wall in its gloss; far from the edge, so that unclamped points have finite variance.
TEST(LocalCompensation, SharpLobesTakeAllTheirLightFromPaths) {
  const Scene scene = corner(kShining, "0.2,0,0.35");
  RenderSettings settings = brute_force("point");
  settings.traced.local_paths = 16;
  for (const char* only : {"all", "indirect", "direct"}) {
    SCOPED_TRACE(only);
    set_field(settings, "only", only);
    expect_whole(scene, settings, 0.06);
  }
}

// Spheres of a hundredth of the usual size are nearly points: without compensation the edge would have
// infinite variance, with it no light is closer than half the distance of its tenth neighbor, or twice.
TEST(LocalCompensation, PathsAndColumnsShareTheLightByDistance) {
  const Scene scene = corner(kMatt, "0,0.1,-0.45");
  RenderSettings settings = brute_force("sphere");
  settings.view.only = LightPart::indirect;
  settings.lights.radius_scale = 0.01;
  settings.traced.local_paths = 64;
  for (const double near : {50.0, 200.0}) {
    SCOPED_TRACE(near);
    settings.traced.local_near = near;
    expect_whole(scene, settings, 0.05);
  }
}

// In passes points give nothing to what is near; without that the edge would have infinite variance.
TEST(LocalCompensation, PointsOfPassesLeaveToPathsWhatIsNear) {
  const Scene scene = corner(kMatt, "0,0.1,-0.45");
  RenderSettings settings = brute_force("point");
  settings.view.only = LightPart::indirect;
  settings.passes = 16;
  settings.denoise = Denoise::off;
  expect_whole(scene, settings, 0.05);
  const auto report = nlohmann::json::parse(render(scene, settings).report.json());
  EXPECT_GT(report["seconds.traced_near"], 0);
}

// A floor that is little but gloss shows a wall, whose light comes from a lamp, by way of a mirror too: what
// receivers of their own gather there is all that paths find, and the mirror's part of it is not left out.
TEST(LocalCompensation, GatheredReceiversHaveAllLightOfSharpLobes) {
  const auto scene = [](const std::string& right) {
    const std::string gloss =
        "<bsdf type=\"ward\"><rgb name=\"diffuse_reflectance\" value=\"0.02, 0.02, 0.02\"/><rgb "
        "name=\"specular_reflectance\" value=\"0.7, 0.7, 0.8\"/><float name=\"alpha_u\" "
        "value=\"0.1\"/><float "
        "name=\"alpha_v\" value=\"0.15\"/></bsdf>";
    const std::string lamp =
        "<shape type=\"rectangle\"><transform name=\"to_world\"><scale value=\"0.6\"/><rotate y=\"1\" "
        "angle=\"90\"/><translate x=\"-0.9\" y=\"1\" z=\"1\"/></transform><emitter type=\"area\"><rgb "
        "name=\"radiance\" value=\"6, 5, 4\"/></emitter></shape>";
    return test::load_text(
        test::point_camera("0.4,0.5,1.2", "0.2,0,0.35", 8, 14) +
        two_sided_wall("<rotate x=\"1\" angle=\"-90\"/>", gloss) +
        two_sided_wall("<translate x=\"0\" y=\"1\" z=\"-0.5\"/>", kMatt) +
        two_sided_wall("<rotate y=\"1\" angle=\"-90\"/><translate x=\"1\" y=\"1\"/>", right) + lamp);
  };
  RenderSettings settings = brute_force("point");
  settings.passes = 8;
  settings.lights.count = 200;
  settings.denoise = Denoise::off;
  const std::string mirror = "<bsdf type=\"conductor\"><string name=\"material\" value=\"none\"/></bsdf>";
  expect_whole(scene(mirror), settings, 0.06);
  // The mirror brings more than such a part.
  ReferenceSettings how;
  how.paths = ReferencePaths::columns;
  how.spp = 4096;
  const auto light = [&](const std::string& right) {
    double sum = 0;
    const Picture picture = reference(scene(right), settings, how).picture;
    for (const float v : picture.planes[0].rgb) sum += static_cast<double>(v);
    return sum;
  };
  EXPECT_GT(light(mirror),
            1.1 * light("<bsdf type=\"diffuse\"><rgb name=\"reflectance\" value=\"0, 0, 0\"/></bsdf>"));
}

TEST(LocalCompensation, ColumnsHaveNothingWherePathsHaveAll) {
  const Scene scene = corner(kShining, "0,0.1,-0.45");
  RenderSettings settings = brute_force("sphere");
  settings.view.only = LightPart::indirect;
  settings.lights.radius_scale = 1;
  settings.traced.local_paths = 16;
  settings.traced.local_near = 1000;
  RenderSettings others = settings;
  others.lights.count = 300;
  const auto a = render(scene, settings).picture.planes[0].rgb,
             b = render(scene, others).picture.planes[0].rgb;
  // Reaches are larger than the scene with either number of lights: the same paths, and nothing else.
  EXPECT_EQ(std::memcmp(a.data(), b.data(), a.size() * sizeof(a[0])), 0);
  expect_whole(scene, settings, 0.1);
}

TEST(LocalCompensation, SameBitsForAnyNumberOfThreadsAndLayersAddUp) {
  const Scene scene = corner(kShining, "0,0.1,-0.45");
  RenderSettings settings = brute_force("sphere");
  settings.method.name = "auto";
  settings.traced.local_paths = 8;
  settings.layers = {"direct", "indirect", "emission"};
  settings.threads = 1;
  const Picture one = render(scene, settings).picture;
  for (const int threads : {2, 4}) {
    settings.threads = threads;
    const Picture many = render(scene, settings).picture;
    for (std::size_t p = 0; p < one.planes.size(); ++p)
      EXPECT_EQ(std::memcmp(one.planes[p].rgb.data(), many.planes[p].rgb.data(),
                            one.planes[p].rgb.size() * sizeof(one.planes[p].rgb[0])),
                0)
          << one.planes[p].name << ", " << threads << " threads";
  }
  ASSERT_EQ(one.planes.size(), 4u);
  for (std::size_t k = 0; k < one.planes[0].rgb.size(); ++k) {
    const float sum = one.planes[1].rgb[k] + one.planes[2].rgb[k] + one.planes[3].rgb[k];
    EXPECT_NEAR(sum, one.planes[0].rgb[k], 1e-4f * (1 + sum)) << k;
  }
}

TEST(LocalCompensation, IsRefusedWhereItCannotBeWhole) {
  const Scene scene = corner(kShining, "0,0.1,-0.45");
  const auto message = [&](auto&& change) {
    RenderSettings settings = brute_force("point");
    settings.traced.local_paths = 1;
    change(settings);
    try {
      render(scene, settings);
    } catch (const InputError& e) {
      return std::string(e.what());
    }
    return std::string();
  };
  EXPECT_NE(message([](RenderSettings& s) { s.traced.direct = DirectLight::matrix; }).find("local-paths"),
            std::string::npos);
  EXPECT_NE(
      message([](RenderSettings& s) { s.lights.clamp = 0.1, s.traced.compensate = 4; }).find("leave out one"),
      std::string::npos);
  EXPECT_NE(message([](RenderSettings& s) { s.layers = {"light:*"}; }).find("--local-paths"),
            std::string::npos);
}

}  // namespace
}  // namespace lumirank
