// Light that columns cannot carry is part of the picture by default, where it matters.
#include <gtest/gtest.h>

#include "api/whole_renders.h"
#include "lumirank/lumirank.h"
#include "pipeline/rest_pilot.h"
#include "support/scene_file.h"
#include "support/statistics.h"

namespace lumirank {
namespace {

using test::load_text;
using test::mean_of;
using test::mean_value;
using test::point_camera;
using test::report_of;
using test::student_quantile;

// A floor of reflectance 0.5 under an even sky of radiance 1, at the foot of a mirror that hides half of the
// sky and shows the other half instead. Floor and mirror end a hundred thousand times as far away as the
// mirror stands from the place that is seen, so what lies beyond them is less than 1e-4 of the sky.
std::string floor_and_wall(const char* wall) {
  return point_camera("0,1,1", "0,0,0", 4, 0.1) +
         "<shape type=\"rectangle\"><transform name=\"to_world\"><rotate x=\"1\" angle=\"-90\"/>"
         "<scale value=\"1000\"/></transform><bsdf type=\"diffuse\"><rgb name=\"reflectance\" "
         "value=\"0.5\"/></bsdf></shape>"
         "<shape type=\"rectangle\"><transform name=\"to_world\"><scale value=\"1000\"/><translate "
         "z=\"-0.01\"/></transform>" +
         wall + "</shape><emitter type=\"constant\"><rgb name=\"radiance\" value=\"1\"/></emitter>";
}
const char* const kMirror = "<bsdf type=\"conductor\"><string name=\"material\" value=\"none\"/></bsdf>";
const char* const kBlack = "<bsdf type=\"diffuse\"><rgb name=\"reflectance\" value=\"0\"/></bsdf>";

RenderSettings few_lights() {
  RenderSettings s;
  s.method.name = "brute-force";
  s.lights.count = 500;
  s.view.max_depth = 3;
  return s;
}

TEST(WholeLight, TheSkyInAMirrorIsPartOfThePictureByDefault) {
  const Scene scene = load_text(floor_and_wall(kMirror));
  constexpr int kSeeds = 8;
  std::vector<double> whole, columns, shares;
  for (std::uint64_t k = 0; k < kSeeds; ++k) {
    RenderSettings s = few_lights();
    s.seed = 70 + k;
    const RenderResult result = render(scene, s);
    whole.push_back(mean_value(result.picture));
    shares.push_back(report_of(result)["rest.share"].get<double>());
    EXPECT_GE(report_of(result)["rest.paths"], pipeline::RestPilot::kMinPaths);
    s.traced.rest = RestOfPaths::skip;
    const RenderResult skipped = render(scene, s);
    columns.push_back(mean_value(skipped.picture));
    EXPECT_FALSE(report_of(skipped).contains("rest.share"));
    EXPECT_EQ(report_of(skipped)["rest.paths"], 0);
  }
  const auto expect = [&](const std::vector<double>& values, double truth, const char* what) {
    const auto m = mean_of(values);
    const double allowed = student_quantile(1e-4, 1, kSeeds - 1) * m.standard_error + 2e-4;
    EXPECT_NEAR(m.mean, truth, allowed) << what;
    EXPECT_LT(allowed, 0.05) << what << ": the test has lost its teeth";
  };
  expect(whole, 0.5, "whole");
  expect(columns, 0.25, "columns");
  expect(shares, 0.5, "share");
}

TEST(WholeLight, WhereThereIsNoneNothingIsTraced) {
  const Scene scene = load_text(floor_and_wall(kBlack));
  RenderSettings s = few_lights();
  const RenderResult result = render(scene, s);
  EXPECT_EQ(report_of(result)["rest.share"], 0);
  EXPECT_EQ(report_of(result)["rest.paths"], 0);
  s.traced.rest = RestOfPaths::skip;
  EXPECT_EQ(render(scene, s).picture.planes[0].rgb, result.picture.planes[0].rgb);
}

// A window of the picture has the picture's light, so the pilot may not depend on it.
TEST(WholeLight, ThePilotLooksAtTheWholeFilmAtAnySize) {
  const Scene scene = load_text(floor_and_wall(kMirror));
  const auto share_of = [&](const char* key, const char* value) {
    RenderSettings s = few_lights();
    set_field(s, key, value);
    const auto report = report_of(render(scene, s));
    return std::pair(report["rest.share"].get<double>(), report["rest.paths"].get<double>());
  };
  const auto whole = share_of("seed", "1");
  EXPECT_EQ(share_of("crop", "1,1,2,2"), whole);
  EXPECT_EQ(share_of("size", "8x8"), whole);
  EXPECT_EQ(share_of("spp", "1"), whole);
}

TEST(WholeLight, PathsByTheNoiseThatTheyAdd) {
  using pipeline::RestPilot;
  RestPilot pilot;
  EXPECT_EQ(pilot.paths(), RestPilot::kMinPaths);
  // 40 paths: √(2/π) · deviation / √40 is the noise allowed.
  pilot.deviation = RestPilot::kNoise * std::sqrt(40 * 3.14159265358979 / 2) * (1 - 1e-9);
  EXPECT_EQ(pilot.paths(), 40);
  pilot.deviation = 100;
  EXPECT_EQ(pilot.paths(), RestPilot::kMaxPaths);
  pilot.share = 0.1, pilot.without_brightest = RestPilot::kMinShare;
  EXPECT_FALSE(pilot.matters()) << "one path has found nearly all of it";
  pilot.without_brightest = 2 * RestPilot::kMinShare;
  EXPECT_TRUE(pilot.matters());
}

// A caustic on a hundredth of the film doubles its light there, in two paths of each of its blocks.
TEST(WholeLight, ASmallCausticIsSeen) {
  using pipeline::PilotPixel;
  constexpr std::size_t kWidth = 64, kHeight = 32;
  const std::vector<PilotPixel> all(kWidth * kHeight, {1, 0, 0.5});
  std::vector<PilotPixel> rest(kWidth * kHeight);
  for (std::size_t y = 8; y < 12; ++y)
    for (std::size_t x = 20; x < 24; ++x) rest[y * kWidth + x] = {0.5, 0, 0.25};
  const double block = 16, pixels = kWidth * kHeight;
  const double of_block = (0.5 * block - 0.25) / (1.1 * block);
  EXPECT_NEAR(pipeline::seen_share(rest, all, kWidth), of_block * block / pixels, 1e-12);
  // One path of each hundred pixels, as bright: noise, of which no place is known.
  std::vector<PilotPixel> spread(kWidth * kHeight);
  for (std::size_t y = 0; y < kHeight; y += 8)
    for (std::size_t x = 0; x < kWidth; x += 8) spread[y * kWidth + x] = {0.25, 0.5, 0.25};
  EXPECT_EQ(pipeline::seen_share(spread, all, kWidth), 0);
  pipeline::RestPilot pilot;
  pilot.share = pilot.without_brightest = 0.003;
  EXPECT_FALSE(pilot.matters());
  pilot.seen = 0.002;
  EXPECT_TRUE(pilot.matters());
}

}  // namespace
}  // namespace lumirank
