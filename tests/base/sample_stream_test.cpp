// Evenly spread random numbers are even, uniform, and independent where they must be.
#include "base/sample_stream.h"

#include <gtest/gtest.h>

#include <vector>

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

}  // namespace
}  // namespace lumirank
