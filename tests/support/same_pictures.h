// Check of whether two pictures with independent noise are estimates of the same picture.
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "support/statistics.h"

namespace lumirank::test {

struct SamePictures {
  int width = 0, height = 0, block = 12;  // blocks of pixels, which tile the picture
  int pairs = 1;                          // of pictures that are compared in this test
  double slack = 1e-5;                    // of a block's mean, left to rounding
  // The noise of each block is checked to be below this share of its mean (and 0.02 more): otherwise the
  // comparison would see nothing. 0: it is not.
  double noise_below = 0;
};

// Block by block and channel by channel the mean difference of the two is 0 within its noise; all blocks of
// all pairs together fail by chance once in a thousand runs.
inline void expect_same_pictures(const std::vector<float>& a, const std::vector<float>& b,
                                 const SamePictures& how, const std::string& what = {}) {
  const int tests = how.pairs * (how.width / how.block) * (how.height / how.block) * 3;
  const double quantile = normal_quantile(1e-3, static_cast<std::size_t>(tests));
  ASSERT_EQ(a.size(), static_cast<std::size_t>(3 * how.width * how.height)) << what;
  ASSERT_EQ(b.size(), a.size()) << what;
  for (int by = 0; by < how.height; by += how.block)
    for (int bx = 0; bx < how.width; bx += how.block)
      for (int c = 0; c < 3; ++c) {
        std::vector<double> differences;
        double level = 0;
        for (int y = by; y < by + how.block; ++y)
          for (int x = bx; x < bx + how.block; ++x) {
            const auto i = static_cast<std::size_t>(3 * (y * how.width + x) + c);
            differences.push_back(static_cast<double>(a[i]) - b[i]);
            level += a[i] / static_cast<double>(how.block * how.block);
          }
        const Mean m = mean_of(differences);
        const std::string at = what + (what.empty() ? "" : ", ") + "block " + std::to_string(bx) + ", " +
                               std::to_string(by) + ", channel " + std::to_string(c);
        EXPECT_NEAR(m.mean, 0, quantile * m.standard_error + how.slack * level) << at;
        if (how.noise_below > 0) {
          EXPECT_LT(quantile * m.standard_error, how.noise_below * level + 0.02) << at;
        }
      }
}

}  // namespace lumirank::test
