// Phase functions: normalized, drawn as they say, with the mean cosine that they are named by.
#include <gtest/gtest.h>

#include <vector>

#include "base/random.h"
#include "media/phase.h"
#include "support/statistics.h"

namespace lumirank::media {
namespace {

PhaseFunction one(PhaseLobe::Kind kind, float g) {
  PhaseFunction phase;
  phase.lobes[0] = {kind, Rgb(g), 1};
  return phase;
}

PhaseFunction mixture() {
  PhaseFunction phase;
  phase.count = 3;
  phase.lobes[0] = {PhaseLobe::Kind::henyey_greenstein, {0.8f, 0.6f, 0.4f}, 0.5f};
  phase.lobes[1] = {PhaseLobe::Kind::schlick, Rgb(-0.5f), 0.3f};
  phase.lobes[2] = {PhaseLobe::Kind::henyey_greenstein, Rgb(0), 0.2f};
  return phase;
}

std::vector<PhaseFunction> all_phases() {
  std::vector<PhaseFunction> all{PhaseFunction{}, mixture()};
  for (const auto kind : {PhaseLobe::Kind::henyey_greenstein, PhaseLobe::Kind::schlick})
    for (const float g : {-0.95f, -0.3f, 1e-5f, 0.5f, 0.9f, 0.99f}) all.push_back(one(kind, g));
  return all;
}

// Σ over the sphere of f(cosine) · p, by the midpoint rule with steps that shrink towards both poles.
template <typename F>
double over_the_sphere(const PhaseFunction& phase, int channel, F&& f) {
  constexpr int kSteps = 200000;
  double sum = 0;
  for (int k = 0; k < kSteps; ++k) {
    const double theta = kPiD * (k + 0.5) / kSteps;
    sum += static_cast<double>(phase.eval(static_cast<float>(std::cos(theta)))[channel]) *
           f(std::cos(theta)) * std::sin(theta);
  }
  return sum * kPiD / kSteps * 2 * kPiD;
}

TEST(Phase, IsNormalizedInEveryChannel) {
  for (const PhaseFunction& phase : all_phases())
    for (int c = 0; c < 3; ++c)
      EXPECT_NEAR(over_the_sphere(phase, c, [](double) { return 1.0; }), 1, 2e-4) << phase.lobes[0].g.r;
}

TEST(Phase, HenyeyGreensteinHasItsMeanCosine) {
  for (const float g : {-0.95f, -0.3f, 0.0f, 0.5f, 0.9f})
    EXPECT_NEAR(over_the_sphere(one(PhaseLobe::Kind::henyey_greenstein, g), 1, [](double mu) { return mu; }),
                static_cast<double>(g), 2e-4);
}

TEST(Phase, SchlickIsCloseToHenyeyGreenstein) {
  // The fit of k: by the paper's own figure the mean cosine is off by a few hundredths.
  for (const float g : {-0.5f, 0.2f, 0.5f, 0.8f})
    EXPECT_NEAR(over_the_sphere(one(PhaseLobe::Kind::schlick, g), 0, [](double mu) { return mu; }),
                static_cast<double>(g), 0.12);
}

TEST(Phase, DrawsWhatItSays) {
  const Vec3f forward = normalize(Vec3f{0.3f, -0.5f, 0.8f});
  for (const PhaseFunction& phase : all_phases())
    for (const int channel : {0, 2}) {
      constexpr int kBins = 24, kDraws = 100000;
      // Bins of equal probability are not at hand, so bins of equal angle, and few expected ones are pooled.
      std::vector<double> seen(kBins), expected(kBins);
      Rng rng(7, Stage::test, static_cast<std::uint64_t>(channel));
      for (int n = 0; n < kDraws; ++n) {
        const float u = rng.next_float();
        const Vec3f w = phase.sample(forward, channel, u, rng.next_2d());
        ASSERT_NEAR(length(w), 1, 1e-5f);
        const double theta = std::acos(std::clamp(static_cast<double>(dot(w, forward)), -1.0, 1.0));
        ++seen[static_cast<std::size_t>(std::min(kBins - 1.0, theta / kPiD * kBins))];
      }
      constexpr int kSteps = 4000;
      for (int k = 0; k < kBins * kSteps; ++k) {
        const double theta = kPiD * (k + 0.5) / (kBins * kSteps);
        expected[static_cast<std::size_t>(k / kSteps)] +=
            static_cast<double>(phase.eval(static_cast<float>(std::cos(theta)))[channel]) * std::sin(theta) *
            2 * kPiD * kPiD / (kBins * kSteps) * kDraws;
      }
      test::ChiSquareTest chi;
      for (int b = 0; b < kBins; ++b)
        chi.add(seen[static_cast<std::size_t>(b)], expected[static_cast<std::size_t>(b)]);
      if (chi.bins() < 2) continue;
      EXPECT_GT(chi.tail(), 1e-6) << phase.lobes[0].g[channel];
    }
}

TEST(Phase, NothingPassesTheMaximum) {
  for (const PhaseFunction& phase : all_phases()) {
    const Rgb most = phase.max_value();
    for (int k = 0; k <= 1000; ++k) {
      const Rgb value = phase.eval(static_cast<float>(k) / 500 - 1);
      for (int c = 0; c < 3; ++c) EXPECT_LE(value[c], most[c] * 1.0001f);
    }
  }
}

TEST(Phase, KnowsWhetherItIsGray) {
  EXPECT_TRUE(PhaseFunction{}.gray());
  EXPECT_TRUE(PhaseFunction{}.isotropic());
  EXPECT_FALSE(mixture().gray());
  EXPECT_FALSE(one(PhaseLobe::Kind::schlick, 0.5f).isotropic());
}

}  // namespace
}  // namespace lumirank::media
