// Media that color glass: as rays take them in they are what the volumetric path tracer makes of them.
#include "world/colored_glass.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "pathtrace/reference.h"
#include "scenedesc/readers.h"
#include "support/statistics.h"

namespace lumirank::pathtrace {
namespace {

constexpr int kGlassWidth = 12, kGlassHeight = 8;

// A ball and a block of colored glass on a floor, under a lamp and a dim sky.
std::string glass_scene(const std::string& more = "",
                        const std::string& block = "<bsdf type=\"dielectric\"/>") {
  const std::string medium =
      "<medium name=\"interior\" type=\"homogeneous\"><rgb name=\"albedo\" value=\"0\"/><rgb "
      "name=\"sigma_t\" "
      "value=\"0.2, 0.9, 2\"/></medium>";
  return R"(<scene version="3.0.0"><sensor type="perspective"><float name="fov" value="45"/>
    <transform name="to_world"><lookat origin="0.6,1.8,4" target="0,0.6,0" up="0,1,0"/></transform>
    <film type="hdrfilm"><integer name="width" value="12"/><integer name="height" value="8"/></film></sensor>
    <shape type="rectangle"><transform name="to_world"><rotate x="1" angle="-90"/><scale value="4"/></transform></shape>
    <shape type="sphere"><point name="center" x="-0.7" y="0.71" z="0"/><float name="radius" value="0.7"/>
      <bsdf type="dielectric"/>)" +
         medium + R"(</shape>
    <shape type="cube"><transform name="to_world"><scale value="0.4"/><translate x="0.8" y="0.42"/></transform>)" +
         block + medium + R"(</shape>
    <shape type="rectangle"><transform name="to_world"><rotate x="1" angle="90"/><translate y="2.5"/></transform>
      <emitter type="area"><rgb name="radiance" value="4"/></emitter></shape>
    <emitter type="constant"><rgb name="radiance" value="0.3"/></emitter>)" +
         more + "</scene>";
}

world::World build(const scenedesc::SceneDesc& desc, bool media) {
  std::vector<scenedesc::Warning> warnings;
  world::BuildOptions options;
  options.media = media;
  return world::World::build(desc, options, warnings);
}

scenedesc::SceneDesc read(const std::string& text) { return scenedesc::parse_mitsuba(text, "glass.xml"); }

// Of whole pictures, by channel.
std::array<test::RunningMean, 3> pictures(const scenedesc::SceneDesc& desc, bool media, double light_paths) {
  const world::World world = build(desc, media);
  const world::View view = world::make_view(desc, {});
  std::array<test::RunningMean, 3> sums;
  for (std::uint64_t k = 0; k < 60; ++k) {
    ReferenceOptions options;
    options.seed = hash_ids(9, Stage::test, k, media ? 1 : 0);
    options.light_paths = light_paths;
    PathFilm film(world, view, options);
    EXPECT_TRUE(film.add(16, {}));
    for (int c = 0; c < 3; ++c) {
      double sum = 0;
      for (const Rgb& pixel : film.result().image.pixels) sum += static_cast<double>(pixel[c]);
      sums[static_cast<std::size_t>(c)].add(sum / (kGlassWidth * kGlassHeight));
    }
  }
  return sums;
}

TEST(ColoredGlass, IsWhatTheVolumetricPathTracerMakesOfIt) {
  const scenedesc::SceneDesc desc = read(glass_scene());
  ASSERT_TRUE(world::may_color_glass(desc));
  EXPECT_TRUE(world::colors_glass(build(desc, false)));
  const auto volumetric = pictures(desc, true, 0);
  const scenedesc::SceneDesc clear = [&] {
    scenedesc::SceneDesc without = desc;
    for (auto& shape : without.shapes) shape.media = {};
    without.media.clear();
    return without;
  }();
  const auto uncolored = pictures(clear, false, 0);
  for (const double light_paths : {0.0, 1.0}) {
    const auto colored = pictures(desc, false, light_paths);
    for (std::size_t c = 0; c < 3; ++c) {
      const double error = test::normal_quantile(1e-3, 6) *
                           std::hypot(volumetric[c].standard_error(), colored[c].standard_error());
      EXPECT_NEAR(colored[c].mean(), volumetric[c].mean(), error) << "channel " << c << ", " << light_paths;
      EXPECT_GT(uncolored[c].mean() - volumetric[c].mean(), (c == 0 ? 1 : 3) * error) << "it could be seen";
    }
  }
}

TEST(ColoredGlass, WhatStandsWithinOrIsOpenIsNone) {
  const std::string pin =
      R"(<shape type="sphere"><point name="center" x="-0.7" y="0.7" z="0"/><float name="radius" value="0.5"/></shape>)";
  const scenedesc::SceneDesc holding = read(glass_scene(pin));
  EXPECT_TRUE(world::may_color_glass(holding));
  EXPECT_FALSE(world::colors_glass(build(holding, false)));
  const std::string water =
      R"(<shape type="rectangle"><transform name="to_world"><scale value="0.2"/><rotate x="1" angle="-90"/><translate y="3"/></transform>
      <bsdf type="dielectric"/><medium name="interior" type="homogeneous"><rgb name="albedo" value="0"/></medium></shape>)";
  EXPECT_FALSE(world::colors_glass(build(read(glass_scene(water)), false)));
}

TEST(ColoredGlass, IsSmoothAndNothingElse) {
  EXPECT_FALSE(world::may_color_glass(read(glass_scene("", "<bsdf type=\"roughdielectric\"/>"))));
  EXPECT_FALSE(world::may_color_glass(read(glass_scene("", "<bsdf type=\"null\"/>"))));
  std::string scattering = glass_scene();
  scattering.replace(scattering.find("name=\"albedo\" value=\"0\""), 23, "name=\"albedo\" value=\"0.1\"");
  EXPECT_FALSE(world::may_color_glass(read(scattering)));
}

}  // namespace
}  // namespace lumirank::pathtrace
