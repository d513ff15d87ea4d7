// Structures that follow their vertices instead of being built anew.
#include <gtest/gtest.h>

#include <cmath>

#include "random_scene.h"

namespace lumirank::geometry {
namespace {

constexpr std::size_t kTriangles = 300;

// A mesh that bends, beside one that stands still, one that is too small and one that is placed twice.
struct Bending {
  std::vector<SharedMesh> still = {share_mesh(random_mesh(2, 40, 0.3f)),
                                   share_mesh(random_mesh(3, 500, 0.1f))};
  TriangleMesh bent = random_mesh(1, kTriangles, 0.3f), small = random_mesh(4, 20, 0.3f);
  Blocking blocking;

  // `before` is traced no more.
  RayScene at(double time, const RayScene* before, const Transform& to_world = {}) const {
    TriangleMesh meshes[2] = {bent, small};
    for (TriangleMesh& mesh : meshes)
      for (Vec3f& p : mesh.positions) p.y += static_cast<float>(0.3 * std::sin(3 * p.x + 5 * time));
    std::vector<SharedMesh> all = {share_mesh(std::move(meshes[0])), share_mesh(std::move(meshes[1]))};
    all.insert(all.end(), still.begin(), still.end());
    const std::vector<Placement> placements = {{0, to_world, blocking},
                                               {1, {}, Blocking::opaque},
                                               {2, {}, Blocking::opaque},
                                               {3, {}, blocking},
                                               {3, Transform::translate(0.1, 0.2, 0.3), Blocking::opaque}};
    return RayScene(std::move(all), placements, constant_callbacks(0.5f, Rgb(0.5f)), {before, 100, true},
                    100);
  }
};

// All but what rounding decides: Embree has other arithmetic for the triangles of what can be refitted.
void expect_alike(const RayScene& a, const RayScene& b) {
  const Bounds3f x = a.bounds(), y = b.bounds();
  for (const Vec3f& d : {x.lo - y.lo, x.hi - y.hi}) EXPECT_LT(length(d), 1e-5f);
  Rng rng(5, Stage::test);
  int hits = 0, bent = 0, different = 0;
  for (int n = 0; n < 3000; ++n) {
    const Ray ray{random_point(rng) * 2.0f, random_point(rng), 0, 4};
    const auto p = a.intersect(ray), q = b.intersect(ray);
    different += a.occluded(ray, 7) != b.occluded(ray, 7);
    different += std::abs(a.transmittance(ray).g - b.transmittance(ray).g) > 1e-6f;
    if (p.has_value() != q.has_value() || (p && (p->instance != q->instance || p->triangle != q->triangle))) {
      ++different;
    } else if (p) {
      ++hits, bent += p->instance == 0;
      EXPECT_NEAR(p->t, q->t, 1e-4f);
      EXPECT_NEAR(p->barycentric.x, q->barycentric.x, 1e-3f);
      EXPECT_NEAR(p->barycentric.y, q->barycentric.y, 1e-3f);
    }
  }
  for (int n = 0; n < 200; ++n) {
    const ShadowPacket packet = random_packet(rng);
    different += a.visible16(packet) != b.visible16(packet);
  }
  EXPECT_LE(different, 4);
  EXPECT_GT(hits, 500);
  EXPECT_GT(bent, 100);
}

class Refit : public testing::TestWithParam<Blocking> {};

// Over more moments than a structure is refitted in a row.
TEST_P(Refit, FollowsTheVertices) {
  const Bending bending{.blocking = GetParam()};
  std::vector<RayScene> scenes;
  scenes.reserve(20);
  scenes.push_back(bending.at(0, nullptr));
  for (int k = 1; k < 20; ++k) {
    const double time = 0.05 * k;
    scenes.push_back(bending.at(time, &scenes.back()));
    expect_alike(scenes.back(), bending.at(time, nullptr));
  }
  EXPECT_GT(scenes[1].memory_bytes(), scenes[2].memory_bytes() + 50 * kTriangles);  // built, then refitted
}

INSTANTIATE_TEST_SUITE_P(All, Refit,
                         testing::Values(Blocking::opaque, Blocking::cutout, Blocking::attenuating));

// A mesh that is moved as a whole; one that stands still for a while.
TEST(Refit, FollowsPlacementsAndPauses) {
  const Bending bending{.blocking = Blocking::opaque};
  const Transform turned = Transform::rotate(0, 1, 1, 20), moved = Transform::translate(0.1, 0, 0) * turned;
  const RayScene first = bending.at(0, nullptr);
  const RayScene second = bending.at(0, &first, turned);
  const RayScene third = bending.at(0, &second, moved);
  const RayScene pause = bending.at(0, &third, moved);
  expect_alike(pause, bending.at(0, nullptr, moved));
  const RayScene last = bending.at(0.1, &pause);
  expect_alike(last, bending.at(0.1, nullptr));
}

// Other triangles are another structure.
TEST(Refit, IsNotOfOtherTriangles) {
  Bending bending{.blocking = Blocking::opaque};
  const RayScene first = bending.at(0, nullptr);
  const RayScene second = bending.at(0.1, &first);
  std::swap(bending.bent.indices[0], bending.bent.indices[5]);
  const RayScene third = bending.at(0.2, &second);
  expect_alike(third, bending.at(0.2, nullptr));
  bending.bent.indices.resize(3 * (kTriangles - 50));
  expect_alike(bending.at(0.3, &third), bending.at(0.3, nullptr));
}

}  // namespace
}  // namespace lumirank::geometry
