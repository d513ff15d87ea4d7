// The sum of lobes of a coating against a random walk between its interface and its base.
#include <gtest/gtest.h>

#include <cmath>

#include "scatter/bsdf_list.h"
#include "scatter/layered_walk.h"

namespace lumirank::scatter {
namespace {

ConductorMaterial metal(float alpha) {
  return {Rgb(0.2f), Rgb(2.5f), gray(1), NormalDistribution::ggx, number(alpha), number(alpha), alpha == 0};
}
ConductorMaterial mirror(float alpha) {
  ConductorMaterial m = metal(alpha);
  m.eta = Rgb(0), m.k = Rgb(1);
  return m;
}

struct Stack {
  const char* name;
  Material base;
  float alpha, eta, depth;  // of the layer
  // Accuracy as docs/decisions.md states it: of the energy (relative), and the share of energy that leaves
  // into another of 64 cells of the hemisphere.
  double energy, elsewhere;
};

MaterialSet stacked(const Stack& s) {
  MaterialSet set;
  set.materials.push_back(s.base);
  set.materials.push_back(CoatingMaterial{s.eta, gray(1), gray(s.depth), number(1), NormalDistribution::ggx,
                                          number(s.alpha), number(s.alpha), false, 0, s.alpha == 0});
  return set;
}

const Stack kStacks[] = {
    {"matt, smooth", DiffuseMaterial{gray(0.8f)}, 0, 1.5f, 0, 0.01, 0.03},
    {"matt, smooth, absorbing", DiffuseMaterial{gray(0.8f)}, 0, 1.5f, 0.2f, 0.015, 0.03},
    {"matt, rough 0.1", DiffuseMaterial{gray(0.8f)}, 0.1f, 1.5f, 0, 0.02, 0.04},
    {"matt, rough 0.3", DiffuseMaterial{gray(0.8f)}, 0.3f, 1.5f, 0, 0.04, 0.05},
    {"matt, rough 0.6", DiffuseMaterial{gray(0.8f)}, 0.6f, 1.5f, 0, 0.04, 0.06},
    {"polished metal, smooth", metal(0), 0, 1.5f, 0, 0.005, 0.005},
    {"polished metal, rough 0.1", metal(0), 0.1f, 1.5f, 0, 0.07, 0.13},
    {"polished metal, rough 0.3", metal(0), 0.3f, 1.5f, 0, 0.15, 0.18},
    {"metal 0.03, smooth", metal(0.03f), 0, 1.5f, 0, 0.1, 0.06},
    {"metal 0.1, smooth", metal(0.1f), 0, 1.5f, 0, 0.08, 0.06},
    {"metal 0.3, smooth", metal(0.3f), 0, 1.5f, 0, 0.06, 0.05},
    {"metal 0.6, smooth", metal(0.6f), 0, 1.5f, 0, 0.07, 0.06},
    {"mirror 0.3, smooth", mirror(0.3f), 0, 1.5f, 0, 0.1, 0.06},
    {"mirror 0.2, thin index", mirror(0.2f), 0, 1.3f, 0, 0.09, 0.06},
    {"metal 0.3, rough 0.1", metal(0.3f), 0.1f, 1.5f, 0, 0.14, 0.08},
    {"metal 0.3, rough 0.3", metal(0.3f), 0.3f, 1.5f, 0, 0.14, 0.09},
};

TEST(Coating, LobesFollowTheRandomWalk) {
  for (const Stack& s : kStacks) {
    const MaterialSet set = stacked(s);
    for (const float cosine : {0.98f, 0.7f, 0.4f, 0.15f}) {
      const Vec3f wo = at_angle(cosine, 0.5f);
      constexpr int particles = 20000;
      const Exits truth = walk(set, wo, particles, 1), lobes = exits_of_lobes(set, wo, particles, 2);
      // Both are means of 20,000 numbers between 0 and about 1, whose standard deviations are at most 1/2: of
      // the difference 0.005; 4.5 of them.
      EXPECT_NEAR(lobes.total, truth.total, s.energy * truth.total + 4.5 * 0.005)
          << s.name << " at " << cosine;
      // 64 cells of which each is off by √(2p/n) on average: half the sum is at most √(64·2/n)/2 = 0.04.
      EXPECT_LE(misplaced(truth, lobes), s.elsewhere * truth.total + 0.04) << s.name << " at " << cosine;
    }
  }
}

// Under a smooth layer without absorption a matt base is plastic whose color saturates (nonlinear).
TEST(Coating, OverMattIsPlastic) {
  MaterialSet set;
  set.materials.push_back(DiffuseMaterial{ColorInput{Rgb(0.8f, 0.5f, 0.1f), -1}});
  set.materials.push_back(CoatingMaterial{1.5f, gray(1), gray(0), number(1), NormalDistribution::ggx,
                                          number(0.2f), number(0.2f), false, 0, false});
  set.materials.push_back(PlasticMaterial{1.5f, ColorInput{Rgb(0.8f, 0.5f, 0.1f), -1}, gray(1), true,
                                          NormalDistribution::ggx, number(0.2f), false, false, false,
                                          number(0), false});
  const SurfacePoint at = point_with_normal({0, 0, 1});
  for (const float o : {0.9f, 0.3f})
    for (const float i : {0.95f, 0.5f, 0.1f}) {
      const Vec3f wo = at_angle(o, 1), wi = at_angle(i, 3);
      const Rgb a = eval_f(set.closure(1, at, wo), wo, wi), b = eval_f(set.closure(2, at, wo), wo, wi);
      for (int c = 0; c < 3; ++c) EXPECT_NEAR(a[c], b[c], 1e-5f * b[c]);
    }
}

// A layer that covers nothing is none.
TEST(Coating, OfWeightZeroIsNotThere) {
  MaterialSet set;
  set.materials.push_back(metal(0.2f));
  set.materials.push_back(CoatingMaterial{1.5f, gray(1), gray(1), number(0), NormalDistribution::ggx,
                                          number(0.2f), number(0.2f), false, 0, false});
  const Vec3f wo = at_angle(0.7f, 1), wi = at_angle(0.6f, 4);
  const SurfacePoint at = point_with_normal({0, 0, 1});
  EXPECT_EQ(eval_f(set.closure(0, at, wo), wo, wi), eval_f(set.closure(1, at, wo), wo, wi));
}

}  // namespace
}  // namespace lumirank::scatter
