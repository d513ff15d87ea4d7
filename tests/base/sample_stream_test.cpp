// Evenly spread random numbers are even, uniform, and independent where they must be.
#include "base/sample_stream.h"

#include <gtest/gtest.h>

#include <vector>

#include "base/morton.h"
#include "support/statistics.h"

namespace lumirank {
namespace {

using test::mean_of;
using test::normal_quantile;

constexpr double kAlpha = 1e-4;

TEST(SampleStream, EveryPairIsANet) {
  // 64 points of one half: each elementary interval of area 1/64, whatever its shape, holds exactly one. So
  // it is for each further block of 64.
  constexpr int kBits = 6, kCount = 1 << kBits;
  for (std::uint64_t block = 0; block < 3; ++block)
    for (int pair = 0; pair < 16; ++pair)
      for (int across = 0; across <= kBits; ++across) {
        std::vector<int> found(kCount);
        for (std::uint64_t k = 0; k < kCount; ++k) {
          SampleStream stream(7, Stage::test, 123, 2 * (block * kCount + k) + 1);
          Vec2f u{};
          for (int j = 0; j <= pair; ++j) u = stream.next_2d();
          const int x = static_cast<int>(u.x * static_cast<float>(1 << across));
          const int y = static_cast<int>(u.y * static_cast<float>(1 << (kBits - across)));
          ++found[static_cast<std::size_t>((y << across) + x)];
        }
        for (int count : found) ASSERT_EQ(count, 1) << "pair " << pair << ", block " << block;
      }
}

TEST(SampleStream, AnySampleAloneIsUniformAndItsPairsAreIndependent) {
  // Over pixels: means of x, x², xy and of products between pairs are 1/2, 1/3, 1/4 and 1/4.
  for (const std::uint64_t sample : {0u, 1u, 5u, 300u}) {
    std::vector<double> x, xx, xy, between, fine;
    for (std::uint64_t pixel = 0; pixel < 20000; ++pixel) {
      SampleStream stream(9, Stage::test, pixel, sample);
      const Vec2f a = stream.next_2d(), b = stream.next_2d();
      const auto c = stream.next_fine();
      x.push_back(a.x), xx.push_back(square(b.y)), xy.push_back(a.x * a.y), between.push_back(a.y * b.x);
      fine.push_back(c.x * b.y);
    }
    const double z = normal_quantile(kAlpha, 20);
    const auto expect = [&](const std::vector<double>& values, double expected) {
      const auto m = mean_of(values);
      EXPECT_NEAR(m.mean, expected, z * m.standard_error) << sample;
    };
    expect(x, 0.5), expect(xx, 1.0 / 3), expect(xy, 0.25), expect(between, 0.25), expect(fine, 0.25);
  }
}

TEST(SampleStream, TheHalvesOfAPixelAreIndependent) {
  // Σ over 16 samples of a bumpy function: the covariance of the two halves over pixels is 0. Its estimate is
  // a mean of products.
  std::vector<double> product, squares, random;
  for (std::uint64_t pixel = 0; pixel < 4000; ++pixel) {
    double sum[2] = {0, 0}, plain = 0;
    for (std::uint64_t s = 0; s < 32; ++s) {
      SampleStream stream(11, Stage::test, pixel, s);
      const Vec2f a = stream.next_2d(), b = stream.next_2d();
      sum[s & 1] += (a.x * b.y > 0.3f ? 1.0 : 0.0) + a.x;
      Rng rng(11, Stage::test, pixel, s);
      const Vec2f c = rng.next_2d(), d = rng.next_2d();
      if (s & 1) plain += (c.x * d.y > 0.3f ? 1.0 : 0.0) + c.x;
    }
    // P(xy > t) = 1 - t + t ln t.
    const double mean = 16 * (1 - 0.3 + 0.3 * std::log(0.3) + 0.5);
    product.push_back((sum[0] - mean) * (sum[1] - mean));
    squares.push_back(square(static_cast<float>(sum[0] - mean)));
    random.push_back(square(static_cast<float>(plain - mean)));
  }
  const auto p = mean_of(product);
  EXPECT_NEAR(p.mean, 0, normal_quantile(kAlpha) * p.standard_error);
  // And they are worth having: the variance is well below that of independent numbers.
  EXPECT_LT(mean_of(squares).mean, 0.5 * mean_of(random).mean);
}

Vec2f pair_over_film(std::uint64_t seed, std::uint32_t place, std::uint64_t sample, int pair) {
  SampleStream stream = SampleStream::over_film(seed, Stage::test, 3, place, sample);
  Vec2f u{};
  for (int j = 0; j <= pair; ++j) u = stream.next_2d();
  return u;
}

TEST(SampleStream, NeighborsOfAFilmShareAlongEitherDimension) {
  // 2^k samples of one half in blocks of 2^b × 2^b pixels.
  for (const int k : {0, 1, 2, 3})
    for (const int b : {0, 1, 2}) {
      const int count = 1 << (k + 2 * b);
      const auto size = static_cast<std::uint32_t>(1) << b;
      for (const int pair : {0, 1, 7, 15}) {
        std::vector<int> in_x(static_cast<std::size_t>(count)), in_y(static_cast<std::size_t>(count));
        for (std::uint32_t y = 8; y < 8 + size; ++y)
          for (std::uint32_t x = 20; x < 20 + size; ++x)
            for (std::uint64_t s = 0; s < std::uint64_t{1} << k; ++s) {
              const Vec2f u = pair_over_film(5, static_cast<std::uint32_t>(morton2(x, y)), 2 * s + 1, pair);
              ++in_x[static_cast<std::size_t>(u.x * static_cast<float>(count))];
              ++in_y[static_cast<std::size_t>(u.y * static_cast<float>(count))];
            }
        for (int i = 0; i < count; ++i) {
          const auto interval = static_cast<std::size_t>(i);
          ASSERT_EQ(in_x[interval], 1) << k << ' ' << b << ' ' << pair;
          ASSERT_EQ(in_y[interval], 1) << k << ' ' << b << ' ' << pair;
        }
      }
    }
}

TEST(SampleStream, OnePixelOfAFilmAndOneSampleOfItsPixelsAreNets) {
  constexpr int kBits = 4, kCount = 1 << kBits;
  const auto expect_net = [&](const std::vector<Vec2f>& points) {
    for (int across = 0; across <= kBits; ++across) {
      std::vector<int> found(kCount);
      for (const Vec2f u : points) {
        const int x = static_cast<int>(u.x * static_cast<float>(1 << across));
        const int y = static_cast<int>(u.y * static_cast<float>(1 << (kBits - across)));
        ++found[static_cast<std::size_t>((y << across) + x)];
      }
      for (const int count : found) ASSERT_EQ(count, 1);
    }
  };
  for (const int pair : {0, 1, 7, 15}) {
    std::vector<Vec2f> of_pixel, of_sample;
    for (std::uint32_t j = 0; j < kCount; ++j) {
      of_pixel.push_back(pair_over_film(5, 77, 2 * (kCount + std::uint64_t{j}), pair));
      of_sample.push_back(pair_over_film(5, 3 * kCount + j, 6, pair));
    }
    expect_net(of_pixel), expect_net(of_sample);
  }
}

// Over seeds: each sample of each pixel is uniform, and knows nothing of other pairs, of the other half, or
// of another stream.
TEST(SampleStream, OverAFilmSamplesAreUniformAndPairsAndHalvesAreIndependent) {
  std::vector<double> x, xx, xy, between_pairs, between_halves, between_uses, float_by_pixel;
  for (std::uint64_t seed = 0; seed < 20000; ++seed) {
    const Vec2f a = pair_over_film(seed, 5, 4, 0), b = pair_over_film(seed, 6, 4, 1),
                c = pair_over_film(seed, 6, 5, 0);
    SampleStream other = SampleStream::over_film(seed, Stage::test, 4, 5, 4);
    const Vec2f d = other.next_2d();
    SampleStream beside = SampleStream::over_film(seed, Stage::test, 4, 6, 4);
    x.push_back(a.x), xx.push_back(square(b.y)), xy.push_back(a.x * a.y), between_pairs.push_back(a.x * b.x);
    between_halves.push_back(a.y * c.y), between_uses.push_back(a.x * d.x);
    float_by_pixel.push_back(other.next_float() * beside.next_float());
  }
  const double z = normal_quantile(kAlpha, 7);
  const auto expect = [&](const std::vector<double>& values, double expected) {
    const auto m = mean_of(values);
    EXPECT_NEAR(m.mean, expected, z * m.standard_error);
  };
  expect(x, 0.5), expect(xx, 1.0 / 3), expect(xy, 0.25), expect(between_pairs, 0.25);
  expect(between_halves, 0.25), expect(between_uses, 0.25), expect(float_by_pixel, 0.25);
}

// What it is for: sums over four neighbors of a smooth function have less noise than four alone.
TEST(SampleStream, ErrorsOfNeighborsAreOpposite) {
  std::vector<double> together, apart;
  const auto off = [](Vec2f u) { return static_cast<double>(u.x * u.x + u.x * u.y) - 1.0 / 3 - 1.0 / 4; };
  for (std::uint64_t seed = 0; seed < 2000; ++seed) {
    double sum = 0;
    for (std::uint32_t place = 0; place < 4; ++place)
      for (const std::uint64_t s : {0, 2}) sum += off(pair_over_film(seed, place, s, 1));
    together.push_back(sum * sum);
    double alone = 0;
    for (std::uint64_t pixel = 0; pixel < 4; ++pixel)
      for (const std::uint64_t s : {0, 2}) {
        SampleStream stream(seed, Stage::test, pixel, s);
        stream.next_2d();
        alone += off(stream.next_2d());
      }
    apart.push_back(alone * alone);
  }
  EXPECT_LT(mean_of(together).mean, 0.4 * mean_of(apart).mean);
}

}  // namespace
}  // namespace lumirank
