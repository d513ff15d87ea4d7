// Bounds in participating media: above the integrals that entries estimate, wherever rows and lights are
// farther from each other than a quarter of their length.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "base/random.h"
#include "transport/foggy_room.h"
#include "transport/pairs/media_row_bounds.h"

namespace lumirank::transport {
namespace {

using matrix::ColumnSet;
using matrix::Emission;
using matrix::Index;

// The means of entries over matrices whose places are drawn anew, and what these may err by.
struct Integrals {
  std::size_t rows, columns;
  std::vector<double> mean, square;  // of the green channel
  static constexpr int kSeeds = 64;

  Integrals() {
    const MediaMatrix first = room().matrix(false);
    rows = first.rows(), columns = first.columns();
    mean.resize(rows * columns), square.resize(rows * columns);
    std::vector<Index> all_rows(rows), all_columns(columns);
    for (std::size_t i = 0; i < rows; ++i) all_rows[i] = static_cast<Index>(i);
    for (std::size_t j = 0; j < columns; ++j) all_columns[j] = static_cast<Index>(j);
    std::vector<Rgb> entries(rows * columns);
    for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
      room().matrix(false, seed).block(all_rows, all_columns, entries, matrix::Part::value);
      for (std::size_t k = 0; k < entries.size(); ++k) {
        const auto g = static_cast<double>(entries[k].g);
        mean[k] += g / kSeeds, square[k] += g * g / kSeeds;
      }
    }
  }
  double least(std::size_t i, std::size_t j) const {  // that the integral may be, within four standard errors
    const std::size_t k = i * columns + j;
    const double variance = std::max(0.0, square[k] - mean[k] * mean[k]);
    return mean[k] - 4 * std::sqrt(variance / kSeeds);
  }
};

Vec3f end_of_row(const Receivers& rows, Index i, float part) {
  if (i < rows.size()) return rows.position[i];
  const EyeSegments& s = rows.segments;
  const std::size_t k = i - rows.size();
  return s.origin[k] + s.direction[k] * (part * s.length[k]);
}

// Whether all of the row keeps away from the set's box.
bool apart(const Receivers& rows, Index i, const ColumnSet& set) {
  const float row_length = i < rows.size() ? 0.0f : rows.segments.length[i - rows.size()];
  const float away = 0.25f * std::max(row_length, length(set.box.diagonal()));
  Bounds3f box;
  box.extend(end_of_row(rows, i, 0)), box.extend(end_of_row(rows, i, 1));
  return length_squared(max(max(set.box.lo - box.hi, box.lo - set.box.hi), Vec3f{})) > away * away;
}

TEST(MediaRowBounds, AreAboveTheIntegrals) {
  const MediaMatrix m = room().matrix(false);
  const Integrals integrals;
  const auto bounds = m.row_bounds();
  Rng rng(31, Stage::test);
  std::size_t asked = 0, bright = 0;
  double tightest = 0;
  for (int trial = 0; trial < 4000; ++trial) {
    std::vector<Index> rows;
    const std::size_t count = trial % 3 == 0 ? 1 : 1 + rng.next_below(9);
    for (std::size_t k = 0; k < count; ++k) rows.push_back(static_cast<Index>(rng.next_below(m.rows())));
    bounds->set_rows(rows);
    // Columns of one kind, that follow each other in the order of paths.
    const auto first = static_cast<Index>(rng.next_below(m.columns()));
    ColumnSet set = m.column_set(first);
    std::vector<Index> columns{first};
    for (Index j = first + 1; j < m.columns() && columns.size() < 1 + rng.next_below(4); ++j) {
      const ColumnSet next = m.column_set(j);
      if (next.emission != set.emission || next.medium != set.medium) continue;
      set = join(set, next);
      columns.push_back(j);
    }
    const Rgb bound = bounds->bound(set);
    const matrix::BoundParts parts = bounds->parts(set);
    EXPECT_LE(parts.far, parts.near);
    for (const Index i : rows) {
      const bool far_away = set.emission == Emission::directional || apart(room().rows, i, set);
      double sum = 0;
      for (const Index j : columns) sum += std::max(0.0, integrals.least(i, j));
      // No bound of 0 is wrong, however near.
      ASSERT_TRUE(bound.g > 0 || sum == 0) << i << ' ' << first;
      if (!far_away || !std::isfinite(bound.g)) continue;
      ASSERT_LE(sum, static_cast<double>(bound.g) * (1 + 1e-5))
          << "row " << i << " of " << rows.size() << ", column " << first << " of " << columns.size()
          << ", emission " << static_cast<int>(set.emission);
      ++asked, bright += sum > 0;
      if (bound.g > 0) tightest = std::max(tightest, sum / static_cast<double>(bound.g));
    }
  }
  EXPECT_GT(asked, 2000u);
  EXPECT_GT(bright, 500u);
  EXPECT_GT(tightest, 0.5);
}

TEST(MediaRowBounds, OfRaysAreFiniteEverywhere) {
  const MediaMatrix m = room().matrix(false);
  const auto bounds = m.row_bounds();
  for (Index j = 0; j < m.columns(); ++j) {
    const ColumnSet set = m.column_set(j);
    if (set.emission != Emission::ray) continue;
    for (Index i = 0; i < m.rows(); ++i) {
      bounds->set_rows({&i, 1});
      const Rgb bound = bounds->bound(set);
      for (int c = 0; c < 3; ++c) ASSERT_TRUE(std::isfinite(bound[c])) << i << ' ' << j;
    }
  }
}

// What a ray scatters, by hand.
TEST(MediaRowBounds, KnowWhatARayScatters) {
  const media::PhaseFunction isotropic{};
  media::Field extinction, albedo;
  extinction.scale = Rgb(0.5f), albedo.scale = Rgb(0.8f);
  const media::Medium fog(media::Medium::Form::extinction_and_albedo, extinction, albedo, {}, isotropic);
  const ColumnSet set = ray_set(fog, 0, {1, 0, 0}, {0, 1, 0}, 3, Rgb(2));
  EXPECT_FLOAT_EQ(set.intensity.g, 2 * 0.5f * 0.8f * 3);
  EXPECT_FLOAT_EQ(set.min_length, 3);
  EXPECT_EQ(set.box.lo, (Vec3f{1, 0, 0}));
  EXPECT_EQ(set.box.hi, (Vec3f{1, 3, 0}));
}

}  // namespace
}  // namespace lumirank::transport
