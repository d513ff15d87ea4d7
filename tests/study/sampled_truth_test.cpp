// Errors at sampled pixels: of sums whose error is known.
#include <gtest/gtest.h>

#include <cmath>

#include "matrix/synthetic.h"
#include "study/sampled_truth.h"

namespace lumirank::study {
namespace {

class SampledTruthOfMadeUpMatrix : public ::testing::Test {
 protected:
  SampledTruthOfMadeUpMatrix() : matrix_(matrix::low_rank_matrix({400, 50, 1}, 3)) {
    for (std::uint32_t i = 0; i < 400; ++i) {
      samples_.push_back(i);  // four to a pixel
      weights_.push_back(Rgb(0.5f + 0.01f * static_cast<float>(i % 7)));
    }
  }
  SampledTruth truth(std::size_t count) const {
    return SampledTruth(matrix_, {weights_, samples_, 4}, count, 1, {});
  }
  matrix::DenseMatrix matrix_;
  std::vector<Rgb> weights_;
  std::vector<std::uint32_t> samples_;
};

TEST_F(SampledTruthOfMadeUpMatrix, TakesWholePixels) {
  const SampledTruth some = truth(200);
  EXPECT_EQ(some.rows(), 4 * some.pixels());
  EXPECT_LE(some.pixels(), 50u);
  EXPECT_GT(some.pixels(), 25u);
  EXPECT_EQ(truth(1).pixels(), 1u);
}

// Rounding: the truth is rounded to floats once, the sums too.
TEST_F(SampledTruthOfMadeUpMatrix, KnowsExactSumsAndTheirMultiples) {
  std::vector<Rgb> sums = matrix_.exact_sums();
  EXPECT_LT(truth(200).error_of(sums).metrics.relative_l1, 1e-6);
  for (Rgb& s : sums) s *= 1.25f;
  const auto error = truth(200).error_of(sums).metrics;
  EXPECT_NEAR(error.relative_l1, 0.25, 1e-6);
  EXPECT_NEAR(error.relative_l2, 0.25, 1e-6);
  EXPECT_NEAR(error.bias, 0.25, 1e-6);
  EXPECT_TRUE(std::isnan(error.flip)) << "single pixels are no picture";
}

// By the formula of docs/command-line.md, over all pixels.
TEST_F(SampledTruthOfMadeUpMatrix, RelMseIsThatOfPictures) {
  std::vector<Rgb> sums = matrix_.exact_sums();
  std::vector<double> reference(300);
  for (std::size_t i = 0; i < sums.size(); ++i)
    for (int c = 0; c < 3; ++c)
      reference[i / 4 * 3 + static_cast<std::size_t>(c)] += static_cast<double>(sums[i][c]) * weights_[i][c];
  double mean = 0, expected = 0;
  for (const double r : reference) mean += r / 300;
  for (const double r : reference) expected += 0.25 * r * 0.25 * r / (r * r + 1e-4 * mean * mean) / 300;
  for (Rgb& s : sums) s *= 1.25f;
  const SampledTruth all = truth(400);
  ASSERT_EQ(all.pixels(), 100u);
  EXPECT_NEAR(all.error_of(sums).metrics.relmse, expected, 1e-6);
}

// In media a pixel's eye segments come after all receivers.
TEST_F(SampledTruthOfMadeUpMatrix, PixelsNeedNotLieTogether) {
  for (std::uint32_t i = 0; i < 400; ++i) samples_[i] = 4 * (i % 100) + i / 100;
  std::vector<Rgb> sums = matrix_.exact_sums();
  const SampledTruth some = truth(200);
  EXPECT_EQ(some.rows(), 4 * some.pixels());
  EXPECT_LT(some.error_of(sums).metrics.relative_l1, 1e-6);
  for (std::size_t i = 300; i < 400; ++i) sums[i] *= 2;
  EXPECT_GT(some.error_of(sums).metrics.relative_l1, 0.1);
}

// What belongs to a pixel may lie in any of its rows.
TEST_F(SampledTruthOfMadeUpMatrix, LooksAtPixelsNotAtRows) {
  std::vector<Rgb> sums = matrix_.exact_sums();
  for (std::size_t i = 0; i < sums.size(); i += 4) {
    Rgb pixel(0);
    for (std::size_t k = i; k < i + 4; ++k) pixel += sums[k] * weights_[k], sums[k] = Rgb(0);
    sums[i + 2] = pixel / weights_[i + 2];
  }
  EXPECT_LT(truth(400).error_of(sums).metrics.relative_l1, 1e-6);
}

}  // namespace
}  // namespace lumirank::study
