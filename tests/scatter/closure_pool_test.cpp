#include "scatter/closure_pool.h"

#include <gtest/gtest.h>

#include "base/random.h"
#include "base/warp.h"

namespace lumirank::scatter {
namespace {

scatter::Closure closure_of(Vec3f normal, Vec3f tangent, Rgb base, float alpha) {
  scatter::Closure c;
  c.frame = Frame::from_normal_tangent(normal, tangent);
  c.ng = normal;
  scatter::Lobe diffuse;
  diffuse.color = base;
  scatter::Lobe gloss;
  gloss.kind = scatter::LobeKind::microfacet_reflect;
  gloss.color = Rgb(0.25f);
  gloss.alpha_u = alpha, gloss.alpha_v = 2 * alpha;
  scatter::Lobe delta;
  delta.kind = scatter::LobeKind::delta_pass;
  delta.color = Rgb(0.5f);
  c.add(diffuse), c.add(delta), c.add(gloss);
  return c;
}

Vec3f direction(Rng& rng) { return warp_sphere(rng.next_2d()); }

TEST(ClosurePool, GivesBackFramesAndNonDeltaLobes) {
  ClosurePool pool;
  Rng rng(1, Stage::test);
  for (int k = 0; k < 200; ++k) {
    const Vec3f n = direction(rng);
    const scatter::Closure in = closure_of(n, direction(rng), Rgb(0.1f, 0.2f, 0.3f), 0.2f);
    const Vec3f kept = k % 2 ? n : -n;  // the owner may keep the opposite normal
    const auto id = pool.add(in, kept);
    const scatter::Closure out = pool.get(id, kept, k % 2 ? in.ng : -in.ng);
    ASSERT_EQ(out.count, 2);
    EXPECT_EQ(out.lobes[0].kind, scatter::LobeKind::diffuse);
    EXPECT_EQ(out.lobes[0].color, Rgb(0.1f, 0.2f, 0.3f));
    EXPECT_EQ(out.lobes[1].kind, scatter::LobeKind::microfacet_reflect);
    EXPECT_EQ(out.lobes[1].alpha_v, 0.4f);
    EXPECT_EQ(out.frame.n, in.frame.n);
    EXPECT_EQ(out.ng, in.ng);
    // A step of the octahedral map is 1/32767; its longest image on the sphere is under 3 of them, and making
    // the tangent orthogonal again can only shorten the difference.
    EXPECT_LT(length(out.frame.s - in.frame.s), 1e-4f);
  }
  EXPECT_EQ(pool.recipes(), 1u);
}

TEST(ClosurePool, SharesRecipesBetweenColors) {
  ClosurePool pool;
  for (int k = 0; k < 1000; ++k)
    pool.add(closure_of({0, 0, 1}, {1, 0, 0}, Rgb(static_cast<float>(k), 0.5f, 0.5f), k % 2 ? 0.1f : 0.2f),
             {0, 0, 1});
  EXPECT_EQ(pool.size(), 1000u);
  EXPECT_EQ(pool.recipes(), 2u);
  EXPECT_NE(pool.recipe(0), pool.recipe(1));
  EXPECT_EQ(pool.recipe(0), pool.recipe(998));
  EXPECT_EQ(pool.lobes(pool.recipe(5))[0].color, Rgb(1));
  EXPECT_EQ(pool.colors(5)[0], Rgb(5, 0.5f, 0.5f));
  pool.shrink();
  // 12 bytes per entry; one palette of two colors (24 bytes) and an offset (4) each.
  EXPECT_LE(pool.memory_bytes(), 1000u * (12 + 24 + 4) + 2 * 2 * sizeof(scatter::Lobe) + 64);
}

TEST(ClosurePool, AppendAndReorderKeepClosures) {
  ClosurePool a, b;
  const auto make = [](int k) {
    return closure_of({0, 0, 1}, {1, 0, 0}, Rgb(0.1f + 0.1f * static_cast<float>(k)), k % 2 ? 0.1f : 0.2f);
  };
  a.add(make(0), {0, 0, 1});
  b.add(make(1), {0, 0, 1}), b.add(make(2), {0, 0, 1});
  EXPECT_EQ(a.append(b), 1u);
  ASSERT_EQ(a.size(), 3u);
  EXPECT_EQ(a.recipes(), 2u);
  const std::uint32_t order[] = {2, 0};
  a.reorder(order);
  ASSERT_EQ(a.size(), 2u);
  EXPECT_EQ(a.colors(0)[0], make(2).lobes[0].color);
  EXPECT_EQ(a.colors(1)[0], make(0).lobes[0].color);
}

}  // namespace
}  // namespace lumirank::scatter
