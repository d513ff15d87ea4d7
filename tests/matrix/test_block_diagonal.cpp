// The matrix of several instants: each block where it belongs, nothing elsewhere, whoever asks.
#include <gtest/gtest.h>

#include <set>

#include "base/error.h"
#include "matrix/block_diagonal.h"
#include "matrix/entry_reader.h"
#include "matrix/synthetic.h"

namespace lumirank::matrix {
namespace {

struct Blocks {
  std::vector<std::shared_ptr<const LightingMatrix>> blocks;
  DenseMatrix whole;

  static Blocks make() {
    std::vector<std::shared_ptr<const DenseMatrix>> made;
    std::size_t rows = 0, columns = 0;
    // Of different sizes, one without rows.
    const std::vector<SyntheticSize> sizes = {{6, 9, 1}, {4, 11, 2}, {0, 5, 3}, {8, 3, 4}};
    for (const SyntheticSize& size : sizes) {
      made.push_back(std::make_shared<DenseMatrix>(low_rank_matrix(size, 2)));
      rows += size.rows, columns += size.columns;
    }
    std::vector<Rgb> entries(rows * columns);
    std::size_t first_row = 0, first_column = 0;
    for (const auto& b : made) {
      for (std::size_t i = 0; i < b->rows(); ++i)
        for (std::size_t j = 0; j < b->columns(); ++j)
          entries[(first_row + i) * columns + first_column + j] = b->at(i, j);
      first_row += b->rows(), first_column += b->columns();
    }
    return {{made.begin(), made.end()}, DenseMatrix(rows, columns, std::move(entries))};
  }
};

TEST(BlockDiagonal, HasTheEntriesOfItsBlocksAndNoOthers) {
  const Blocks made = Blocks::make();
  const BlockDiagonal all(made.blocks);
  const DenseMatrix& whole = made.whole;
  ASSERT_EQ(all.rows(), 18u);
  ASSERT_EQ(all.columns(), 28u);
  std::vector<Index> every_row, every_column;
  for (Index i = 0; i < all.rows(); ++i) every_row.push_back(i);
  for (Index j = 0; j < all.columns(); ++j) every_column.push_back(all.columns() - 1 - j);
  std::vector<Rgb> have(all.rows() * all.columns(), Rgb(7)), want(have.size());
  all.block(every_row, every_column, have);
  whole.block(every_row, every_column, want);
  EXPECT_EQ(have, want);
  std::vector<Rgb> one(all.columns(), Rgb(7)), expected(all.columns());
  all.row(8, one), whole.row(8, expected);
  EXPECT_EQ(one, expected);
  one.assign(all.rows(), Rgb(7)), expected.resize(all.rows());
  all.column(15, one), whole.column(15, expected);
  EXPECT_EQ(one, expected);
  const std::vector<Index> rows{0, 17, 9, 3, 7}, columns{1, 27, 2, 3, 19};
  std::vector<Rgb> listed(5, Rgb(7)), wanted(5);
  all.entries(rows, columns, listed), whole.entries(rows, columns, wanted);
  EXPECT_EQ(listed, wanted);
}

TEST(BlockDiagonal, SumsAndReadersAgree) {
  const Blocks made = Blocks::make();
  const BlockDiagonal all(made.blocks);
  std::vector<ScaledColumn> columns;
  for (Index j = 0; j < all.columns(); ++j) columns.push_back({(j * 5) % 28, Rgb(0.5f)});
  std::vector<Rgb> sums(all.rows(), Rgb(1)), wanted(all.rows(), Rgb(1));
  const Cost cost = all.accumulate(columns, sums);
  EXPECT_EQ(cost.entries, 6u * 9 + 4 * 11 + 8 * 3);
  made.whole.accumulate(columns, wanted);
  for (std::size_t i = 0; i < sums.size(); ++i)
    for (int c = 0; c < 3; ++c) EXPECT_FLOAT_EQ(sums[i][c], wanted[i][c]) << i;

  const auto reader = all.reader();
  const std::vector<Index> rows{16, 2, 7, 3, 12};
  for (int again = 0; again < 2; ++again) {
    reader->set_rows(rows);
    for (const Index j : {0u, 13u, 21u, 27u}) {
      std::vector<Rgb> have(5, Rgb(7));
      reader->column(j, have, Part::value);
      for (std::size_t a = 0; a < 5; ++a) EXPECT_EQ(have[a], made.whole.at(rows[a], j)) << a << " " << j;
    }
    const std::vector<std::uint32_t> places{4, 0, 1, 2, 2, 3};
    const std::vector<Index> asked{26, 25, 8, 12, 3, 0};
    std::vector<Rgb> have(6, Rgb(7));
    reader->entries_at(places, asked, have, Part::value);
    for (std::size_t k = 0; k < 6; ++k) EXPECT_EQ(have[k], made.whole.at(rows[places[k]], asked[k])) << k;
  }
}

TEST(BlockDiagonal, SaysWhatBelongsToWhichInstant) {
  const Blocks made = Blocks::make();
  const BlockDiagonal all(made.blocks);
  const RowFeatures r = all.row_features();
  const ColumnFeatures c = all.column_features();
  ASSERT_EQ(r.instant.size(), 18u);
  ASSERT_EQ(c.instant.size(), 28u);
  EXPECT_EQ(r.instant[5], 0);
  EXPECT_EQ(r.instant[6], 1);
  EXPECT_EQ(r.instant[10], 3);
  EXPECT_EQ(c.instant[20], 2);
  EXPECT_EQ(c.power[9], made.blocks[1]->column_features().power[0]);
  // Blocks count alike; the whole does not.
  EXPECT_EQ(std::set<std::uint64_t>(c.id.begin(), c.id.end()).size(), 28u);
  EXPECT_EQ(std::set<std::uint64_t>(r.id.begin(), r.id.end()).size(), 18u);
  EXPECT_EQ(all.capabilities(), made.blocks[0]->capabilities());
  // Bounds hold for rows of several instants.
  const auto bounds = all.row_bounds();
  const std::vector<Index> rows{1, 7, 11};
  bounds->set_rows(rows);
  for (Index j = 0; j < all.columns(); ++j) {
    const Rgb bound = bounds->bound(all.column_set(j));
    for (const Index i : rows)
      for (int k = 0; k < 3; ++k) EXPECT_GE(bound[k], made.whole.at(i, j)[k]);
  }
  EXPECT_THROW(BlockDiagonal({}), InternalError);
}

}  // namespace
}  // namespace lumirank::matrix
