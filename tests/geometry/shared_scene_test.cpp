// Scenes of several moments that share what does not move.
#include <gtest/gtest.h>

#include "random_scene.h"

namespace lumirank::geometry {
namespace {

// A mesh in world space, a small one with three copies, a larger one that is instanced; `moved`: which
// placement stands elsewhere.
struct Moment {
  std::vector<Placement> placements;
  explicit Moment(Blocking blocking, int moved = -1) {
    const auto place = [&](std::uint32_t mesh, Transform t) {
      if (static_cast<int>(placements.size()) == moved) t = Transform::translate(0.3, 0.1, -0.2) * t;
      placements.push_back({mesh, t, blocking});
    };
    place(0, Transform{});
    place(1, Transform{});
    place(1, Transform::scale(-1, 1, 1));
    place(1, Transform::translate(0.3, 0, -0.2));
    place(2, Transform{});
    place(2, Transform::translate(0.1, 0.2, 0.3) * Transform::scale(1, -0.5, 1));
    place(2, Transform::rotate(0, 1, 1, 70));
    // Half of them attenuate, if any do.
    for (std::size_t k = 0; k < placements.size(); k += 2)
      if (blocking == Blocking::attenuating) placements[k].blocking = Blocking::opaque;
  }
};

constexpr std::size_t kFlatten = 100;  // triangles

std::vector<SharedMesh> three_meshes() {
  return {share_mesh(random_mesh(1, 40, 0.3f)), share_mesh(random_mesh(2, 25, 0.3f)),
          share_mesh(random_mesh(3, 60, 0.2f))};
}

RayScene scene_of(const std::vector<SharedMesh>& meshes, const Moment& moment,
                  const RayScene* before = nullptr, std::size_t least = 1) {
  return RayScene(meshes, moment.placements, constant_callbacks(0.5f, Rgb(0.5f)), {before, least}, kFlatten);
}

void expect_same_answers(const RayScene& a, const RayScene& b) {
  EXPECT_EQ(a.bounds().lo.x, b.bounds().lo.x);
  EXPECT_EQ(a.bounds().hi.z, b.bounds().hi.z);
  Rng rng(5, Stage::test);
  int hits = 0;
  for (int n = 0; n < 2000; ++n) {
    const Vec3f o = random_point(rng) * 2.0f, d = random_point(rng);
    const Ray ray{o, d, 0, 4};
    const auto x = a.intersect(ray), y = b.intersect(ray);
    ASSERT_EQ(x.has_value(), y.has_value());
    EXPECT_EQ(a.occluded(ray, 7), b.occluded(ray, 7));
    const Rgb p = a.transmittance(ray), q = b.transmittance(ray);
    EXPECT_EQ(p.r, q.r);
    if (!x) continue;
    ++hits;
    EXPECT_EQ(x->t, y->t);
    EXPECT_EQ(x->instance, y->instance);
    EXPECT_EQ(x->triangle, y->triangle);
    EXPECT_EQ(x->barycentric.x, y->barycentric.x);
  }
  EXPECT_GT(hits, 100);
  for (int n = 0; n < 100; ++n) {
    const ShadowPacket packet = random_packet(rng);
    EXPECT_EQ(a.visible16(packet), b.visible16(packet));
  }
}

class SharedScene : public testing::TestWithParam<Blocking> {};

TEST_P(SharedScene, AnswersAsOneOfItsOwn) {
  const auto meshes = three_meshes();
  const RayScene first = scene_of(meshes, Moment(GetParam()));
  for (int moved = 0; moved < 7; ++moved) {
    const Moment now(GetParam(), moved);
    expect_same_answers(scene_of(meshes, now, &first), scene_of(meshes, now));
  }
}

// What was found still is kept over moments, until some of it moves.
TEST_P(SharedScene, GoesOnOverMoments) {
  const auto meshes = three_meshes();
  std::vector<RayScene> scenes;
  scenes.reserve(6);
  scenes.push_back(scene_of(meshes, Moment(GetParam())));
  for (const int moved : {5, 4, 5, 1, 5}) {
    const Moment now(GetParam(), moved);
    scenes.push_back(scene_of(meshes, now, &scenes.back()));
    expect_same_answers(scenes.back(), scene_of(meshes, now));
  }
  EXPECT_LT(scenes[3].memory_bytes(), scenes[1].memory_bytes());  // the third only has what it needs of it
}

TEST_P(SharedScene, OutlivesTheOneBefore) {
  const auto meshes = three_meshes();
  std::optional<RayScene> first = scene_of(meshes, Moment(GetParam()));
  const RayScene second = scene_of(meshes, Moment(GetParam(), 6), &*first);
  const RayScene same = scene_of(meshes, Moment(GetParam()), &*first);
  first.reset();
  EXPECT_EQ(same.memory_bytes(), 0u);
  expect_same_answers(second, scene_of(meshes, Moment(GetParam(), 6)));
  expect_same_answers(same, scene_of(meshes, Moment(GetParam())));
}

INSTANTIATE_TEST_SUITE_P(All, SharedScene,
                         testing::Values(Blocking::opaque, Blocking::cutout, Blocking::attenuating));

// Little is built again, and then traced without an instance around it.
TEST(SharedScene, OfLittleIsNotWorthIt) {
  const auto meshes = three_meshes();
  const RayScene first = scene_of(meshes, Moment(Blocking::opaque));
  const Moment now(Blocking::opaque, 5);
  const RayScene shares = scene_of(meshes, now, &first, 10), builds = scene_of(meshes, now, &first, 1000);
  expect_same_answers(shares, builds);
}

}  // namespace
}  // namespace lumirank::geometry
