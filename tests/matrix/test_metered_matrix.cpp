// A metered matrix gives the numbers of the other one and adds up what they cost, whoever asks.
#include <gtest/gtest.h>

#include "base/parallel.h"
#include "matrix/entry_reader.h"
#include "matrix/metered_matrix.h"
#include "matrix/synthetic.h"

namespace lumirank::matrix {
namespace {

TEST(MeteredMatrix, AddsUpCallsOfAllKinds) {
  const DenseMatrix m = sparse_matrix({40, 30, 1}, 0.3);
  const MeteredMatrix metered(m);
  EXPECT_EQ(metered.total(), Cost{});
  std::vector<Rgb> row(30), column(40), block(6), listed(2), sums(40), expected(40);
  Cost spent = metered.row(3, row);
  spent += metered.column(4, column);
  spent += metered.block(std::vector<Index>{1, 2}, std::vector<Index>{5, 6, 7}, block);
  spent += metered.entries(std::vector<Index>{1, 2}, std::vector<Index>{5, 6}, listed);
  spent += metered.accumulate(std::vector<ScaledColumn>{{3, Rgb(2)}}, sums);
  EXPECT_EQ(spent.entries, 30u + 40 + 6 + 2 + 40);
  EXPECT_EQ(metered.total(), spent);
  m.row(3, expected);
  EXPECT_TRUE(std::equal(row.begin(), row.end(), expected.begin()));
  m.column(4, expected);
  EXPECT_EQ(column, expected);
  EXPECT_EQ(metered.capabilities(), m.capabilities());
}

TEST(MeteredMatrix, CountsWhatReadersOfAllThreadsAskForWhileTheyAreThere) {
  const DenseMatrix m = low_rank_matrix({64, 50, 1}, 3);
  const MeteredMatrix metered(m);
  const std::vector<Index> rows{1, 5, 9};
  const auto kept = metered.reader();
  kept->set_rows(rows);
  std::vector<Rgb> out(3);
  kept->column(2, out);
  EXPECT_EQ(metered.total().entries, 3u);
  with_threads(4, [&] {
    parallel_for(1000, 1, [&](std::size_t k, std::size_t) {
      const auto reader = metered.reader();
      reader->set_rows(rows);
      std::vector<Rgb> values(3);
      std::vector<float> scalars(3);
      const Cost cost = reader->column(static_cast<Index>(k % 50), values) +
                        reader->unoccluded_scalars(static_cast<Index>(k % 50), Rgb(1), scalars);
      EXPECT_EQ(cost.entries, 6u);
    });
  });
  EXPECT_EQ(metered.total().entries, 6003u);
  EXPECT_EQ(metered.total().rays + metered.total().culled, 6003u);
}

TEST(Capabilities, AreSets) {
  constexpr Capabilities some{Ability::bounds, Ability::row_pixel};
  static_assert(some.has(Ability::bounds) && !some.has(Ability::row_normal));
  EXPECT_TRUE(some.without(Capabilities::all()).empty());
  EXPECT_EQ(some.with({Ability::row_pixel}), some);
  EXPECT_EQ(describe({}), "");
  EXPECT_EQ(describe(some), "bounds on what groups of lights can add and the receivers' pixels");
}

// Features count if there is one for each row or column; an empty matrix lacks none.
TEST(Capabilities, FollowFromFeatures) {
  DenseMatrix m = low_rank_matrix({20, 30, 1}, 3);
  EXPECT_TRUE(m.capabilities().has(Ability::row_pixel));
  EXPECT_FALSE(m.capabilities().has(Ability::row_weight));
  m.row_weight.assign(20, 1.0f);
  EXPECT_TRUE(m.capabilities().has(Ability::row_weight));
  EXPECT_EQ(DenseMatrix(0, 0, {}).capabilities(), Capabilities::all());
  EXPECT_FALSE(hazy_matrix({20, 30, 1}).capabilities().has(Ability::binary_visibility));
  EXPECT_TRUE(occluded_matrix({20, 30, 1}, 3).capabilities().has(Ability::binary_visibility));
}

}  // namespace
}  // namespace lumirank::matrix
