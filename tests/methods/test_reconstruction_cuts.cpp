#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "matrix/entry_reader.h"
#include "matrix/synthetic.h"
#include "methods/common/column_pass.h"
#include "methods/lightcuts/image_blocks.h"
#include "methods/lightcuts/probe_responses.h"
#include "methods/lightcuts/reconstruction.h"

namespace lumirank::methods {
namespace {

using matrix::DenseMatrix;
using matrix::Index;

TEST(ImageBlocks, EveryRowIsInOneBlockBetweenItsCorners) {
  DenseMatrix m = matrix::low_rank_matrix({2 * 37 * 37, 1, 1}, 1);  // 37 × 37 pixels, two rows each
  for (Vec2f& p : m.pixel) p = p + Vec2f{100, -7};                  // of a crop
  const ImageBlocks blocks(m);
  EXPECT_EQ(blocks.row_groups().size(), 9u);  // of 16 × 16 pixels
  std::set<Index> rows, corners;
  for (std::size_t u = 0; u < blocks.row_groups().size(); ++u)
    for (std::size_t b = 0; b < blocks.blocks(u); ++b) {
      const auto block = blocks.block(u, b);
      ASSERT_GE(block.corner_count, 1);
      for (const Index i : block.rows) {
        EXPECT_TRUE(rows.insert(i).second);
        for (int c = 0; c < block.corner_count; ++c) {
          const Vec2f at = m.pixel[block.corners[static_cast<std::size_t>(c)]];
          EXPECT_LE(std::abs(at.x - m.pixel[i].x), 4);
          EXPECT_LE(std::abs(at.y - m.pixel[i].y), 4);
        }
      }
      corners.insert(block.corners.begin(), block.corners.begin() + block.corner_count);
    }
  EXPECT_EQ(rows.size(), m.rows());
  EXPECT_EQ(corners.size(), 100u);  // pixels 0, 4, …, 36 each way: neighbors share them
}

TEST(ImageBlocks, ReceiversOfOtherSurfacesTellNothing) {
  const float third = std::sqrt(3.0f) / 2, half = 0.5f;
  const std::vector<Vec3f> position{{0, 0, 0}, {1, 0, 0}, {1, 0, 2}, {1, 0, 0.1f}, {0, 1, 0}};
  const std::vector<Vec3f> normal{{0, 0, 1}, {0, 0, 1}, {0, 0, 1}, {0, half, third}, {0, third, half}};
  const matrix::RowFeatures features{{}, position, normal, {}};
  EXPECT_TRUE(alike(features, 0, 1));
  EXPECT_FALSE(alike(features, 0, 2));  // above it
  EXPECT_TRUE(alike(features, 0, 3));   // 30 degrees but for rounding
  EXPECT_FALSE(alike(features, 0, 4));  // 60 degrees
  EXPECT_TRUE(alike({}, 0, 4));
}

// Rows 0 and 1 in proportion, row 2 in opposite order: (1·3 + 3·1) / (1 + 9) = 0.6. Rows 3 and 4 are dark.
TEST(ProbeResponses, LikenessIsTheCosineOfWhatLightsGive) {
  std::vector<Rgb> entries;
  for (const float v : {1.0f, 3.0f, 2.0f, 6.0f, 3.0f, 1.0f, 0.0f, 0.0f, 0.0f, 0.0f}) entries.emplace_back(v);
  const DenseMatrix m(5, 2, std::move(entries), std::vector<float>(10, 0));  // whatever is seen
  const LightTree tree(m, 1);
  ProbeResponses responses(tree);
  const std::vector<Index> rows{4, 0, 1, 2, 3};
  responses.measure(rows, *m.reader());
  EXPECT_NEAR(responses.similarity(1, 2), 1, 1e-6f);
  EXPECT_NEAR(responses.similarity(1, 3), 0.6f, 1e-6f);
  EXPECT_EQ(responses.similarity(0, 1), 0);
  EXPECT_EQ(responses.similarity(0, 4), 1);
  // Without lights all rows are dark.
  const DenseMatrix no_lights(5, 0, {});
  ProbeResponses nothing(LightTree(no_lights, 1));
  nothing.measure(rows, *no_lights.reader());
  EXPECT_EQ(nothing.similarity(0, 1), 1);
}

// Two columns with one root above them: cuts that hold the root alone, or both columns.
class TwoColumns : public testing::Test {
 protected:
  TwoColumns() : m_(3, 2, std::vector<Rgb>(6, Rgb(1))), tree_(m_, 1), cut_(tree_, 0.1) {}

  static CutSample fine(float left, float right) {
    return {0, Rgb(left + right), {{1, Rgb(left + right)}, {0, Rgb(left)}, {0, Rgb(right)}}};
  }
  static CutSample coarse(float sum) { return {0, Rgb(sum), {{0, Rgb(sum)}}}; }
  void find(const CutSample& a, const CutSample& b) {
    const CutSample* const both[] = {&a, &b};
    cut_.find(both);
  }

