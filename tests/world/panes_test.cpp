// Which glass is a pane, and that light passes it straight.
#include "world/panes.h"

#include <gtest/gtest.h>

#include "geometry/tessellate.h"
#include "world/light_sampler.h"
#include "world/plain_meshes.h"
#include "world/scene_maker.h"

namespace lumirank::world {
namespace {

using namespace test;

// Both meshes, the second one moved.
geometry::TriangleMesh both(geometry::TriangleMesh a, const geometry::TriangleMesh& b,
                            const Transform& moved) {
  const auto first = static_cast<std::uint32_t>(a.positions.size());
  for (const Vec3f p : b.positions) a.positions.push_back(moved.point(p));
  for (const std::uint32_t i : b.indices) a.indices.push_back(first + i);
  return a;
}

TEST(Panes, AreThinPlatesHoweverTheyStand) {
  const Transform turned = Transform::rotate(1, 2, 3, 40) * Transform::translate(5, 6, 7);
  EXPECT_TRUE(is_made_of_panes(block(), turned * Transform::scale(1, 0.6, 0.005)));
  EXPECT_TRUE(is_made_of_panes(block(), turned * Transform::scale(0.02, 0.5, 3)));
  EXPECT_FALSE(is_made_of_panes(block(), turned * Transform::scale(1, 1, 0.4)));
  EXPECT_FALSE(is_made_of_panes(block(), turned));
  EXPECT_FALSE(is_made_of_panes(block(), Transform::scale(1, 0.01, 0.01)));  // a rod
}

TEST(Panes, StandTogetherInOneMesh) {
  const Transform thin = Transform::scale(1, 1, 0.01);
  geometry::TriangleMesh plate = both({}, block(), thin);
  EXPECT_TRUE(is_made_of_panes(both(plate, block(), Transform::translate(3, 0, 1) * thin), {}));
  EXPECT_TRUE(
      is_made_of_panes(both(plate, block(), Transform::translate(0, 0, 0.1) * thin), {}));  // glazed twice
  EXPECT_FALSE(is_made_of_panes(both(plate, block(), Transform::translate(3, 0, 1)), {}));  // beside a block
}

TEST(Panes, NeedTwoFacesThatLookApart) {
  const Transform behind = Transform::translate(0, 0, -0.02);
  const Transform away = behind * Transform::rotate(1, 0, 0, 180);
  EXPECT_TRUE(is_made_of_panes(both(sheet(), sheet(), away), {}));
  EXPECT_FALSE(is_made_of_panes(both(sheet(), sheet(), behind), {}));
  EXPECT_FALSE(is_made_of_panes(sheet(), {}));
  EXPECT_FALSE(is_made_of_panes(both(sheet(), sheet(), away * Transform::scale(0.5, 0.5, 1)), {}));
  EXPECT_FALSE(is_made_of_panes({}, {}));
}

// The same face from behind.
geometry::TriangleMesh inside_out(geometry::TriangleMesh mesh) {
  for (Vec3f& n : mesh.normals) n = -n;
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t)
    std::swap(mesh.indices[3 * t + 1], mesh.indices[3 * t + 2]);
  return mesh;
}

// A hollow ball whose wall is so thick.
geometry::TriangleMesh globe(float wall, int rings = 24) {
  geometry::TriangleMesh mesh = geometry::make_sphere({0, 0, 0}, 1, rings);
  const geometry::TriangleMesh inner = inside_out(geometry::make_sphere({0, 0, 0}, 1 - wall, rings));
  const auto first = static_cast<std::uint32_t>(mesh.positions.size());
  mesh.positions.insert(mesh.positions.end(), inner.positions.begin(), inner.positions.end());
  mesh.normals.insert(mesh.normals.end(), inner.normals.begin(), inner.normals.end());
  for (const std::uint32_t i : inner.indices) mesh.indices.push_back(first + i);
  mesh.uvs.clear();
  return mesh;
}

TEST(Panes, MayBeBentAsThinWalls) {
  const Transform placed = Transform::rotate(1, 2, 3, 40) * Transform::scale(0.2, 0.2, 0.3);
  EXPECT_TRUE(is_made_of_panes(globe(0.02f), placed));
  EXPECT_TRUE(is_made_of_panes(globe(0.02f), placed * Transform::scale(-1, 1, 1)));
  // Thin against its size, but it bends what goes aslant.
  EXPECT_FALSE(is_made_of_panes(globe(0.2f), Transform::scale(0.2, 0.2, 0.2)));
  EXPECT_FALSE(is_made_of_panes(geometry::make_sphere({0, 0, 0}, 1, 24), placed));
  EXPECT_FALSE(is_made_of_panes(inside_out(globe(0.02f)), placed));
  // Each facet of a wall is a pane, but those of a cut stone are not.
  geometry::TriangleMesh wall = globe(0.02f, 6), stone = geometry::make_sphere({0, 0, 0}, 1, 6);
  wall.normals.clear(), stone.normals.clear();
  EXPECT_TRUE(is_made_of_panes(wall, placed));
  EXPECT_FALSE(is_made_of_panes(stone, placed));
  // A shallow lens is no sheet of even thickness.
  const Transform flat = Transform::scale(1, 1, 0.3);
  EXPECT_FALSE(is_made_of_panes(geometry::make_sphere({0, 0, 0}, 1, 24), flat));
}

World build_straight(const sd::SceneDesc& desc) {
  std::vector<sd::Warning> warnings;
  BuildOptions options;
  options.straight_panes = true;
  return World::build(desc, options, warnings);
}

TEST(Panes, OtherGlassIsCounted) {
  auto desc = empty_scene();
  const int glass = add_bsdf(desc, sd::DielectricDesc{});
  for (const float height : {0.01f, 0.5f}) {
    const int shape = add_shape(desc, sd::CubeDesc{}, Transform::scale(1, 1, height));
    desc.shapes[static_cast<std::size_t>(shape)].bsdf = glass;
  }
  const World world = build_straight(desc);
  EXPECT_EQ(world.info().panes, 1u);
  EXPECT_EQ(world.info().bending_glass, 1u);
}

TEST(Panes, LetShadowRaysPassWithWhatASlabLetsThrough) {
  auto desc = empty_scene();
  const int glass = add_bsdf(desc, sd::DielectricDesc{});
  const int shape = add_shape(desc, sd::CubeDesc{}, Transform::scale(1, 1, 0.01));
  desc.shapes[static_cast<std::size_t>(shape)].bsdf = glass;
  const World bends = build(desc);
  const World passes = build_straight(desc);
  EXPECT_EQ(bends.info().panes, 0u);
  EXPECT_EQ(passes.info().panes, 1u);
  EXPECT_EQ(passes.info().bending_glass, 0u);
  const Vec3f from{0, 0, -1}, up{0, 0, 1};
  EXPECT_EQ(visible_fraction(bends, from, up, up, 2, 1), Rgb(0));
  // Each face reflects 4 %; what goes to and fro between them is left to paths.
  const float face = 0.04f;
  const Rgb through = visible_fraction(passes, from, up, up, 2, 1);
  EXPECT_NEAR(through.g, (1 - face) * (1 - face), 2e-3f);
  // The eye sees the glass.
  const auto hit = passes.intersect(ray(from, up));
  ASSERT_TRUE(hit);
  const auto& materials = passes.materials();
  EXPECT_EQ(materials.passage(hit->material), scatter::MaterialSet::Passage::attenuating);
  EXPECT_EQ(materials.passage(materials.seen(hit->material)), scatter::MaterialSet::Passage::opaque);
}

}  // namespace
}  // namespace lumirank::world
