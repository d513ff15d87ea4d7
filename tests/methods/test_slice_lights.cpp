// Columns of slices: who represents a cluster does not hang on the order of the columns.
#include <gtest/gtest.h>

#include <set>

#include "base/random.h"
#include "matrix/synthetic.h"
#include "methods/common/slices/slice_lights.h"

namespace lumirank::methods {
namespace {

using matrix::Index;

// Columns of `m` whose ids are their first indices, column k here being (k·step + 13) mod columns there.
matrix::DenseMatrix in_another_order(const matrix::DenseMatrix& m, std::size_t step) {
  const std::size_t rows = m.rows(), columns = m.columns();
  std::vector<Rgb> entries(rows * columns);
  std::vector<std::uint64_t> ids(columns);
  for (std::size_t k = 0; k < columns; ++k) {
    const std::size_t j = (k * step + 13) % columns;
    ids[k] = mix64(j);
    for (std::size_t i = 0; i < rows; ++i) entries[i * columns + k] = m.at(i, j);
  }
  matrix::DenseMatrix other(rows, columns, std::move(entries));
  other.pixel = m.pixel, other.row_position = m.row_position, other.row_normal = m.row_normal;
  other.column_id = std::move(ids);
  return other;
}

// Ids of the one column that each slice draws, and the second that splitting gives.
std::vector<std::set<std::uint64_t>> drawn_ids(const matrix::DenseMatrix& m, std::uint64_t seed) {
  SliceLightSettings settings;
  settings.columns = 2, settings.initial_clusters = 1, settings.slice_rows = 20, settings.projection = 0;
  settings.zero_columns = ZeroColumns::ignore;
  RunOptions options;
  options.seed = seed;
  const RunClock clock(options);
  std::vector<Rgb> sums(m.rows());
  const SliceLights lights(m, options, clock, 0, settings, sums);
  EXPECT_TRUE(lights.ready());
  std::vector<std::set<std::uint64_t>> all;
  SliceLights::Workspace w;
  for (std::size_t s = 0; s < lights.slices().count(); ++s) {
    lights.choose(s, w);
    std::set<std::uint64_t>& ids = all.emplace_back();
    for (const matrix::ScaledColumn& c : w.chosen) ids.insert(m.column_id[c.column]);
  }
  return all;
}

TEST(SliceLights, RepresentativesAreTheSameInAnotherOrder) {
  const matrix::DenseMatrix m = matrix::low_rank_matrix({400, 300, 1}, 5);
  const auto drawn = drawn_ids(in_another_order(m, 1), 7);
  EXPECT_EQ(drawn, drawn_ids(in_another_order(m, 77), 7));
  EXPECT_EQ(drawn, drawn_ids(in_another_order(m, 271), 7));
  EXPECT_NE(drawn, drawn_ids(in_another_order(m, 1), 8));
  std::set<std::uint64_t> distinct;
  for (const auto& ids : drawn) distinct.insert(ids.begin(), ids.end());
  EXPECT_GT(distinct.size(), drawn.size());  // slices draw by themselves
}

}  // namespace
}  // namespace lumirank::methods