  DenseMatrix m_;
  LightTree tree_;
  ReconstructionCut cut_;
};

TEST_F(TwoColumns, WhatIsDarkEverywhereIsDropped) {
  find(fine(0, 0), coarse(0));
  EXPECT_TRUE(cut_.shaded().empty() && cut_.interpolated().empty());
  find(fine(0, 10), fine(0, 12));
  ASSERT_EQ(cut_.shaded().size(), 1u);
  EXPECT_EQ(cut_.shaded()[0].node, tree_.right(tree_.roots()[0]));
  EXPECT_TRUE(cut_.interpolated().empty());
}

TEST_F(TwoColumns, WhatSamplesAgreeInIsInterpolatedAsHighUpAsPossible) {
  find(fine(4, 6), fine(6, 4.5f));  // 10 and 10.5 differ by less than a tenth of 10
  ASSERT_EQ(cut_.interpolated().size(), 1u);
  EXPECT_EQ(cut_.interpolated()[0].node, tree_.roots()[0]);
  EXPECT_EQ(cut_.interpolated()[0].values[1], Rgb(10.5f));
  EXPECT_TRUE(cut_.shaded().empty());
}

TEST_F(TwoColumns, WhatTheyDifferInIsShadedWhereOneOfThemKnowsNoMore) {
  find(fine(4, 6), fine(8, 6.5f));
  ASSERT_EQ(cut_.shaded().size(), 1u);
  EXPECT_EQ(cut_.shaded()[0].node, tree_.left(tree_.roots()[0]));
  ASSERT_EQ(cut_.interpolated().size(), 1u);
  find(fine(4, 6), coarse(14));
  ASSERT_EQ(cut_.shaded().size(), 1u);
  EXPECT_EQ(cut_.shaded()[0].node, tree_.roots()[0]);
  // In the shade of one of them: a shadow may pass between.
  find(fine(0.1f, 10), fine(0, 14));
  ASSERT_EQ(cut_.shaded().size(), 2u);
  EXPECT_EQ(cut_.shaded()[0].node, tree_.left(tree_.roots()[0]));
}

// Where light differs by the receiver's albedo alone, interpolation from other albedos is exact: with albedo
// a, a node sums to a·V·I and its representative gives a·I₁, unoccluded.
TEST(Interpolation, TextureStaysSharp) {
  const std::vector<float> weights{0.25f, 0.75f};
  const std::vector<Rgb> values{Rgb(0.2f, 0.4f, 0.1f) * 3, Rgb(0.8f, 0.1f, 0.4f) * 3};
  const std::vector<Rgb> there{Rgb(0.2f, 0.4f, 0.1f) * 2, Rgb(0.8f, 0.1f, 0.4f) * 2};
  const Rgb here = Rgb(0.5f, 0.6f, 0.7f) * 2;
  const Rgb result = interpolate(weights, values, here, there, Rgb(1.5f));
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(result[c], 3 * here[c] / 2, 1e-6f);
  // A representative that gives nothing there tells nothing: 0.25 · 0.6 + 0.75 · 2.4 = 1.95.
  EXPECT_NEAR(interpolate(weights, values, here, std::vector<Rgb>(2), Rgb(1.5f)).r, 1.95f, 1e-6f);
}

// All entries of this matrix are positive, so nothing is dark, and with an interpolation tolerance of 0
// nothing is interpolated: every receiver shades the cuts' columns, which are all of them.
TEST(ReconstructionCuts, WithoutBoundAndAgreementEqualBruteForce) {
  const DenseMatrix m = matrix::low_rank_matrix({800, 150, 1}, 6);
  const Estimate e =
      find_method("lightcuts")
          .make({{"error-bound", "0"}, {"max-nodes", "1000000"}, {"interpolation-tolerance", "0"}})
          ->run(m, {});
  EXPECT_LT(relative_difference(e.sums, m.exact_sums()), 1e-6);
  EXPECT_LT(e.trace.numbers.at("cuts"), 200);
}

// Both are traded for each other by one number.
TEST(ReconstructionCuts, ErrorAndSavingFallWithTheAgreement) {
  const DenseMatrix m = matrix::low_rank_matrix({3200, 200, 1}, 6);
  std::vector<double> errors, entries;
  for (const char* tolerance : {"0.03", "0.003", "0"}) {
    const Estimate e =
        find_method("lightcuts")
            .make({{"error-bound", "0"}, {"max-nodes", "100000"}, {"interpolation-tolerance", tolerance}})
            ->run(m, {});
    errors.push_back(relative_difference(e.sums, m.exact_sums()));
    entries.push_back(e.trace.numbers.at("columns"));
  }
  EXPECT_GT(errors[0], errors[1]);
  EXPECT_GT(errors[1], errors[2]);
  EXPECT_LT(entries[0], entries[1]);
  EXPECT_LT(entries[1], entries[2]);
}

}  // namespace
}  // namespace lumirank::methods
