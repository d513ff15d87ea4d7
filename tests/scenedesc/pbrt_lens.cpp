// Lens files, by closed forms of thin lenses.
#include "scenedesc/pbrt/lens.h"

#include <cmath>
#include <fstream>

#include "scenedesc/pbrt_scene.h"
#include "support/scene_file.h"

namespace lumirank::scenedesc {
namespace {

using pbrt::Lens;
using pbrt::parse_lens;

Lens lens_of(const std::string& text, double aperture = 10) {
  return parse_lens(text, "lens.dat", aperture, {});
}

// 1/f = (n - 1)(1/R + 1/R) = 1/100, behind a stop: that is seen as it is from the scene, and from the film as
// far as -1/25 = 1/100 - 1/20 and 1.25 times as large.
TEST(PbrtLens, OneThinLensBehindItsStop) {
  const Lens lens = lens_of("# a lens\n0 20 0 16\n100 1e-6 1.5 40\n-100 0 0 40\n");
  EXPECT_NEAR(lens.focal_length, 100, 1e-3);
  EXPECT_NEAR(lens.front_principal, 20, 1e-3);
  EXPECT_NEAR(lens.rear_principal, 20, 1e-3);
  EXPECT_NEAR(lens.entrance_pupil, 0, 1e-9);
  EXPECT_NEAR(lens.entrance_radius, 5, 1e-9);
  EXPECT_NEAR(lens.exit_pupil, 20 - 25, 1e-3);
  EXPECT_NEAR(lens.exit_radius, 6.25, 1e-3);
  // 1:1 at four focal lengths, and no image nearer than that.
  EXPECT_NEAR(lens.image_distance(400.001), 200, 1);
  EXPECT_EQ(lens.image_distance(399), 0);
  EXPECT_NEAR(lens.image_distance(1e7), 100, 1e-2);
  // A stop is not opened beyond its own diameter.
  EXPECT_NEAR(lens_of("0 20 0 16\n100 1e-6 1.5 40\n-100 0 0 40\n", 30).entrance_radius, 8, 1e-9);
}

// 1/f = 1/f₁ + 1/f₂ - d/(f₁f₂), the rear principal plane fd/f₁ before the second lens and the front one fd/f₂
// behind the first; the stop between both, seen through the first.
TEST(PbrtLens, TwoThinLenses) {
  const Lens lens = lens_of("100 1e-6 1.5 40\n-100 10 0 40\n0 20 0 12\n50 1e-6 1.5 40\n-50 0 0 40\n", 12);
  const double f = 1 / (1 / 100.0 + 1 / 50.0 - 30 / 5000.0);
  EXPECT_NEAR(lens.focal_length, f, 1e-3);
  EXPECT_NEAR(lens.rear_principal, 30 - f * 30 / 100, 1e-3);
  EXPECT_NEAR(lens.front_principal, f * 30 / 50, 1e-3);
  // 10 behind f₁ = 100: 1/s' = 1/100 - 1/10, as if 11.11 behind it, 1.11 times as large.
  EXPECT_NEAR(lens.entrance_pupil, 100 / 9.0, 1e-3);
  EXPECT_NEAR(lens.entrance_radius, 6 * 10 / 9.0, 1e-3);
}

TEST(PbrtLens, WhatIsNoLensIsRefused) {
  for (const char* bad : {"", "1 2 3\n", "100 1 1.5 x\n", "-100 1 1.5 40\n100 0 0 40\n", "0 1 0 10\n"})
    EXPECT_THROW(lens_of(bad), InputError) << bad;
}

// 50 mm before a film of 36 by 24 mm: 36/50 wide at infinity, f/2.5.
TEST(PbrtCamera, RealisticIsAThinLensOfTheSameView) {
  const test::TemporaryFolder folder;
  const std::string file = folder / "lens.dat";
  std::ofstream(file) << "50 1e-6 1.5 40\n0 1e-6 1.5 20\n-50 0 0 40\n";
  const auto scene = [&](const std::string& more) {
    return pbrt_world("",
                      "Film \"rgb\" \"integer xresolution\" 360 \"integer yresolution\" 240 \"float "
                      "diagonal\" 43.2666\nCamera \"realistic\" \"string lensfile\" \"" +
                          file + "\" \"float aperturediameter\" 20 " + more);
  };
  const SceneDesc far = scene("\"float focusdistance\" 1000");
  EXPECT_NE(only_warning(far).what.find("realistic"), std::string::npos);
  const SensorDesc& s = far.sensors.at(0);
  EXPECT_EQ(s.kind, SensorKind::thinlens);
  EXPECT_NEAR(std::tan(s.fov_x * M_PI / 360), 18 / 50.0, 1e-4);
  EXPECT_NEAR(s.aperture_radius, 0.01f, 1e-6f);
  EXPECT_NEAR(s.focus_distance, 1000 - 0.05f, 1e-3f);
  // The film is where the camera is, the lens before it.
  EXPECT_NEAR(s.to_world.point({0, 0, 0}).z, 0.05f, 1e-4f);
  // Half a meter before the film: s' = 56.35, s = 443.65.
  const SensorDesc near = scene("\"float focusdistance\" 0.5").sensors.at(0);
  EXPECT_NEAR(near.focus_distance, 0.44365f, 1e-4f);
  EXPECT_NEAR(std::tan(near.fov_x * M_PI / 360), 18 / 56.35, 1e-4);
  EXPECT_THROW(scene("\"float focusdistance\" 0.19"), InputError);
  EXPECT_THROW(pbrt_world("", "Camera \"realistic\" \"string lensfile\" \"none.dat\""), InputError);
  EXPECT_THROW(pbrt_world("", "Camera \"realistic\""), InputError);
}

}  // namespace
}  // namespace lumirank::scenedesc
