// All ways of asking for an entry give the same number, on every synthetic matrix.
#include <gtest/gtest.h>

#include <numeric>

#include "base/error.h"
#include "matrix/synthetic.h"

namespace lumirank::matrix {
namespace {

std::vector<DenseMatrix> all_synthetic() {
  std::vector<DenseMatrix> all;
  all.push_back(clustered_matrix({60, 45, 1}, 5));
  all.push_back(low_rank_matrix({60, 45, 2}, 4, 3));
  all.push_back(sparse_matrix({60, 45, 3}, 0.2));
  all.push_back(recess_matrix({60, 45, 4}));
  all.push_back(occluded_matrix({60, 45, 5}, 6));
  all.push_back(hazy_matrix({60, 45, 6}));
  return all;
}

TEST(DenseMatrix, RowsColumnsBlocksAndListsAgree) {
  for (const DenseMatrix& m : all_synthetic())
    for (Part part : {Part::value, Part::unoccluded, Part::visibility}) {
      std::vector<Index> rows(m.rows()), columns(m.columns());
      std::iota(rows.begin(), rows.end(), 0u);
      std::iota(columns.begin(), columns.end(), 0u);
      std::vector<Rgb> block(m.rows() * m.columns()), row(m.columns()), column(m.rows());
      m.block(rows, columns, block, part);
      for (Index i = 0; i < m.rows(); ++i) {
        m.row(i, row, part);
        for (std::size_t j = 0; j < m.columns(); ++j) EXPECT_EQ(row[j], block[i * m.columns() + j]);
      }
      for (Index j = 0; j < m.columns(); ++j) {
        m.column(j, column, part);
        for (std::size_t i = 0; i < m.rows(); ++i) EXPECT_EQ(column[i], block[i * m.columns() + j]);
      }
      const std::vector<Index> some_rows{3, 3, 59}, some_columns{0, 44, 7};
      std::vector<Rgb> listed(3);
      m.entries(some_rows, some_columns, listed, part);
      for (std::size_t k = 0; k < 3; ++k)
        EXPECT_EQ(listed[k], block[some_rows[k] * m.columns() + some_columns[k]]);
    }
}

TEST(DenseMatrix, ValueIsUnoccludedTimesVisibility) {
  for (const DenseMatrix& m : all_synthetic())
    for (std::size_t i = 0; i < m.rows(); ++i)
      for (std::size_t j = 0; j < m.columns(); ++j) {
        const Rgb v = m.at(i, j, Part::visibility);
        EXPECT_TRUE(v == Rgb(0) || v == Rgb(1) || !m.capabilities().has(Ability::binary_visibility));
        EXPECT_EQ(m.at(i, j), m.at(i, j, Part::unoccluded) * v);
        EXPECT_GE(std::min({m.at(i, j).r, m.at(i, j).g, m.at(i, j).b}), 0.0f);
      }
}

TEST(DenseMatrix, AccumulatesScaledColumnsInOrderAndCounts) {
  const DenseMatrix m = low_rank_matrix({30, 20, 1}, 3);
  const std::vector<ScaledColumn> columns{{4, Rgb(2, 0, 1)}, {9, Rgb(0.5f)}, {4, Rgb(1)}};
  std::vector<Rgb> sums(30, Rgb(1)), expected(30, Rgb(1));
  for (std::size_t i = 0; i < 30; ++i)
    for (const auto& c : columns) expected[i] += c.scale * m.at(i, c.column);
  const Cost cost = m.accumulate(columns, sums);
  EXPECT_EQ(sums, expected);
  EXPECT_EQ(cost.entries, 90u);
  EXPECT_EQ(cost.culled + cost.rays, 90u);
}

TEST(DenseMatrix, StopsWhenCancelled) {
  const DenseMatrix m = low_rank_matrix({30, 20, 1}, 3);
  const std::atomic<bool> cancel{true};
  Sinks sinks;
  sinks.cancel = &cancel;
  std::vector<Rgb> sums(30);
  EXPECT_THROW(m.accumulate(std::vector<ScaledColumn>{{0, Rgb(1)}}, sums, sinks), Cancelled);
}

TEST(DenseMatrix, RefusesWrongSizes) {
  EXPECT_THROW(DenseMatrix(2, 3, std::vector<Rgb>(5)), InternalError);
  EXPECT_THROW(DenseMatrix(2, 3, std::vector<Rgb>(6), std::vector<float>(5)), InternalError);
}

TEST(Synthetic, FeaturesHaveTheLengthsOfTheMatrix) {
  for (const DenseMatrix& m : all_synthetic()) {
    EXPECT_EQ(m.row_features().pixel.size(), m.rows());
    EXPECT_EQ(m.column_features().power.size(), m.columns());
    // Zero power means a zero column: what power sampling relies on.
    for (std::size_t j = 0; j < m.columns(); ++j)
      for (std::size_t i = 0; i < m.rows(); ++i) EXPECT_TRUE(m.power[j] > 0 || is_black(m.at(i, j)));
  }
}

TEST(Synthetic, ClusteredColumnsAreMultiples) {
  const DenseMatrix m = clustered_matrix({40, 30, 1}, 6);
  for (std::size_t j = 6; j < 30; ++j) {
    const Rgb a = m.at(0, j), b = m.at(0, j % 6);
    for (std::size_t i = 0; i < 40; ++i)
      for (int c = 0; c < 3; ++c)
        // Four roundings on each side.
        EXPECT_NEAR(m.at(i, j)[c] * b[c], m.at(i, j % 6)[c] * a[c], 8 * 0x1p-24 * m.at(i, j)[c] * b[c]);
  }
}

}  // namespace
}  // namespace lumirank::matrix
