// Columns modulo 2: ranks, pivots and completion of matrices whose rank is known.
#include "linalg/boolean_basis.h"

#include <gtest/gtest.h>

#include "base/random.h"

namespace lumirank::linalg {
namespace {

using Word = BooleanBasis::Word;
constexpr std::size_t kRows = 200, kWords = 4, kRank = 12;

// Column j: a random sum of kRank random columns.
std::vector<Word> column(std::uint64_t j) {
  std::vector<Word> sum(kWords, 0);
  const std::uint64_t which = hash_ids(1, Stage::test, 40, j);
  for (std::size_t k = 0; k < kRank; ++k)
    if ((which >> k) & 1u)
      for (std::size_t w = 0; w < kWords; ++w) {
        const Word mask = w + 1 < kWords ? ~Word{0} : (Word{1} << (kRows - 64 * (kWords - 1))) - 1;
        sum[w] ^= hash_ids(2, Stage::test, k, w) & mask;
      }
  return sum;
}

// 200 random rows have full rank 12 but for one matrix in 2^188; 60 sums of 12 vectors span them all but for
// one in 2^48.
TEST(BooleanBasis, FindsTheRankAndAPivotForEachVector) {
  BooleanBasis basis;
  basis.clear(kRows);
  std::size_t added = 0;
  for (std::uint64_t j = 0; j < 60; ++j) added += basis.add(column(j));
  EXPECT_EQ(basis.rank(), kRank);
  EXPECT_EQ(added, kRank);
  EXPECT_FALSE(basis.add(std::vector<Word>(kWords, 0)));
  basis.clear(kRows);
  EXPECT_EQ(basis.rank(), 0u);
}

TEST(BooleanBasis, CompletesSumsFromTheirPivots) {
  BooleanBasis basis;
  basis.clear(kRows);
  for (std::uint64_t j = 0; j < 60; ++j) basis.add(column(j));
  std::vector<Word> known(kWords, 0), value(kWords), sum(kWords);
  for (std::uint32_t p : basis.pivots()) known[p / 64] |= Word{1} << (p % 64);
  for (std::uint64_t j = 1000; j < 1100; ++j) {
    const auto whole = column(j);
    for (std::size_t w = 0; w < kWords; ++w) value[w] = whole[w] & known[w];
    EXPECT_EQ(basis.complete(known, value, sum), 0u);
    EXPECT_EQ(sum, whole);
  }
}

// A column with one wrong row is no sum of the others; rows beside the pivots show it. Each of 60 rows beside
// the pivots is wrong where the sum, made from the pivots alone, is not what the column has.
TEST(BooleanBasis, SeesColumnsThatAreNoSums) {
  BooleanBasis basis;
  basis.clear(kRows);
  for (std::uint64_t j = 0; j < 60; ++j) basis.add(column(j));
  std::vector<Word> known(kWords, 0), sum(kWords);
  for (std::uint32_t p : basis.pivots()) known[p / 64] |= Word{1} << (p % 64);
  auto wrong = column(2000);
  std::uint32_t row = 0;
  while ((known[row / 64] >> (row % 64)) & 1u) ++row;
  wrong[row / 64] ^= Word{1} << (row % 64);
  known[row / 64] |= Word{1} << (row % 64);
  std::vector<Word> value(kWords);
  for (std::size_t w = 0; w < kWords; ++w) value[w] = wrong[w] & known[w];
  EXPECT_EQ(basis.complete(known, value, sum), 1u);
  EXPECT_EQ(sum, column(2000));
}

}  // namespace
}  // namespace lumirank::linalg
