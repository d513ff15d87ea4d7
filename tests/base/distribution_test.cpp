// Discrete distributions: drawn bins against the running sum itself.
#include "base/distribution.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/random.h"

namespace lumirank {
namespace {

std::vector<float> weights(std::size_t count, std::uint64_t seed) {
  std::vector<float> out(count);
  for (std::size_t k = 0; k < count; ++k) {
    Rng rng(seed, Stage::test, k);
    out[k] = rng.next_below(3) == 0 ? 0.0f : std::exp(20 * rng.next_float() - 10);
  }
  return out;
}

// The bin whose part of the sum holds u, found by going through all.
std::size_t bin_of(const std::vector<float>& weights, double total, float u) {
  const double target = static_cast<double>(u) * total;
  double before = 0;
  std::size_t last = 0;
  for (std::size_t k = 0; k < weights.size(); ++k) {
    if (!(weights[k] > 0)) continue;
    last = k;
    before += static_cast<double>(weights[k]);
    if (target < before) return k;
  }
  return last;
}

TEST(Distribution1D, DrawsTheBinThatHoldsTheNumber) {
  for (const std::size_t count : {1, 7, 31, 32, 100, 1000}) {
    auto all = weights(count, count);
    all[count / 2] = 1;
    const Distribution1D d(all);
    EXPECT_EQ(d.size(), count);
    const auto check = [&](float u) {
      const auto s = d.sample(u);
      ASSERT_EQ(s.index, bin_of(all, d.total(), u)) << count << ' ' << u;
      EXPECT_FLOAT_EQ(s.pmf, d.pmf(s.index));
      EXPECT_NEAR(s.pmf, static_cast<double>(all[s.index]) / d.total(), 1e-6);
      EXPECT_GE(s.remapped, 0);
      EXPECT_LT(s.remapped, 1);
    };
    for (std::uint64_t i = 0; i < 20000; ++i) check(Rng(9, Stage::test, i).next_float());
    // Where a search changes over to other bins.
    for (std::size_t k = 0; k < 200; ++k) {
      const float u = static_cast<float>(k) / 200;
      check(u), check(std::nextafter(u, 1.0f)), check(std::max(0.0f, std::nextafter(u, 0.0f)));
    }
    for (std::size_t k = 0; k < count / 8; ++k) {
      const float u = static_cast<float>(static_cast<double>(k) / static_cast<double>(count / 8));
      check(u), check(std::nextafter(u, 1.0f)), check(std::max(0.0f, std::nextafter(u, 0.0f)));
    }
    check(0x1.fffffep-1f);
  }
}

// Parts of the sum that begin with a bin, up to rounding.
TEST(Distribution1D, DrawsTheRightBinAlsoWhereProductsRound) {
  for (const float weight : {0.1f, 0.3f, 0.7f, 1.1f, 1e-7f, 3e5f})
    for (const std::size_t count : {768, 1536, 1920, 3072}) {
      const std::vector<float> even(count, weight);
      const Distribution1D d(even);
      for (std::size_t k = 0; k < count; ++k) {
        const float u = static_cast<float>(static_cast<double>(k) / static_cast<double>(count));
        for (const float near : {u, std::nextafter(u, 1.0f)})
          ASSERT_EQ(d.sample(near).index, bin_of(even, d.total(), near))
              << weight << ' ' << count << ' ' << k;
      }
    }
}

TEST(Distribution1D, DrawsTheSameHoweverFewBinsItSearches) {
  std::vector<float> weights;
  for (std::uint64_t i = 0; i < 1000; ++i) {
    const float u = Rng(10, Stage::test, i).next_float();
    weights.push_back(u < 0.3f ? 0.0f : u * u);
  }
  const Distribution1D coarse(weights, 100), usual(weights), fine(weights, 1);
  for (std::uint64_t i = 0; i < 10000; ++i) {
    const float u = Rng(11, Stage::test, i).next_float();
    const auto a = coarse.sample(u), b = usual.sample(u), c = fine.sample(u);
    ASSERT_EQ(a.index, b.index) << u;
    ASSERT_EQ(a.index, c.index) << u;
    ASSERT_EQ(a.remapped, c.remapped) << u;
  }
}

TEST(Distribution1D, MayHaveNoWeightAtAll) {
  EXPECT_EQ(Distribution1D().total(), 0);
  const Distribution1D d(std::vector<float>(100, 0.0f));
  EXPECT_EQ(d.total(), 0);
  EXPECT_EQ(d.pmf(3), 0);
  d.fetch(0.5f), d.fetch_bins(0.5f);
}

}  // namespace
}  // namespace lumirank
