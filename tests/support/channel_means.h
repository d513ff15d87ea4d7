// Means of pictures over seeds, and whether two renderers agree on them.
#pragma once

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "lumirank/lumirank.h"
#include "support/statistics.h"

namespace lumirank::test {

// Mean of each channel over the whole (cropped) picture.
inline std::array<double, 3> mean_color(const Picture& picture) {
  std::array<double, 3> sum{};
  const auto& rgb = picture.planes[0].rgb;
  for (std::size_t k = 0; k < rgb.size(); ++k) sum[k % 3] += rgb[k];
  for (double& s : sum) s /= static_cast<double>(rgb.size() / 3);
  return sum;
}

// One mean per channel and seed.
struct ChannelMeans {
  std::vector<double> of[3];
  void add(const Picture& picture) {
    const auto mean = mean_color(picture);
    for (std::size_t c = 0; c < 3; ++c) of[c].push_back(mean[c]);
  }
};

// All three channels agree, with a false alarm once in a thousand runs; and the test has teeth: an error of
// the share `teeth` of the light would be seen.
inline void expect_equal_means(const ChannelMeans& a, const ChannelMeans& b, double teeth,
                               const std::string& what = {}) {
  for (std::size_t c = 0; c < 3; ++c) {
    const auto x = mean_of(a.of[c]), y = mean_of(b.of[c]);
    const double error =
        student_quantile(1e-3, 3, a.of[c].size() - 1) * std::hypot(x.standard_error, y.standard_error);
    EXPECT_NEAR(x.mean, y.mean, error) << what << ", channel " << c;
    EXPECT_LT(error, teeth * y.mean) << what << ", channel " << c;
  }
}

}  // namespace lumirank::test
