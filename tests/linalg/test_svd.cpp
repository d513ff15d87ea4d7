#include <gtest/gtest.h>

#include <cmath>

#include "base/random.h"
#include "linalg/svd.h"

namespace lumirank::linalg {
namespace {

// Σ_k 2⁻ᵏ a_k b_kᵀ with a_k, b_k columns of discrete cosine transforms (orthonormal): singular values 1, ½,
// ¼, …
std::vector<float> cosine_matrix(std::size_t rows, std::size_t columns, std::size_t rank) {
  const auto wave = [](std::size_t n, std::size_t k, std::size_t i) {
    const double scale =
        k == 0 ? std::sqrt(1.0 / static_cast<double>(n)) : std::sqrt(2.0 / static_cast<double>(n));
    return scale *
           std::cos(M_PI * static_cast<double>(k) * (static_cast<double>(i) + 0.5) / static_cast<double>(n));
  };
  std::vector<float> m(rows * columns);
  for (std::size_t i = 0; i < rows; ++i)
    for (std::size_t j = 0; j < columns; ++j) {
      double v = 0;
      for (std::size_t k = 0; k < rank; ++k)
        v += std::ldexp(wave(rows, k, i) * wave(columns, k, j), -static_cast<int>(k));
      m[i * columns + j] = static_cast<float>(v);
    }
  return m;
}

// Rounding to floats perturbs the matrix by at most 2⁻²⁴ of its Frobenius norm (< 1.16), and no singular
// value by more (Weyl).
constexpr double kRounding = 1.2 * 0x1p-24;

TEST(Svd, ExactValuesOfAKnownMatrix) {
  for (auto [rows, columns] : {std::pair<std::size_t, std::size_t>{60, 40}, {40, 60}}) {
    const auto values = singular_values(cosine_matrix(rows, columns, 12), rows, columns);
    ASSERT_EQ(values.size(), 40u);
    for (std::size_t k = 0; k < 40; ++k)
      EXPECT_NEAR(values[k], k < 12 ? std::ldexp(1.0, -static_cast<int>(k)) : 0.0, kRounding);
  }
}

TEST(Svd, RandomizedFindsTheLeadingOnes) {
  const std::size_t rows = 200, columns = 150;
  const auto m = cosine_matrix(rows, columns, 8);
  const auto svd = randomized_svd(m, rows, columns, {8, 6, 2, 1});
  ASSERT_EQ(svd.values.size(), 8u);
  for (std::size_t k = 0; k < 8; ++k)
    EXPECT_NEAR(svd.values[k], std::ldexp(1.0, -static_cast<int>(k)), 2 * kRounding);
  // The rank is 8, so the product gives the matrix back, up to the rounding of u and v to floats (sum of
  // values < 2).
  for (std::size_t i = 0; i < rows; i += 7)
    for (std::size_t j = 0; j < columns; j += 5) {
      double v = 0;
      for (std::size_t k = 0; k < 8; ++k)
        v += static_cast<double>(svd.u[i * 8 + k]) * svd.values[k] * static_cast<double>(svd.v[j * 8 + k]);
      EXPECT_NEAR(v, m[i * columns + j], 6 * kRounding);
    }
}

TEST(Svd, EmptyAndSmall) {
  EXPECT_TRUE(singular_values({}, 0, 5).empty());
  const std::vector<float> one{3};
  EXPECT_EQ(singular_values(one, 1, 1), std::vector<double>{3.0});
  EXPECT_EQ(randomized_svd(one, 1, 1, {}).values.size(), 1u);
}

}  // namespace
}  // namespace lumirank::linalg
