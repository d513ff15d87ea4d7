#include "geometry/ray_scene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>

#include "base/error.h"
#include "base/parallel.h"
#include "base/random.h"
#include "brute_force.h"
#include "geometry/tessellate.h"
#include "random_scene.h"

namespace lumirank::geometry {
namespace {

// A mesh placed once and moved, a small one placed three times (one copy mirrored, one sheared), and a larger
// one placed three times (one copy mirrored), which with this limit is instanced but where its transform is
// the identity.
constexpr std::size_t kTestFlattenLimit = 100;

RayScene mixed_scene(Blocking blocking = Blocking::opaque) {
  std::vector<TriangleMesh> meshes{random_mesh(1, 40, 0.3f), random_mesh(2, 25, 0.3f),
                                   random_mesh(3, 60, 0.2f)};
  Transform shear = Transform::translate(0.3, 0, -0.2);
  shear.m[1] = 0.7;
  std::vector<Placement> placements;
  auto place = [&](std::uint32_t mesh, const Transform& t) { placements.push_back({mesh, t, blocking}); };
  place(0, Transform::rotate(1, 2, 3, 40) * Transform::scale(0.5, 2, 1));
  place(1, Transform{});
  place(1, Transform::scale(-1, 1, 1));
  place(1, shear);
  place(2, Transform{});
  place(2, Transform::translate(0.1, 0.2, 0.3) * Transform::scale(1, -0.5, 1));
  place(2, Transform::translate(-0.1, -0.2, 0.3) * Transform::rotate(0, 1, 1, 70));
  return RayScene(std::move(meshes), std::move(placements), constant_callbacks(0.5f, Rgb(0.5f)),
                  kTestFlattenLimit);
}

// Crossings that rounding could decide either way make a ray unfit for comparison.
bool is_clear(const std::vector<Crossing>& crossings, double t_min, double t_max) {
  for (const Crossing& c : crossings) {
    if (std::abs(c.margin) < 1e-4) return false;
    if (std::abs(c.t - t_min) < 1e-4 || std::abs(c.t - t_max) < 1e-4) return false;
  }
  return true;
}

TEST(RayScene, ClosestHitAgreesWithBruteForce) {
  const RayScene scene = mixed_scene();
  Rng rng(11, Stage::test);
  int compared = 0, hits = 0;
  std::vector<int> per_instance(scene.placements().size());
  while (compared < 2000) {
    const Vec3f o = random_point(rng) * 2.0f, d = random_point(rng) * 0.7f;
    std::vector<Crossing> all = all_crossings(scene, o, d);
    if (!is_clear(all, 0, 4)) continue;
    ++compared;
    std::erase_if(all, [](const Crossing& c) { return c.margin < 0 || c.t < 0 || c.t > 4; });
    std::sort(all.begin(), all.end(), [](const Crossing& a, const Crossing& b) { return a.t < b.t; });
    const std::optional<Hit> hit = scene.intersect({o, d, 0, 4});
    ASSERT_EQ(hit.has_value(), !all.empty());
    EXPECT_EQ(scene.occluded({o, d, 0, 4}, 1), hit.has_value());
    if (!hit) continue;
    if (all.size() > 1 && all[1].t - all[0].t < 1e-4) continue;
    ++hits;
    EXPECT_EQ(hit->instance, all[0].instance);
    EXPECT_EQ(hit->mesh, scene.placements()[all[0].instance].mesh);
    EXPECT_EQ(hit->triangle, all[0].triangle);
    EXPECT_NEAR(hit->t, all[0].t, 1e-4);
    // An error of the ray's position of 1e-6 is magnified by what a small triangle makes of it.
    EXPECT_NEAR(hit->barycentric.x, all[0].u, 1e-3);
    EXPECT_NEAR(hit->barycentric.y, all[0].v, 1e-3);
    ++per_instance[hit->instance];
  }
  EXPECT_GT(hits, 100);
  for (const int n : per_instance) EXPECT_GT(n, 0);
}

Vec3f origin(const ShadowPacket& p, int k) { return {p.ox[k], p.oy[k], p.oz[k]}; }
Vec3f direction(const ShadowPacket& p, int k) { return {p.dx[k], p.dy[k], p.dz[k]}; }
Ray segment(const ShadowPacket& p, int k) {
  return {origin(p, k), direction(p, k), kShadowEpsilon, p.t_far[k] * (1 - kShadowEpsilon)};
}

TEST(RayScene, PacketsAgreeWithBruteForceAndSingleRays) {
  const RayScene scene = mixed_scene();
  Rng rng(12, Stage::test);
  int blocked = 0, open = 0;
  for (int n = 0; n < 40; ++n) {
    const ShadowPacket p = random_packet(rng);
    const unsigned visible = scene.visible16(p);
    for (int k = 0; k < 16; ++k) {
      const bool is_visible = visible >> k & 1;
      if (!p.valid[k]) {
        EXPECT_FALSE(is_visible);
        continue;
      }
      const std::vector<Crossing> all = all_crossings(scene, origin(p, k), direction(p, k));
      if (!is_clear(all, 0, p.t_far[k])) continue;
      const bool is_blocked = std::any_of(all.begin(), all.end(), [&](const Crossing& c) {
        return c.margin > 0 && c.t > 0 && c.t < p.t_far[k];
      });
      EXPECT_EQ(is_visible, !is_blocked);
      EXPECT_EQ(scene.occluded(segment(p, k), p.key(k)), is_blocked);
      (is_blocked ? blocked : open) += 1;
    }
  }
  EXPECT_GT(blocked, 50);
  EXPECT_GT(open, 50);
}

// Segments between two points of a plane's two sides' surfaces: neither end's own surface counts.
TEST(RayScene, SegmentsAreOpenAtBothEnds) {
  const RayScene scene(
      {make_rectangle()},
      {{0, Transform{}, Blocking::opaque}, {0, Transform::translate(0, 0, 2), Blocking::opaque}}, {});
  ShadowPacket p{};
  for (int k = 0; k < 16; ++k) {
    p.ox[k] = 0.05f * static_cast<float>(k), p.oy[k] = 0.1f;
    p.dz[k] = 2, p.t_far[k] = 1, p.valid[k] = -1;
    if (k % 2 == 1) p.dz[k] = 2.1f;  // past the upper plane
  }
  EXPECT_EQ(scene.visible16(p), 0x5555);
}

// A plane of many small quads in front of a light: opacity a blocks with probability a, independently for
// each key. The number of blocked segments is binomial; |z| ≤ 4.9 holds with probability 1 - 1e-6 for each of
// the opacities.
TEST(RayScene, CutoutsBlockWithTheirOpacity) {
  for (const float opacity : {0.0f, 0.1f, 0.5f, 0.9f, 1.0f}) {
    for (const bool instanced : {false, true}) {
      std::vector<TriangleMesh> meshes{make_rectangle()};
      std::vector<Placement> placements{{0, Transform{}, Blocking::cutout}};
      if (instanced) placements.push_back({0, Transform::translate(0, 0, 50), Blocking::cutout});
      if (instanced) placements[0].to_world = Transform::translate(0, 0, 0.25);
      const RayScene scene(std::move(meshes), std::move(placements), constant_callbacks(opacity, Rgb(1)),
                           instanced ? 0 : RayScene::kFlattenLimit);
      Rng rng(13, Stage::test);
      const int packets = 1250;
      int blocked = 0;
      for (int n = 0; n < packets; ++n) {
        ShadowPacket p{};
        for (int k = 0; k < 16; ++k) {
          p.ox[k] = 0.9f * (2 * rng.next_float() - 1), p.oy[k] = 0.9f * (2 * rng.next_float() - 1);
          p.oz[k] = -1, p.dz[k] = 2, p.t_far[k] = 1, p.valid[k] = -1;
          p.from[k] = n, p.to[k] = k;
        }
        const unsigned visible = scene.visible16(p);
        EXPECT_EQ(scene.visible16(p), visible);  // the same keys decide the same
        for (int k = 0; k < 16; ++k) {
          blocked += !(visible >> k & 1);
          EXPECT_EQ(scene.occluded(segment(p, k), p.key(k)), !(visible >> k & 1));
        }
      }
      const double trials = 16.0 * packets, sigma = std::sqrt(trials * opacity * (1 - opacity));
      EXPECT_LE(std::abs(blocked - trials * opacity), 4.9 * sigma) << "opacity " << opacity;
      // The closest hit is there whatever the opacity.
      EXPECT_TRUE(scene.intersect({{0.1f, 0.2f, -1}, {0, 0, 1}}).has_value());
    }
  }
}

// Two planes are decided independently: the chance to pass both is (1 - a)².
TEST(RayScene, CutoutsInARowAreIndependent) {
  const float opacity = 0.4f;
  const RayScene scene(
      {make_rectangle()},
      {{0, Transform{}, Blocking::cutout}, {0, Transform::translate(0, 0, 1), Blocking::cutout}},
      constant_callbacks(opacity, Rgb(1)));
  const int trials = 20000;
  int open = 0;
  for (int n = 0; n < trials; ++n) open += !scene.occluded({{0.3f, -0.2f, -1}, {0, 0, 1}, 0, 5}, n);
  const double pass = (1 - opacity) * (1 - opacity), sigma = std::sqrt(trials * pass * (1 - pass));
  EXPECT_LE(std::abs(open - trials * pass), 4.9 * sigma);  // fails by chance once in 1e6
}

TEST(RayScene, TransmittanceIsTheProductOverTheCrossings) {
  const RayScene scene = mixed_scene(Blocking::attenuating);
  EXPECT_TRUE(scene.has_attenuating());
  Rng rng(14, Stage::test);
  int several = 0;
  for (int n = 0; n < 40; ++n) {
    const ShadowPacket p = random_packet(rng);
    unsigned valid = 0;
    for (int k = 0; k < 16; ++k) valid |= static_cast<unsigned>(p.valid[k] != 0) << k;
    EXPECT_EQ(scene.visible16(p), valid);  // attenuating surfaces never block
    Rgb out[16];
    scene.transmittance16(p, out);
    for (int k = 0; k < 16; ++k) {
      if (!p.valid[k]) continue;
      const std::vector<Crossing> all = all_crossings(scene, origin(p, k), direction(p, k));
      if (!is_clear(all, 0, p.t_far[k])) continue;
      const auto crossed = std::count_if(all.begin(), all.end(), [&](const Crossing& c) {
        return c.margin > 0 && c.t > 0 && c.t < p.t_far[k];
      });
      // Each crossing halves: powers of two are exact.
      EXPECT_EQ(out[k], Rgb(std::ldexp(1.0f, -static_cast<int>(crossed))));
      EXPECT_EQ(scene.transmittance(segment(p, k)), out[k]);
      several += crossed > 1;
    }
  }
  EXPECT_GT(several, 30);
}

// A ray through the diagonal of a quad crosses the pane once.
TEST(RayScene, ThePaneBetweenTwoTrianglesCountsOnce) {
  const RayScene scene(
      {make_rectangle(), make_cube()},
      {{0, Transform{}, Blocking::attenuating}, {1, Transform::translate(9, 0, 0), Blocking::opaque}},
      constant_callbacks(1, Rgb(0.5f, 0.25f, 1)));
  for (const float x : {-0.5f, 0.0f, 0.125f, 0.75f})
    EXPECT_EQ(scene.transmittance({{x, x, -1}, {0, 0, 1}, 0, 5}), Rgb(0.5f, 0.25f, 1)) << x;
  EXPECT_EQ(scene.transmittance({{9, 0, -2}, {0, 0, 1}, 0, 5}), Rgb(1));  // what is opaque does not attenuate
  EXPECT_TRUE(scene.intersect({{0.1f, 0.3f, -1}, {0, 0, 1}}).has_value());
}

TEST(RayScene, AnswersDoNotDependOnTheNumberOfThreads) {
  std::vector<std::vector<unsigned>> answers;
  for (const int threads : {1, 4}) {
    with_threads(threads, [&] {
      const RayScene scene({random_mesh(5, 30000, 0.05f)}, {{0, Transform{}, Blocking::opaque}}, {});
      Rng rng(15, Stage::test);
      std::vector<unsigned>& a = answers.emplace_back();
      for (int n = 0; n < 500; ++n) {
        const ShadowPacket p = random_packet(rng);
        a.push_back(scene.visible16(p));
        const std::optional<Hit> hit = scene.intersect(segment(p, 0));
        a.push_back(hit ? hit->triangle : 0xffffffffu);
        if (hit) a.push_back(std::bit_cast<unsigned>(hit->t));
      }
    });
  }
  EXPECT_EQ(answers[0], answers[1]);
}

TEST(RayScene, BoundsHoldAllPlacements) {
  const RayScene scene(
      {make_rectangle()},
      {{0, Transform::translate(1, 2, 3), Blocking::opaque}, {0, Transform{}, Blocking::attenuating}}, {});
  const Bounds3f box = scene.bounds();
  EXPECT_EQ(box.lo, (Vec3f{-1, -1, 0}));
  EXPECT_EQ(box.hi, (Vec3f{2, 3, 3}));
  EXPECT_GT(scene.memory_bytes(), 0u);
}

TEST(RayScene, StrangeInputIsRefusedOrHarmless) {
  EXPECT_THROW(RayScene({}, {}, {}), InputError);
  EXPECT_THROW(RayScene({make_cube()}, {}, {}), InputError);
  EXPECT_THROW(RayScene({TriangleMesh{}}, {{0, Transform{}}}, {}), InputError);
  Transform projective;
  projective.m[12] = 0.5;
  EXPECT_THROW(RayScene({make_cube()}, {{0, projective}}, {}), InputError);
  Transform broken;
  broken.m[0] = std::nan("");
  EXPECT_THROW(RayScene({make_cube()}, {{0, broken}}, {}), InputError);
  TriangleMesh wild = make_cube();
  wild.indices[4] = 99;
  EXPECT_THROW(RayScene({wild}, {{0, Transform{}}}, {}), InternalError);
  EXPECT_THROW(RayScene({make_cube()}, {{7, Transform{}}}, {}), InternalError);

  // Degenerate triangles, and a cube pressed flat, twice (so that it would be instanced, were it large).
  TriangleMesh points = make_rectangle();
  points.indices.insert(points.indices.end(), {0, 0, 0, 1, 1, 2});
  const Transform flat = Transform::scale(1, 1, 0);
  const RayScene scene({points, make_cube()}, {{0, Transform::translate(0, 0, 5)}, {1, flat}, {1, flat}}, {});
  const std::optional<Hit> hit = scene.intersect({{0.3f, 0.4f, -3}, {0, 0, 1}});
  ASSERT_TRUE(hit.has_value());
  EXPECT_FLOAT_EQ(hit->t, 3);
  EXPECT_FALSE(scene.intersect({{3, 3, -3}, {0, 0, 1}}).has_value());
  // A direction of no length, and rays that are not finite, hit nothing and do not crash.
  EXPECT_FALSE(scene.intersect({{0, 0, -3}, {0, 0, 0}}).has_value());
  const Vec3f nowhere{0, 0, std::nanf("")};
  EXPECT_FALSE(scene.intersect({{0, 0, -3}, nowhere}).has_value());
  EXPECT_TRUE(scene.occluded({{0, 0, -3}, nowhere, 0, 1}, 0));
  EXPECT_EQ(scene.transmittance({nowhere, {0, 0, 1}}), Rgb(1));
  ShadowPacket p{};
  for (int k = 0; k < 16; ++k) {
    p.ox[k] = 5, p.dy[k] = 1, p.t_far[k] = 1, p.valid[k] = -1;
    if (k % 3 == 1) p.dz[k] = std::nanf("");
    if (k % 3 == 2) p.ox[k] = kInfinity;
  }
  EXPECT_EQ(scene.visible16(p), 0b1001001001001001);
}

}  // namespace
}  // namespace lumirank::geometry
