// The directions that sample() draws follow the density that pdf() states: chi-square over cells of the
// sphere.
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "base/random.h"
#include "scatter/bsdf_list.h"
#include "support/statistics.h"

namespace lumirank::scatter {
namespace {

using test::ChiSquareTest;

constexpr int kSamples = 100000;
constexpr int kRings = 24, kSectors = 24, kDepth = 6;

// Cells around the mirror direction, the likely peak: rings whose angle grows with the cube of the index, so
// that lobes of any sharpness meet cells of their own size.
struct Cells {
  Frame around;

  static double angle(double ring) {
    const double t = ring / kRings;
    return 3.14159265358979324 * t * t * t;
  }
  Vec3f direction(double ring, double sector) const {
    const double theta = angle(ring), phi = 2 * 3.14159265358979324 * sector / kSectors;
    return normalize(around.to_world({static_cast<float>(std::sin(theta) * std::cos(phi)),
                                      static_cast<float>(std::sin(theta) * std::sin(phi)),
                                      static_cast<float>(std::cos(theta))}));
  }
  // Solid angle per unit of ring × sector.
  static double jacobian(double ring) {
    const double t = ring / kRings;
    return std::sin(angle(ring)) * 3.14159265358979324 * 3 * t * t / kRings * 2 * 3.14159265358979324 /
           kSectors;
  }
  int index(Vec3f w) const {
    const Vec3f l = around.to_local(w);
    const double theta = std::atan2(std::hypot(double(l.x), double(l.y)), double(l.z));
    const int ring = std::min(kRings - 1, static_cast<int>(kRings * std::cbrt(theta / 3.14159265358979324)));
    double phi = std::atan2(double(l.y), double(l.x)) / (2 * 3.14159265358979324);
    if (phi < 0) phi += 1;
    return ring * kSectors + std::min(kSectors - 1, static_cast<int>(phi * kSectors));
  }
};

struct Integrator {
  const Cells& cells;
  const Closure& closure;
  Vec3f wo;
  double error = 0;  // sum of the last refinements' changes: an estimate of what is still wrong

  double density(double r, double s) const {
    return pdf(closure, wo, cells.direction(r, s), Lobes::non_delta) * Cells::jacobian(r);
  }
  double gauss(double r0, double s0, double size) const {
    constexpr std::array<double, 3> x{0.112701665379258, 0.5, 0.887298334620742};
    constexpr std::array<double, 3> w{5.0 / 18, 8.0 / 18, 5.0 / 18};
    double sum = 0;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) sum += w[i] * w[j] * density(r0 + size * x[i], s0 + size * x[j]);
    return sum * size * size;
  }
  double cell(double r0, double s0, double size, double coarse, int depth) {
    const double half = size / 2;
    double parts[4], sum = 0;
    for (int k = 0; k < 4; ++k) sum += parts[k] = gauss(r0 + half * (k & 1), s0 + half * (k >> 1), half);
    // The first two levels always, lest an edge hides between the points.
    if (depth == 0 || (depth <= kDepth - 2 && std::abs(sum - coarse) < 2e-7)) {
      error += std::abs(sum - coarse);
      return sum;
    }
    sum = 0;
    for (int k = 0; k < 4; ++k)
      sum += cell(r0 + half * (k & 1), s0 + half * (k >> 1), half, parts[k], depth - 1);
    return sum;
  }
};

class EveryBsdf : public testing::TestWithParam<int> {};

struct Arrival {
  float cos_theta, phi;
};
const Arrival kArrivals[] = {{0.95f, 0.3f}, {0.5f, 2.0f}, {0.12f, 4.4f}, {-0.9f, 1.0f}, {-0.4f, 5.0f}};

TEST_P(EveryBsdf, SamplesFollowThePdf) {
  const BsdfCase& c = bsdf_list()[static_cast<std::size_t>(GetParam())];
  // 1 % for the whole list, every direction being a test of its own (Bonferroni).
  const double significance = 0.01 / (static_cast<double>(bsdf_list().size()) * std::size(kArrivals));
  const Vec3f n = normalize({0.3f, -0.5f, 0.7f});
  const SurfacePoint at = point_with_normal(n);
  for (std::size_t a = 0; a < std::size(kArrivals); ++a) {
    if (kArrivals[a].cos_theta < 0 && !c.inside_too) continue;
    const Vec3f wo = at.shading.to_world(at_angle(kArrivals[a].cos_theta, kArrivals[a].phi));
    const Closure closure = c.set.closure(c.material, at, wo);
    if (!closure.has_non_delta()) continue;

    const Cells cells{Frame::from_normal(normalize(reflect(wo, closure.frame.n)))};
    std::vector<int> seen(kRings * kSectors + 1, 0);
    Rng rng(7, Stage::test, static_cast<std::uint64_t>(GetParam()), a);
    for (int i = 0; i < kSamples; ++i) {
      const float u1 = rng.next_float();
      const auto s = sample(closure, wo, u1, rng.next_2d(), Lobes::non_delta);
      if (!s) {
        ++seen.back();
        continue;
      }
      ASSERT_FALSE(s->delta);
      ASSERT_TRUE(is_finite(s->wi) && is_finite(s->weight)) << c.name;
      ASSERT_NEAR(length(s->wi), 1, 1e-5) << c.name;
      ASSERT_TRUE(s->weight.r >= 0 && s->weight.g >= 0 && s->weight.b >= 0) << c.name;
      ASSERT_GT(s->pdf, 0) << c.name;
      ++seen[static_cast<std::size_t>(cells.index(s->wi))];
    }

    Integrator integrate{cells, closure, wo};
    std::vector<double> expected(seen.size());
    double total = 0;
    for (int r = 0; r < kRings; ++r) {
      for (int k = 0; k < kSectors; ++k) {
        const double mass = integrate.cell(r, k, 1, integrate.gauss(r, k, 1), kDepth);
        expected[static_cast<std::size_t>(r) * kSectors + static_cast<std::size_t>(k)] = kSamples * mass;
        total += mass;
      }
    }
    EXPECT_LE(total, 1 + integrate.error + 1e-4) << c.name << " arrival " << a;
    expected.back() = kSamples * std::max(0.0, 1 - total);

    ChiSquareTest chi2;
    for (std::size_t i = 0; i < seen.size(); ++i) chi2.add(seen[i], expected[i]);
    if (!chi2.pool_counts()) {
      // Too few to judge by chi-square; but where next to nothing is expected, next to nothing may be seen (a
      // Poisson number of mean 10 exceeds 40 with probability below 1e-12).
      EXPECT_LE(chi2.pooled_seen(), 40) << c.name << " arrival " << a;
    }
    ASSERT_GE(chi2.bins(), 2) << c.name << ": all directions fall into one cell";
    EXPECT_GT(chi2.tail(), significance)
        << c.name << " arrival " << a << ": chi2 " << chi2.statistic() << " with " << chi2.bins() - 1
        << " degrees, total pdf " << total << " seen nothing " << seen.back();
  }
}

INSTANTIATE_TEST_SUITE_P(List, EveryBsdf, testing::Range(0, static_cast<int>(bsdf_list().size())), name_of);

}  // namespace
}  // namespace lumirank::scatter
