// What is known in closed form of hair.
#include <gtest/gtest.h>

#include <cmath>

#include "base/random.h"
#include "base/warp.h"
#include "scatter/bsdf_list.h"
#include "scatter/fiber_table.h"

namespace lumirank::scatter {
namespace {

constexpr double kPiDouble = 3.14159265358979;

Closure hair(float diffuse, float specular, float exponent, MaterialSet& set) {
  set.materials = {HairMaterial{{Rgb(diffuse), -1}, {Rgb(specular), -1}, {exponent, -1}}};
  return set.closure(0, point_with_normal({0, 0, 1}), {0, 0, 1});
}

TEST(Hair, LooksTheSameAllAroundTheFiber) {
  MaterialSet set;
  const Closure c = hair(0.3f, 0.5f, 30, set);
  EXPECT_TRUE(c.is_fiber());
  EXPECT_EQ(c.ng, Vec3f{});
  Rng rng(1, Stage::test);
  for (int k = 0; k < 500; ++k) {
    const Vec3f wo = warp_sphere(rng.next_2d()), wi = warp_sphere(rng.next_2d());
    const Vec3f o = c.frame.to_local(wo), i = c.frame.to_local(wi);
    const float a = 6.28f * rng.next_float(), ro = std::hypot(o.y, o.z), ri = std::hypot(i.y, i.z);
    const Vec3f turned_o = c.frame.to_world({o.x, ro * std::cos(a), ro * std::sin(a)});
    const Vec3f turned_i = c.frame.to_world({i.x, ri * std::sin(3 * a), ri * std::cos(3 * a)});
    const float f = eval(c, wo, wi).r;
    EXPECT_NEAR(eval(c, turned_o, turned_i).r, f, 1e-4f * f + 1e-6f);
  }
}

TEST(Hair, SpecularPeakLiesOnTheConeOfMirrorDirections) {
  MaterialSet set;
  const Closure c = hair(0, 1, 100, set);
  const auto at = [&](float latitude) {
    return c.frame.to_world({std::sin(latitude), std::cos(latitude) * 0.6f, std::cos(latitude) * 0.8f});
  };
  for (const float phi : {-0.9f, -0.2f, 0.0f, 0.6f}) {
    const float peak = eval_f(c, at(phi), at(-phi)).r;
    for (const float off : {0.1f, -0.1f}) {
      // cosⁿ of the angle off, and at most the denominators' change.
      const float max_value = std::max(1.0f, std::pow(std::cos(phi) / std::cos(-phi + off), 2.0f));
      EXPECT_LE(eval_f(c, at(phi), at(-phi + off)).r,
                peak * std::pow(std::cos(off), 100.0f) * max_value * 1.0001f);
    }
  }
}

// At light across the fiber the share that comes back is W(n + 2)/W(n) = (n + 1)/(n + 2): cos²φ under cosⁿ.
TEST(Hair, ShareOfTheSpecularLobeAtLightAcross) {
  for (const float n : {0.0f, 1.0f, 10.0f, 300.0f}) {
    MaterialSet set;
    const Closure c = hair(0, 1, n, set);
    // ∫ f·c dω = 2π ∫ f cos²φ dφ by 2000 midpoints.
    double share = 0;
    constexpr int kSteps = 2000;
    for (int k = 0; k < kSteps; ++k) {
      const double phi = 3.14159265358979 * ((k + 0.5) / kSteps - 0.5);
      const Vec3f wi =
          c.frame.to_world({static_cast<float>(std::sin(phi)), 0, static_cast<float>(std::cos(phi))});
      share += eval(c, c.frame.n, wi).r * std::cos(phi) * 2 * 3.14159265358979 * 3.14159265358979 / kSteps;
    }
    EXPECT_NEAR(share, (n + 1) / (n + 2), 2e-4) << n;
  }
}

Vec3f on_fiber(double latitude, double azimuth) {
  return {static_cast<float>(std::sin(latitude)), static_cast<float>(std::cos(latitude) * std::cos(azimuth)),
          static_cast<float>(std::cos(latitude) * std::sin(azimuth))};
}

// ∫ f·c over the latitudes of wi at one azimuth, by midpoints.
Rgb over_latitude(const FiberTable& table, int part, Vec3f wo, double azimuth) {
  constexpr int kSteps = 2000;
  Rgb sum(0);
  for (int k = 0; k < kSteps; ++k) {
    const double latitude = kPiDouble * ((k + 0.5) / kSteps - 0.5), c = std::cos(latitude);
    sum +=
        table.value(part, wo, on_fiber(latitude, azimuth)) * static_cast<float>(c * c * kPiDouble / kSteps);
  }
  return sum;
}

// Chiang et al. 2016, equations 8 to 11, at light across the fiber, by another quadrature: over h, whose
// average over the width is what our fibers show. Narrow along the fiber, so that θd is 0.
TEST(HairFiber, AzimuthalPartsAreTheAverageOverTheWidth) {
  const FiberOptics fiber{Rgb(0.2f, 0.5f, 1.5f), 1.55f, 0.05f, 0.4f, 0};
  const auto table = make_fiber_table(fiber);
  const double eta = 1.55,
               s = std::sqrt(kPiDouble / 8) * (0.265 * 0.4 + 1.194 * 0.16 + 5.372 * std::pow(0.4, 22));
  const auto logistic = [&](double x) {
    x = std::remainder(x, 2 * kPiDouble);
    const double e = std::exp(-std::abs(x) / s), whole = 2 / (1 + std::exp(-kPiDouble / s)) - 1;
    return e / (s * (1 + e) * (1 + e)) / whole;
  };
  for (const double phi : {0.0, 0.7, 1.5, 2.4, 3.0}) {
    for (int part = 0; part < FiberTable::kParts; ++part) {
      double expected[3] = {};
      constexpr int kSteps = 20000;
      for (int k = 0; k < kSteps; ++k) {
        const double h = 2 * (k + 0.5) / kSteps - 1, c = std::sqrt(1 - h * h);
        const double inner_sine = h / eta, inner_cosine = std::sqrt(1 - inner_sine * inner_sine);
        const double rs = (c - eta * inner_cosine) / (c + eta * inner_cosine);
        const double rp = (eta * c - inner_cosine) / (eta * c + inner_cosine), f = 0.5 * (rs * rs + rp * rp);
        const double turn = 2 * part * std::asin(inner_sine) - 2 * std::asin(h) + part * kPiDouble;
        for (int ch = 0; ch < 3; ++ch) {
          const double t = std::exp(-2 * static_cast<double>(fiber.sigma_a[ch]) * inner_cosine);
          const double a = part == 0 ? f : (1 - f) * (1 - f) * t * (part == 1 ? 1 : f * t);
          expected[ch] += a * logistic(phi - turn) / kSteps;
          // What leaves after three passages and more is even.
          if (part == 2) expected[ch] += a * f * t / (1 - f * t) / (2 * kPiDouble) / kSteps;
        }
      }
      const Rgb got = over_latitude(*table, part, on_fiber(0, 0.3), 0.3 + phi);
      for (int ch = 0; ch < 3; ++ch)
        EXPECT_NEAR(got[ch], expected[ch], 0.015 * expected[ch] + 2e-4) << "part " << part << ", phi " << phi;
    }
  }
}

// R about 2α - θo and as wide as β_m says, TT half as wide, TRT twice, about -4α - θo.
TEST(HairFiber, LobesAreTiltedAndAsWideAsTheyShouldBe) {
  const float alpha = 0.05f, theta_o = 0.3f;
  const auto table = make_fiber_table({Rgb(0.2f), 1.55f, 0.1f, 0.3f, alpha});
  const double width = 0.726 * 0.1 + 0.812 * 0.01;
  const double about[] = {2 * alpha - theta_o, -theta_o, -4 * alpha - theta_o}, times[] = {1, 0.5, 2};
  Rng rng(1, Stage::test);
  for (int part = 0; part < FiberTable::kParts; ++part) {
    constexpr int kDraws = 20000;
    double sum = 0, squares = 0;
    for (int k = 0; k < kDraws; ++k) {
      const Vec3f wi = table->sample(part, on_fiber(theta_o, 1), rng.next_2d());
      const double off = std::asin(wi.x) - about[part];
      sum += off, squares += off * off;
    }
    const double mean = sum / kDraws, deviation = std::sqrt(squares / kDraws - mean * mean);
    // Six standard errors, and what latitudes are drawn towards the equator: tan θ · v/2.
    EXPECT_NEAR(mean, 0, 6 * deviation / std::sqrt(kDraws) + 0.3 * deviation * deviation) << part;
    EXPECT_NEAR(deviation, times[part] * width, 0.04 * times[part] * width) << part;
  }
}

// A fiber without pigment sends on all light, from wherever it comes.
TEST(HairFiber, WithoutPigmentNothingIsLost) {
  for (const float tilt : {0.0f, 2 * kPi / 180}) {
    const auto table = make_fiber_table({Rgb(0), 1.55f, 0.3f, 0.3f, tilt});
    for (const double latitude : {-1.3, -0.8, 0.0, 0.5, 1.1}) {
      const Vec3f wo = on_fiber(latitude, 0);
      float sum = 0;
      constexpr int kAzimuths = 64;
      for (int part = 0; part < FiberTable::kParts; ++part)
        for (int k = 0; k < kAzimuths; ++k)
          sum += over_latitude(*table, part, wo, 2 * kPiDouble * (k + 0.5) / kAzimuths).g *
                 static_cast<float>(2 * kPiDouble / kAzimuths);
      EXPECT_NEAR(sum, 1, 0.006f) << latitude;
      EXPECT_LE(sum, 1.002f) << latitude;
    }
  }
}

}  // namespace
}  // namespace lumirank::scatter
