// Media of a built world: where they are, and in which units.
#include <gtest/gtest.h>

#include "world/emitter_media.h"
#include "world/scene_maker.h"

namespace lumirank::world {
namespace {

using namespace test;

// A cube of a medium behind a null surface, within a larger one that divides nothing.
sd::SceneDesc cube_of_fog(double scale) {
  sd::SceneDesc desc = empty_scene();
  sd::MediumDesc fog;
  fog.extinction.value = Rgb(static_cast<float>(3 / scale));
  fog.albedo.value = Rgb(0.5f);
  desc.media.push_back(fog);
  const int null = add_bsdf(desc, sd::NullBsdfDesc{});
  const int inner = add_shape(desc, sd::CubeDesc{}, Transform::scale(scale, scale, scale));
  desc.shapes[static_cast<std::size_t>(inner)].bsdf = null;
  desc.shapes[static_cast<std::size_t>(inner)].media = {true, 0, sd::kNone};
  add_shape(desc, sd::CubeDesc{}, Transform::scale(4 * scale, 4 * scale, 4 * scale));
  add_emitter(desc, sd::PointLightDesc{});
  return desc;
}

World built(const sd::SceneDesc& desc, bool media, std::vector<sd::Warning>& warnings) {
  return World::build(desc, {.media = media}, warnings);
}

TEST(Media, AreWhereSurfacesSay) {
  std::vector<sd::Warning> warnings;
  const World world = built(cube_of_fog(1), true, warnings);
  const Vec3f direction = normalize(Vec3f{1, 0.2f, 0.3f});
  const auto hit = world.intersect({{0, 0, 0}, direction});
  ASSERT_TRUE(hit);
  EXPECT_EQ(world.medium_beyond(*hit, direction, 0), -1);
  EXPECT_EQ(world.medium_beyond(*hit, -direction, -1), 0);
  const auto wall = world.intersect({{0, 0, 2}, {0, 0, 1}});
  ASSERT_TRUE(wall);
  EXPECT_EQ(world.medium_beyond(*wall, {0, 0, -1}, 5), 5);
}

// A lamp where light starts: in the fog, without it, by walls or by its own surface.
TEST(EmitterMedia, AreThoseInWhichLightStarts) {
  const auto medium_of = [&](const sd::SceneDesc& desc, std::size_t emitter, int eye_medium) {
    std::vector<sd::Warning> warnings;
    const World world = built(desc, true, warnings);
    const Vec3f origin = world.units().to_world(Vec3d{0, 0, 2});
    return EmitterMedia(world, world.units().to_world(Vec3d{0, 0, 3}), eye_medium)
        .of(static_cast<int>(emitter), {origin, {0, 0, -1}});
  };
  sd::SceneDesc desc = cube_of_fog(1);  // its point is in the fog
  EXPECT_EQ(medium_of(desc, 0, -1), 0);
  add_emitter(desc, sd::PointLightDesc{{0, 0, 2}, Rgb(1)});
  EXPECT_EQ(medium_of(desc, 1, -1), -1);
  // Nothing divides media: what is said to be everywhere.
  desc.shapes[0].media = {};
  EXPECT_EQ(medium_of(desc, 0, 0), 0);
  EXPECT_EQ(medium_of(desc, 1, -1), -1);
}

// A room of opaque walls, of which only the open front divides its fog from what is outside.
TEST(EmitterMedia, WallsNeedNotDivideThem) {
  sd::SceneDesc desc = cube_of_fog(1);
  desc.shapes.clear();
  const int white = add_bsdf(desc, sd::DiffuseDesc{});
  const auto wall = [&](const Transform& to_world, int bsdf) {
    const int s = add_shape(desc, sd::RectangleDesc{}, to_world);
    desc.shapes[static_cast<std::size_t>(s)].bsdf = bsdf;
    return s;
  };
  wall(Transform::translate(0, 0, -1), white);
  for (const double side : {-1.0, 1.0}) {
    wall(Transform::translate(side, 0, 0) * Transform::rotate(0, 1, 0, 90), white);
    wall(Transform::translate(0, side, 0) * Transform::rotate(1, 0, 0, 90), white);
  }
  const int front = wall(Transform::translate(0, 0, 1), 0);
  desc.shapes[static_cast<std::size_t>(front)].media = {true, 0, sd::kNone};
  std::vector<sd::Warning> warnings;
  const World world = built(desc, true, warnings);
  const auto seen_from = [&](Vec3d eye) {
    return EmitterMedia(world, world.units().to_world(eye), -1).of(0, {{0, 0, 0}, {0, -1, 0}});
  };
  EXPECT_EQ(seen_from({0, 0, 3}), 0);  // through the front
  EXPECT_EQ(seen_from({0, 3, 0}), 0);  // through the roof, which tells nothing
}

TEST(Media, AreAsThickInAnyUnits) {
  for (const double scale : {1e-6, 1.0, 1e7}) {
    std::vector<sd::Warning> warnings;
    const World world = built(cube_of_fog(scale), true, warnings);
    const double size = 2 * scale * world.units().scale();
    const media::Coefficients at = world.media()[0].at(world.units().to_world(Vec3d{}));
    EXPECT_NEAR(static_cast<double>(at.extinction.g) * size, 6, 1e-4) << scale;
    EXPECT_NEAR(static_cast<double>(at.scattering.g) * size, 3, 1e-4) << scale;
  }
}

TEST(Media, AGridIsWhereItsBoxIs) {
  sd::SceneDesc desc = cube_of_fog(1e-6);
  auto grid = std::make_shared<sd::GridData>();
  grid->size = {2, 1, 1};
  grid->values = {1, 3};
  sd::VolumeDesc volume;
  volume.sampling = sd::GridSampling::corners;
  volume.to_world = Transform::scale(2e-6, 2e-6, 2e-6) * Transform::translate(-0.5, -0.5, -0.5);
  volume.kind = std::shared_ptr<const sd::GridData>(grid);
  desc.volumes.push_back(volume);
  desc.media[0].extinction = {Rgb(1e6f), 0};
  std::vector<sd::Warning> warnings;
  const World world = built(desc, true, warnings);
  EXPECT_TRUE(warnings.empty());
  const auto thickness = [&](double x) {
    const Vec3f place = world.units().to_world(Vec3d{x * 1e-6, 0, 0});
    return static_cast<double>(world.media()[0].at(place).extinction.r) * world.units().scale() * 1e-6;
  };
  EXPECT_NEAR(thickness(-0.999), 1, 0.01);
  EXPECT_NEAR(thickness(0), 2, 0.01);
  EXPECT_NEAR(thickness(0.999), 3, 0.01);
  EXPECT_EQ(thickness(1.1), 0);
}

// A file of a sparse grid: a leaf of the numbers k/512 whose voxels are half as wide and a quarter as high as
// a unit, from (1, 2, 3) on.
TEST(Media, ASparseGridIsWhereItsFileSays) {
  sd::SceneDesc desc = cube_of_fog(20);
  sd::VolumeDesc volume;
  volume.sampling = sd::GridSampling::corners;
  volume.to_world = Transform::translate(-1, 0, 0);
  volume.kind =
      sd::GridFileDesc{std::string(LUMIRANK_TEST_DATA) + "/../fuzz/corpus/nanovdb/floats.nvdb", true};
  desc.volumes.push_back(volume);
  desc.media[0].extinction = {Rgb(1), 0};
  std::vector<sd::Warning> warnings;
  const World world = built(desc, true, warnings);
  EXPECT_TRUE(warnings.empty());
  const auto thickness = [&](Vec3d voxel) {
    const Vec3d place{voxel.x * 0.5, 2 + voxel.y * 0.25, 3 + voxel.z};
    return static_cast<double>(world.media()[0].at(world.units().to_world(place)).extinction.r) *
           world.units().scale();
  };
  EXPECT_NEAR(thickness({1, 2, 3}), 83 / 512.0, 1e-5);
  EXPECT_NEAR(thickness({7, 7, 7}), 511 / 512.0, 1e-5);
  EXPECT_NEAR(thickness({6.5, 7, 7}), 479 / 512.0, 1e-5);
  EXPECT_NEAR(thickness({7.5, 7, 7}), 511 / 1024.0, 1e-5) << "it fades over one voxel";
  EXPECT_EQ(thickness({8.1, 7, 7}), 0);
}

TEST(Media, AreLeftOutWithAWarning) {
  std::vector<sd::Warning> warnings;
  const World world = built(cube_of_fog(1), false, warnings);
  EXPECT_TRUE(world.media().empty());
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_NE(warnings[0].what.find("participating media"), std::string::npos);
}

TEST(Media, NumbersThatMakeNoSenseAreToldOf) {
  sd::SceneDesc desc = cube_of_fog(1);
  desc.media[0].albedo.value = Rgb(1.5f);
  std::vector<sd::Warning> warnings;
  const World world = built(desc, true, warnings);
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_NE(warnings[0].what.find("albedo"), std::string::npos);
  EXPECT_EQ(world.media()[0].at({}).scattering, world.media()[0].at({}).extinction);
  desc.media[0].extinction.value = Rgb(-1);
  EXPECT_THROW(built(desc, true, warnings), InputError);
  desc.media[0].extinction = {Rgb(1), 5};
  EXPECT_THROW(built(desc, true, warnings), InputError);
}

}  // namespace
}  // namespace lumirank::world
