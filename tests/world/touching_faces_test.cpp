// What lies in the plane of something opaque is behind it.
#include "world/touching_faces.h"

#include <gtest/gtest.h>

#include <vector>

#include "world/plain_meshes.h"
#include "world/scene_maker.h"

namespace lumirank::world {
namespace {

using namespace test;

// A block of glass and something opaque, each at its place.
struct Pair {
  std::vector<geometry::TriangleMesh> meshes;
  std::vector<geometry::Placement> placements;
  std::vector<Part> parts{Part::clear, Part::opaque};

  Pair(geometry::TriangleMesh glass, const Transform& to_world, geometry::TriangleMesh other,
       const Transform& of_other)
      : meshes{std::move(glass), std::move(other)}, placements(2) {
    placements[0].mesh = 0, placements[0].to_world = to_world;
    placements[1].mesh = 1, placements[1].to_world = of_other;
  }
  std::size_t part() { return part_touching_faces(meshes, placements, parts); }
  Vec3f corner(std::size_t k) const { return placements[0].to_world.point(meshes[0].positions[k]); }
};

const Transform kFloor = Transform::translate(0, 0, -1) * Transform::scale(4, 3, 1);
constexpr float kStep = 5e-5f;  // by which rays leave a surface, at a distance of 1

TEST(TouchingFaces, GoBehindTheFloorThatTheyStandOn) {
  for (const float gap : {0.0f, 1.2f * kStep, -0.2f * kStep}) {
    Pair on_floor(block(), Transform::translate(0, 0, gap), sheet(), kFloor);
    EXPECT_EQ(on_floor.part(), 2u);
    for (std::size_t k = 0; k < 8; ++k) {
      const Vec3f was = block().positions[k], is = on_floor.corner(k);
      EXPECT_EQ(is.x, was.x);
      EXPECT_EQ(is.y, was.y);
      if (k < 4)
        EXPECT_NEAR(is.z, -1 - 0.5f * kStep, 0.01f * kStep);
      else
        EXPECT_NEAR(is.z, 1 + gap, 1e-6f);
    }
    EXPECT_EQ(on_floor.part(), 0u);  // they are there
  }
}

TEST(TouchingFaces, OthersStay) {
  Pair above(block(), Transform::translate(0, 0, 3 * kStep), sheet(), kFloor);
  EXPECT_EQ(above.part(), 0u);
  Pair tilted(block(), {}, sheet(), kFloor * Transform::rotate(1, 0, 0, 20));
  EXPECT_EQ(tilted.part(), 0u);
  Pair beside(block(), Transform::translate(20, 0, 0), sheet(), kFloor);
  EXPECT_EQ(beside.part(), 0u);
  Pair of_wood(block(), {}, sheet(), kFloor);
  of_wood.parts[0] = Part::opaque;
  EXPECT_EQ(of_wood.part(), 0u);
}

TEST(TouchingFaces, AreThoseOfClosedMeshesHoweverTheyAreWound) {
  geometry::TriangleMesh turned = block();
  for (std::size_t t = 0; t < turned.triangle_count(); ++t)
    std::swap(turned.indices[3 * t + 1], turned.indices[3 * t + 2]);
  Pair inside_out(turned, {}, sheet(), kFloor);
  EXPECT_EQ(inside_out.part(), 2u);
  EXPECT_LT(inside_out.corner(0).z, -1);
  // A sheet has no side to which it could go, nor has one of two faces.
  Pair open(sheet(), kFloor, sheet(), kFloor);
  EXPECT_EQ(open.part(), 0u);
  geometry::TriangleMesh twice = sheet();
  twice.indices.insert(twice.indices.end(), {0, 2, 1, 0, 3, 2});
  Pair flat(twice, kFloor, sheet(), kFloor);
  EXPECT_EQ(flat.part(), 0u);
}

TEST(TouchingFaces, OfABasinGoBehindAllWalls) {
  geometry::TriangleMesh walls = block();  // but for the side above
  walls.indices.erase(walls.indices.begin() + 6, walls.indices.begin() + 12);
  Pair basin(block(), {}, walls, {});
  EXPECT_EQ(basin.part(), 10u);
  for (std::size_t k = 0; k < 8; ++k) {
    EXPECT_GT(std::abs(basin.corner(k).x), 1 + 0.4f * kStep);
    EXPECT_GT(std::abs(basin.corner(k).y), 1 + 0.4f * kStep);
  }
  EXPECT_LT(basin.corner(0).z, -1 - 0.4f * kStep);
  EXPECT_NEAR(basin.corner(7).z, 1, 0.1f * kStep);
}

TEST(TouchingFaces, MeetBehindTheWallsAtSharpEdgesToo) {
  // Sheared: of its edges some have angles of 34 degrees.
  const auto sheared = [](geometry::TriangleMesh mesh) {
    for (Vec3f& p : mesh.positions) p.x += 1.5f * p.z;
    return mesh;
  };
  Pair filled(sheared(block()), {}, sheared(block()), {});
  EXPECT_EQ(filled.part(), 12u);
  for (std::size_t k = 0; k < 8; ++k) {
    const Vec3f p = filled.corner(k);
    EXPECT_GT(std::abs(p.z), 1 + 0.4f * kStep);
    EXPECT_GT(std::abs(p.x - 1.5f * p.z), 1 + 0.4f * kStep);
  }
}

// Whose middle and corners are far from anything on it.
TEST(TouchingFaces, OfATableGoIntoWhatStandsOnIt) {
  Pair table(block(), Transform::scale(1, 1, 0.1), block(),
             Transform::translate(0.5, -0.35, 0.2) * Transform::scale(0.05, 0.05, 0.1));
  EXPECT_GE(table.part(), 1u);
  EXPECT_GT(table.corner(4).z, 0.1f + 0.2f * kStep);
}

TEST(TouchingFaces, AreFoundWhereMeshesAreTurnedAndScaled) {
  const Transform placed = Transform::translate(3, 2, 1) * Transform::rotate(1, 2, 3, 40);
  Pair turned(block(), placed * Transform::scale(2, 0.5, 0.25), sheet(),
              placed * Transform::translate(0, 0, -0.25) * Transform::scale(4, 4, 1));
  EXPECT_EQ(turned.part(), 2u);
  const Vec3f down = placed.vector(Vec3f{0, 0, -1});
  for (std::size_t k = 0; k < 4; ++k)
    EXPECT_GT(dot(turned.corner(k) - placed.point({0, 0, -0.25f}), down), 0.3f * kStep);
}

// A glass whose inside is a block that water fills.
geometry::TriangleMesh vessel() {
  geometry::TriangleMesh mesh = block();
  for (const Vec3f p : block().positions) mesh.positions.push_back(p * 0.5f);
  for (std::size_t t = 0; t < block().triangle_count(); ++t)
    for (const std::size_t c : {0, 2, 1}) mesh.indices.push_back(8 + block().indices[3 * t + c]);
  return mesh;
}

TEST(TouchingFaces, OfWaterGoIntoTheGlassAroundIt) {
  for (const Part water : {Part::clear, Part::medium}) {
    Pair filled(vessel(), {}, block(), Transform::scale(0.5, 0.5, 0.5));
    filled.parts[1] = water;
    EXPECT_EQ(filled.part(), 12u);
    for (std::size_t k = 0; k < 16; ++k) EXPECT_EQ(filled.meshes[0].positions[k], vessel().positions[k]);
    for (std::size_t k = 0; k < 8; ++k) {
      const Vec3f p = filled.placements[1].to_world.point(filled.meshes[1].positions[k]);
      EXPECT_NEAR(std::abs(p.x), 0.5f + 1.5f * kStep, 0.05f * kStep);
      EXPECT_NEAR(std::abs(p.z), 0.5f + 1.5f * kStep, 0.05f * kStep);
    }
    filled.parts[0] = Part::medium;
    EXPECT_EQ(filled.part(), 0u);
  }
  // Whichever comes first.
  Pair first(block(), Transform::scale(0.5, 0.5, 0.5), vessel(), {});
  first.parts[1] = Part::clear;
  EXPECT_EQ(first.part(), 12u);
  EXPECT_EQ(first.meshes[1].positions[8].x, vessel().positions[8].x);
  Pair media(vessel(), {}, block(), Transform::scale(0.5, 0.5, 0.5));
  media.parts = {Part::medium, Part::medium};
  EXPECT_EQ(media.part(), 0u);
}

TEST(TouchingFaces, OfLampsComeOutOfTheCeiling) {
  // A sheet and the side of a box, both shining upwards, flush with what is around them.
  for (const bool box : {false, true}) {
    Pair lamp(box ? block() : sheet(), {}, sheet(),
              Transform::translate(0, 0, box ? 1 : 0) * Transform::scale(4, 3, 1));
    lamp.parts[0] = Part::opaque;
    EXPECT_EQ(lamp.part(), 0u);
    lamp.parts = {Part::lamp, Part::lamp};
    EXPECT_EQ(lamp.part(), 0u);
    lamp.parts[1] = Part::opaque;
    EXPECT_EQ(lamp.part(), 2u);
    EXPECT_GT(lamp.corner(box ? 7 : 2).z, (box ? 1 : 0) + 0.4f * kStep);
    EXPECT_EQ(lamp.corner(0).z, box ? -1.0f : lamp.corner(2).z);
    EXPECT_EQ(lamp.part(), 0u);
  }
}

TEST(TouchingFaces, OfLampsAreSeen) {
  auto desc = empty_scene();
  shine(desc, add_shape(desc, sd::RectangleDesc{}), {.value = Rgb(1)});
  add_shape(desc, sd::RectangleDesc{}, Transform::scale(3, 3, 1));
  const World world = build(desc);
  EXPECT_EQ(world.info().touching_faces, 2u);
  for (const float x : {-0.9f, -0.3f, 0.2f, 0.7f}) {
    const auto lamp = world.intersect(ray({x, 0.1f, 2}, {0, 0, -1}));
    const auto behind = world.intersect(ray({x, 0.1f, -2}, {0, 0, 1}));
    ASSERT_TRUE(lamp && behind);
    EXPECT_EQ(lamp->emitter, 0);
    EXPECT_EQ(behind->emitter, -1);
  }
}

// By the rays of a world: what stands behind glass is met though both lie in one plane.
TEST(TouchingFaces, LeaveTheFloorInSight) {
  auto desc = empty_scene();
  const int glass = add_bsdf(desc, sd::DielectricDesc{});
  const int cube = add_shape(desc, sd::CubeDesc{});
  desc.shapes[static_cast<std::size_t>(cube)].bsdf = glass;
  add_shape(desc, sd::RectangleDesc{}, kFloor);
  const World world = build(desc);
  EXPECT_EQ(world.info().touching_faces, 2u);
  for (const float x : {-0.9f, -0.4f, 0.1f, 0.7f})
    for (const float y : {-0.8f, 0.0f, 0.3f, 0.95f}) {
      const auto hit = world.intersect(ray({x, y, 0.5f}, {0.02f, -0.01f, -1}));
      ASSERT_TRUE(hit);
      EXPECT_EQ(hit->hit.instance, 1u);
      EXPECT_EQ(hit->point.position.z, -1);
    }
}

}  // namespace
}  // namespace lumirank::world
