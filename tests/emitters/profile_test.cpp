// Point lights with an angular table: value, density and sample agree, and so does the emitter built on them.
#include "emitters/profile.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "base/random.h"
#include "base/transform.h"
#include "emitters/emitter.h"
#include "support/statistics.h"

namespace lumirank::emitters {
namespace {

using test::chi_square_tail;
using test::expect_mean;
using test::RunningMean;

Vec3f direction(double theta, double phi) {
  return {static_cast<float>(std::sin(theta) * std::cos(phi)),
          static_cast<float>(std::sin(theta) * std::sin(phi)), static_cast<float>(std::cos(theta))};
}

// Uneven angles from `first` to `last`, random values, one dark sector and one dark ring of cells.
AngularProfile uneven(double first, double last, std::uint64_t seed) {
  std::vector<float> theta, phi, values;
  constexpr int kRows = 12, kColumns = 9;
  for (int r = 0; r <= kRows; ++r) {
    const double t = static_cast<double>(r) / kRows;
    theta.push_back(std::min(static_cast<float>(first + (last - first) * t * std::sqrt(t)), kPi));
  }
  for (int c = 0; c <= kColumns; ++c)
    phi.push_back(2 * kPi * static_cast<float>(c * (c + 3)) / (kColumns * (kColumns + 3)));
  phi.back() = 2 * kPi;
  for (int r = 0; r <= kRows; ++r)
    for (int c = 0; c <= kColumns; ++c) {
      Rng rng(seed, Stage::test, static_cast<std::uint64_t>(r), static_cast<std::uint64_t>(c % kColumns));
      const bool dark = r == 5 || r == 6 || (c >= 3 && c <= 5);
      values.push_back(dark ? 0 : std::exp(3 * rng.next_float()));
    }
  return {theta, phi, values};
}

// The whole sphere, the lower and upper half, a thin beam, and a beam at the other pole.
std::vector<AngularProfile> profiles() {
  return {uneven(0, kPiD, 1), uneven(0, kPiD / 2, 2), uneven(kPiD / 2, kPiD, 3), uneven(0, 0.02, 4),
          uneven(kPiD - 0.1, kPiD, 5)};
}

TEST(AngularProfile, BilinearInTheAngles) {
  const AngularProfile p({0.5f, 1.0f, 2.0f}, {0, 3, 2 * kPi}, {1, 2, 1, 3, 5, 3, 0, 0, 0});
  EXPECT_NEAR(p.eval(direction(0.5, 0)), 1, 1e-5);
  EXPECT_NEAR(p.eval(direction(1, 3)), 5, 1e-5);
  EXPECT_NEAR(p.eval(direction(0.75, 1.5)), 0.25 * (1 + 2 + 3 + 5), 1e-5);
  EXPECT_NEAR(p.eval(direction(1.5, 3)), 2.5, 1e-5);
  EXPECT_EQ(p.eval(direction(0.49, 1)), 0);
  EXPECT_EQ(p.eval(direction(2.01, 1)), 0);
  EXPECT_EQ(p.max_value(), 5);
  EXPECT_EQ(p.min_theta(), 0.5f);
  EXPECT_EQ(p.max_theta(), 2.0f);
}

TEST(AngularProfile, TheIntegralIsExact) {
  for (const AngularProfile& p : profiles()) {
    // Midpoint rule in theta and phi over the range that is not dark; its error falls with n².
    double sum = 0;
    constexpr int n = 1500;
    const double lo = p.min_theta(), hi = p.max_theta();
    for (int i = 0; i < n; ++i) {
      const double theta = lo + (i + 0.5) / n * (hi - lo);
      double ring = 0;
      for (int j = 0; j < n; ++j) ring += p.eval(direction(theta, 2 * kPiD * (j + 0.5) / n));
      sum += ring * std::sin(theta) * (hi - lo) / n * 2 * kPiD / n;
    }
    // Kinks cost h² times the slope; 1500 steps over 12 intervals: below 10⁻³.
    EXPECT_NEAR(p.integral() / sum, 1, 1e-3);
  }
  const AngularProfile even({0, kPi}, {0, 2 * kPi}, {3, 3, 3, 3});
  EXPECT_NEAR(even.integral(), 12 * kPiD, 1e-5);
}

TEST(AngularProfile, SamplesHaveTheDensityThatPdfStates) {
  int which = 0;
  for (const AngularProfile& p : profiles()) {
    constexpr int n = 100000, kRows = 16, kColumns = 16;
    // Bins of equal solid angle between the polar angles of the profile; expected counts by quadrature of the
    // density, which is constant over cells, in 64 points of each bin.
    const double z0 = std::cos(double{p.min_theta()}), z1 = std::cos(double{p.max_theta()});
    std::vector<double> counts(kRows * kColumns), expected(kRows * kColumns);
    for (int r = 0; r < kRows; ++r)
      for (int c = 0; c < kColumns; ++c)
        for (int a = 0; a < 64; ++a)
          for (int b = 0; b < 64; ++b) {
            const double z = z0 + (z1 - z0) * (r + (a + 0.5) / 64) / kRows;
            expected[static_cast<std::size_t>(r * kColumns + c)] +=
                p.pdf(direction(std::acos(z), 2 * kPiD * (c + (b + 0.5) / 64) / kColumns)) * (z0 - z1) * 2 *
                kPiD / (64.0 * kRows * 64 * kColumns) * n;
          }
    double total = 0;
    for (const double e : expected) total += e;
    EXPECT_NEAR(total / n, 1, 5e-3) << which;
    int elsewhere = 0;  // directions that round into the next cell
    for (std::uint64_t i = 0; i < n; ++i) {
      Rng rng(7, Stage::test, i);
      const auto s = p.sample(rng.next_2d());
      ASSERT_GT(s.pdf, 0);
      EXPECT_NEAR(length_squared(s.local), 1, 1e-5);
      if (!(std::abs(p.pdf(s.local) / s.pdf - 1) < 1e-3f)) ++elsewhere;
      const double z = s.local.z;
      double phi = std::atan2(s.local.y, s.local.x);
      if (phi < 0) phi += 2 * kPiD;
      const int r = std::clamp(static_cast<int>((z - z0) / (z1 - z0) * kRows), 0, kRows - 1);
      const int c = std::clamp(static_cast<int>(phi / (2 * kPiD) * kColumns), 0, kColumns - 1);
      counts[static_cast<std::size_t>(r * kColumns + c)] += 1;
    }
    // Angles near the poles are good to 3·10⁻⁴, a sixtieth of the thin beam.
    EXPECT_LT(elsewhere, which == 3 ? n / 4 : n / 500) << which;
    if (which != 3) {
      // The quadrature of the expected counts is good to about a 64th of a bin at the edges of cells, which
      // the counts of some hundred per bin do not resolve.
      double chi = 0, rest = 0, rest_expected = 0;
      int bins = 0;
      for (std::size_t k = 0; k < counts.size(); ++k) {
        if (expected[k] < 10) {
          rest += counts[k], rest_expected += expected[k];
          continue;
        }
        const double slack = 0.02 * expected[k];
        const double off = std::max(0.0, std::abs(counts[k] - expected[k]) - slack);
        chi += off * off / expected[k], ++bins;
      }
      EXPECT_GT(chi_square_tail(chi, bins), 1e-5) << which;
      EXPECT_NEAR(rest, rest_expected, 5 * std::sqrt(rest_expected + 1) + 0.05 * rest_expected) << which;
    }
    ++which;
  }
}

TEST(AngularProfile, NothingIsSampledFromABlackOne) {
  const AngularProfile p({0, 1}, {0, 2 * kPi}, {0, 0, 0, 0});
  EXPECT_EQ(p.integral(), 0);
  EXPECT_EQ(p.sample({0.3f, 0.6f}).pdf, 0);
  EXPECT_EQ(p.pdf({0, 0, 1}), 0);
}

// A mirrored frame, so that left and right are told apart.
ProfileEmitter emitter(AngularProfile profile) {
  const Transform t = Transform::rotate(1, 2, -1, 50) * Transform::scale(-1, 1, 1);
  ProfileEmitter e;
  e.position = {1, 2, 3};
  e.frame = {normalize(t.vector({1, 0, 0})), normalize(t.vector({0, 1, 0})), normalize(t.vector({0, 0, 1}))};
  e.scale = Rgb(1, 2, 4);
  e.profile = std::make_shared<AngularProfile>(std::move(profile));
  return e;
}

TEST(ProfileEmitter, PowerIsTheMeanWeightOfItsParticles) {
  for (AngularProfile& p : profiles()) {
    const Emitter e{"", 0, emitter(std::move(p))};
    RunningMean mean;
    float max_weight = 0;
    for (std::uint64_t i = 0; i < 40000; ++i) {
      Rng rng(9, Stage::test, i);
      const Emission s = sample_emission(e, Bounds3f{}, 0, {0, 0}, rng.next_2d());
      EXPECT_EQ(s.origin, (Vec3f{1, 2, 3}));
      mean.add(s.weight.g), max_weight = std::max(max_weight, s.weight.g);
    }
    expect_mean(mean, power(e, 1).g, 1e-3);  // the thin beam: directions hold its angle to 10⁻⁵ of it
    // Bilinear within a cell and the cell drawn by its integral: at most four times the mean, and where three
    // corners are dark not far above it.
    EXPECT_LT(max_weight, 20 * power(e, 1).g);
  }
}

TEST(ProfileEmitter, ParticlesFollowTheIntensity) {
  // Flux through a cap about any direction: by particles and by quadrature.
  const ProfileEmitter p = emitter(uneven(0, kPiD, 1));
  const Emitter e{"", 0, p};
  for (const Vec3f axis : {Vec3f{0, 0, 1}, normalize(Vec3f{1, -1, 0.2f}), normalize(Vec3f{-1, -1, -1})}) {
    const float edge = std::cos(0.5f);
    RunningMean particles, quadrature;
    for (std::uint64_t i = 0; i < 60000; ++i) {
      Rng rng(10, Stage::test, i);
      const Emission s = sample_emission(e, Bounds3f{}, 0, {0, 0}, rng.next_2d());
      particles.add(dot(s.direction, axis) > edge ? s.weight.r : 0);
      const float z = 1 - 2 * rng.next_float(), phi = 2 * kPi * rng.next_float();
      const float r = std::sqrt(std::max(0.0f, 1 - z * z));
      const Vec3f d{r * std::cos(phi), r * std::sin(phi), z};
      quadrature.add(dot(d, axis) > edge ? 4 * kPiD * p.intensity_towards(d).r : 0);
    }
    EXPECT_NEAR(particles.mean(), quadrature.mean(),
                4.9 * std::hypot(particles.standard_error(), quadrature.standard_error()));
  }
}

TEST(ProfileEmitter, InverseSquareAlongItsDirections) {
  const ProfileEmitter p = emitter(uneven(0, kPiD, 1));
  const Vec3f towards = p.frame.to_world(direction(0.7, 1));
  const DirectSample s = sample_direct({"", 0, p}, p.position + towards * 3.0f, 0.1f, {0.2f, 0.3f});
  EXPECT_TRUE(s.delta);
  EXPECT_EQ(s.pdf, 1);
  EXPECT_NEAR(s.radiance.g, 2 * p.profile->intensity(direction(0.7, 1)).g / 9, 1e-4);
  EXPECT_EQ(sample_direct({"", 0, p}, p.position, 0.1f, {0.2f, 0.3f}).pdf, 0);
}

}  // namespace
}  // namespace lumirank::emitters
