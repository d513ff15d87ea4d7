#include "film/filter.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "base/error.h"
#include "base/parallel.h"
#include "base/random.h"

namespace lumirank::film {
namespace {

const FilterKind kAll[] = {FilterKind::box,      FilterKind::tent,       FilterKind::gaussian,
                           FilterKind::mitchell, FilterKind::catmullrom, FilterKind::lanczos};

double integral(const Filter& filter) {
  const int steps = 200000;  // midpoint rule
  const double h = 2.0 * filter.radius / steps;
  double sum = 0;
  for (int i = 0; i < steps; ++i) sum += filter.eval(static_cast<float>(-filter.radius + (i + 0.5) * h));
  return sum * h;
}

// Box: 2r = 1. Tent: r = 1. Cubics: 1 for every B and C (they partition unity). Gaussian lowered by its end
// value: √(2π)·σ·erf(r/(σ√2)) - 2r·exp(-r²/2σ²) with σ = 1/2, r = 2. The steps of the sum in floats leave
// about 1e-5.
TEST(Filter, Integrals) {
  EXPECT_NEAR(integral(Filter::standard(FilterKind::box)), 1, 1e-4);
  EXPECT_NEAR(integral(Filter::standard(FilterKind::tent)), 1, 1e-4);
  EXPECT_NEAR(integral(Filter::standard(FilterKind::mitchell)), 1, 1e-4);
  EXPECT_NEAR(integral(Filter::standard(FilterKind::catmullrom)), 1, 1e-4);
  const double gaussian =
      std::sqrt(2 * M_PI) * 0.5 * std::erf(2 / (0.5 * std::sqrt(2.0))) - 4 * std::exp(-2 * 2 / (2 * 0.25));
  EXPECT_NEAR(integral(Filter::standard(FilterKind::gaussian)), gaussian, 1e-4);
}

// Mitchell at 0: (6 - 2/3)/6 = 8/9, at 1: B/6 = 1/18; Catmull-Rom interpolates: 1 at 0, 0 at 1, and at 1.5:
// from eq. 8 with B = 0, C = 1/2: -3·3.375 + 15·2.25 - 24·1.5 + 12 = -0.375, over 6: -1/16.
// Lanczos at 1.5 with 3 lobes: sin(1.5π)/(1.5π) · sin(π/2)/(π/2) = -(2/(3π))·(2/π) = -4/(3π²).
TEST(Filter, Values) {
  const Filter mitchell = Filter::standard(FilterKind::mitchell);
  EXPECT_FLOAT_EQ(mitchell.eval(0), 8.0f / 9);
  EXPECT_NEAR(mitchell.eval(-1), 1.0f / 18, 1e-6f);
  const Filter catmull = Filter::standard(FilterKind::catmullrom);
  EXPECT_FLOAT_EQ(catmull.eval(0), 1);
  EXPECT_NEAR(catmull.eval(1), 0, 1e-6f);
  EXPECT_NEAR(catmull.eval(1.5f), -1.0f / 16, 1e-6f);
  EXPECT_NEAR(Filter::standard(FilterKind::lanczos).eval(1.5f), -4 / (3 * kPi * kPi), 1e-6f);
  EXPECT_FLOAT_EQ(Filter::standard(FilterKind::tent).eval(-0.25f), 0.75f);
  const Filter gaussian = Filter::standard(FilterKind::gaussian);
  EXPECT_FLOAT_EQ(gaussian.eval(0.5f), std::exp(-0.5f) - std::exp(-8.0f));
  for (const FilterKind kind : kAll) {
    const Filter filter = Filter::standard(kind);
    EXPECT_EQ(filter.eval(filter.radius), 0) << static_cast<int>(kind);
    EXPECT_EQ(filter.eval(filter.radius + 1), 0);
    EXPECT_EQ(filter.eval(0.3f), filter.eval(-0.3f));
  }
  // Half open, so that a sample on a pixel's edge counts once.
  EXPECT_EQ(Filter{}.eval(-0.5f), 1);
  EXPECT_EQ(Filter{}.eval(0.5f), 0);
}

struct Samples {
  std::vector<Vec2f> positions;
  std::vector<Rgb> values;
};

// 2×2 jittered samples in every pixel.
Samples jittered(int width, int height) {
  Samples samples;
  for (int y = 0; y < 2 * height; ++y)
    for (int x = 0; x < 2 * width; ++x) {
      Rng rng(1, Stage::test, static_cast<std::uint64_t>(y), static_cast<std::uint64_t>(x));
      const Vec2f u = rng.next_2d();
      samples.positions.push_back({(static_cast<float>(x) + u.x) / 2, (static_cast<float>(y) + u.y) / 2});
      samples.values.push_back(Rgb(u.x, u.y, static_cast<float>(x)));
    }
  return samples;
}

// Every pixel is Σwv/Σw with v the same everywhere; sums are in double, so only the last rounding to float
// remains.
TEST(Splat, ConstantStaysConstantUpToTheBorders) {
  Samples samples = jittered(11, 7);
  std::fill(samples.values.begin(), samples.values.end(), Rgb(0.3f, 5, 1e-3f));
  for (const FilterKind kind : kAll) {
    const image::Image image = splat(11, 7, Filter::standard(kind), samples.positions, samples.values);
    for (const Rgb& pixel : image.pixels) {
      EXPECT_FLOAT_EQ(pixel.r, 0.3f) << static_cast<int>(kind);
      EXPECT_FLOAT_EQ(pixel.g, 5) << static_cast<int>(kind);
      EXPECT_FLOAT_EQ(pixel.b, 1e-3f) << static_cast<int>(kind);
    }
  }
}

// The definition itself, pixel by pixel over all samples.
TEST(Splat, AgreesWithTheDefinition) {
  const int width = 9, height = 6;
  Samples samples = jittered(width, height);
  samples.positions.push_back({-0.9f, 2});  // outside the window, within reach of the wider filters
  samples.positions.push_back({4, static_cast<float>(height) + 0.7f});
  samples.positions.push_back({-50, -1e30f});
  samples.values.insert(samples.values.end(), 3, Rgb(100));
  std::vector<Filter> filters;
  for (const FilterKind kind : kAll) filters.push_back(Filter::standard(kind));
  filters.push_back({.kind = FilterKind::box, .radius = 0.3f});
  filters.push_back({.kind = FilterKind::box, .radius = 1.7f});
  filters.push_back({.kind = FilterKind::tent, .radius = 2.25f});
  for (const Filter& filter : filters) {
    const image::Image image = splat(width, height, filter, samples.positions, samples.values);
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) {
        double sum = 0, weights = 0;
        for (std::size_t i = 0; i < samples.positions.size(); ++i) {
          const Vec2f p = samples.positions[i];
          const double w = static_cast<double>(filter.eval(p.x - (static_cast<float>(x) + 0.5f))) *
                           filter.eval(p.y - (static_cast<float>(y) + 0.5f));
          sum += w * samples.values[i].r, weights += w;
        }
        const double expected = weights != 0 ? sum / weights : 0;
        EXPECT_NEAR(image.at(x, y).r, expected, 1e-5 * (1 + std::abs(expected)))
            << static_cast<int>(filter.kind) << " radius " << filter.radius << " at " << x << "," << y;
      }
  }
}

TEST(Splat, PixelsWithoutSamplesAreBlack) {
  const std::vector<Vec2f> positions{{0.5f, 0.5f}};
  const std::vector<Rgb> values{Rgb(3)};
  for (const FilterKind kind : {FilterKind::box, FilterKind::tent}) {
    const image::Image image = splat(4, 1, Filter::standard(kind), positions, values);
    EXPECT_EQ(image.at(0, 0), Rgb(3));
    EXPECT_EQ(image.at(3, 0), Rgb(0));
  }
  EXPECT_EQ(splat(3, 2, Filter{}, {}, {}).at(2, 1), Rgb(0));
}

// Two samples whose Catmull-Rom weights for the pixel are of opposite sign and equal size would divide by
// zero; the magnitudes take over, and the result stays within the samples' range.
TEST(Splat, CancelledWeightsStayWithinRange) {
  const Filter filter = Filter::standard(FilterKind::catmullrom);
  // Find where the positive side is as large as the lobe's 1/16 at 1.5: bisection on [0.5, 1], where it falls
  // to 0.
  float lo = 0.5f, hi = 1;
  for (int i = 0; i < 60; ++i) (filter.eval((lo + hi) / 2) > 1.0f / 16 ? lo : hi) = (lo + hi) / 2;
  const std::vector<Vec2f> positions{{0.5f + lo, 0.5f}, {2.0f, 0.5f}};
  const std::vector<Rgb> values{Rgb(1), Rgb(2)};
  const image::Image image = splat(1, 1, filter, positions, values);
  EXPECT_NEAR(image.at(0, 0).r, 1.5f, 1e-3f);  // equal magnitudes: the plain mean
}

TEST(Splat, AWindowHasTheBitsOfTheWhole) {
  const Samples samples = jittered(40, 60);
  for (const auto kind : {FilterKind::box, FilterKind::tent, FilterKind::gaussian, FilterKind::lanczos}) {
    const image::Image whole = splat(40, 60, Filter::standard(kind), samples.positions, samples.values);
    const image::Image window =
        splat(9, 7, Filter::standard(kind), samples.positions, samples.values, {31, 1});
    for (int y = 0; y < 7; ++y)
      for (int x = 0; x < 9; ++x) EXPECT_EQ(window.at(x, y), whole.at(x + 31, y + 1));
  }
}

TEST(Splat, SameBitsForAnyNumberOfThreads) {
  const Samples samples = jittered(40, 60);
  const Filter filter = Filter::standard(FilterKind::gaussian);
  image::Image one, four;
  with_threads(1, [&] { one = splat(40, 60, filter, samples.positions, samples.values); });
  with_threads(4, [&] { four = splat(40, 60, filter, samples.positions, samples.values); });
  EXPECT_EQ(one.pixels, four.pixels);
}

TEST(Splat, BrokenInvariants) {
  const std::vector<Rgb> one{Rgb(1)};
  const std::vector<Vec2f> nan{{std::numeric_limits<float>::quiet_NaN(), 0}};
  EXPECT_THROW(splat(2, 2, Filter{}, {}, one), InternalError);
  EXPECT_THROW(splat(2, 2, Filter{}, nan, one), InternalError);
}

}  // namespace
}  // namespace lumirank::film
