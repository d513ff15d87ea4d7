// A reader's entries are the matrix's, to the bit, whatever rows are set. Rays that graze an edge may end
// differently in another packet (some in 100,000 of these random ends do), so one visibility in 10,000 may
// differ.
#include <gtest/gtest.h>

#include "matrix/entry_reader.h"
#include "matrix/metered_matrix.h"
#include "matrix_fixture.h"
#include "transport/lights/sphere_lights.h"

namespace lumirank::transport::testing {
namespace {

using matrix::Index;
using matrix::Part;

constexpr std::size_t kReadRows = 700, kReadColumns = 300;

// What is summed on the way is what would be summed of the entries, in the same order. Returns how many
// entries that took.
std::size_t expect_same_sums(matrix::EntryReader& reader, std::span<const Index> rows,
                             std::span<const Rgb> whole) {
  const Rgb weights(0.5f, 0.2f, 0.3f);
  std::vector<float> scalars(rows.size());
  for (Index j = 0; j < kReadColumns; ++j) {
    reader.unoccluded_scalars(j, weights, scalars);
    for (std::size_t a = 0; a < rows.size(); ++a) {
      const Rgb e = whole[rows[a] * kReadColumns + j];
      EXPECT_EQ(scalars[a], weights.r * e.r + weights.g * e.g + weights.b * e.b);
    }
  }
  // Every fourth column, and three shares of each, of which every fifth column has none.
  std::vector<matrix::ScaledColumn> columns;
  std::vector<float> shares;
  for (Index j = 0; j < kReadColumns; j += 4) {
    const auto x = static_cast<float>(j);
    columns.push_back({j, Rgb(1, 0.5f, 2 + x)});
    for (const float share : {0.5f, 0.0f, 1.0f}) shares.push_back(j % 5 == 0 ? 0 : share * (1 + x));
  }
  std::vector<std::uint32_t> of(rows.size());
  for (std::size_t a = 0; a < of.size(); ++a) of[a] = static_cast<std::uint32_t>(a % 3);
  std::vector<Rgb> sums(rows.size(), Rgb(0));
  reader.add_unoccluded(columns, shares, of, sums);
  for (std::size_t a = 0; a < rows.size(); ++a) {
    Rgb expected(0);
    for (std::size_t k = 0; k < columns.size(); ++k)
      expected +=
          columns[k].scale * shares[3 * k + of[a]] * whole[rows[a] * kReadColumns + columns[k].column];
    EXPECT_EQ(sums[a], expected);
  }
  return rows.size() * (kReadColumns + columns.size() * 4 / 5);
}

class SceneReader : public ::testing::TestWithParam<bool> {};

TEST_P(SceneReader, GivesTheMatrixOwnEntries) {
  scenedesc::SceneDesc desc = room_with_blocks();
  add_all_bsdfs(desc);
  const world::World world = build_world(desc);
  RandomEnds ends = random_ends(world, kReadRows, kReadColumns, 11);
  if (GetParam()) make_spherical(ends.lights, world, {2});
  const SceneMatrix matrix(world, ends.receivers, ends.lights, {});
  std::vector<Rgb> whole(kReadRows * kReadColumns);
  Rng rng(5, Stage::test);
  for (const Part part : {Part::value, Part::unoccluded, Part::visibility}) {
    for (Index i = 0; i < kReadRows; ++i)
      matrix.row(i, std::span(whole).subspan(i * kReadColumns, kReadColumns), part);
    const matrix::MeteredMatrix metered(matrix);
    std::size_t asked = 0, grazing = 0;
    const auto same = [&](Rgb got, Index i, Index j) {
      const Rgb expected = whole[i * kReadColumns + j];
      if (got == expected) return;
      EXPECT_TRUE(part != Part::unoccluded && (is_black(got) || is_black(expected))) << i << ' ' << j;
      ++grazing;
    };
    {
      const auto reader = metered.reader();
      for (const std::size_t count : {1, 300, 16, 0, 37}) {
        std::vector<Index> rows(count);
        for (Index& i : rows) i = static_cast<Index>(rng.next_below(kReadRows));
        reader->set_rows(rows);
        std::vector<Rgb> out(count);
        for (Index j = 0; j < kReadColumns; ++j) {
          reader->column(j, out, part);
          asked += count;
          for (std::size_t a = 0; a < count; ++a) same(out[a], rows[a], j);
        }
        if (count == 0) continue;
        if (part == Part::unoccluded) asked += expect_same_sums(*reader, rows, whole);
        std::vector<std::uint32_t> places(1000);
        std::vector<Index> js(places.size());
        for (std::uint32_t& place : places) place = static_cast<std::uint32_t>(rng.next_below(count));
        for (Index& j : js) j = static_cast<Index>(rng.next_below(kReadColumns));
        std::vector<Rgb> some(places.size());
        reader->entries_at(places, js, some, part);
        asked += some.size();
        for (std::size_t k = 0; k < some.size(); ++k) same(some[k], rows[places[k]], js[k]);
      }
      std::vector<Index> is(6000), js(is.size());
      for (Index& i : is) i = static_cast<Index>(rng.next_below(kReadRows));
      for (Index& j : js) j = static_cast<Index>(rng.next_below(kReadColumns));
      std::vector<Rgb> out(is.size());
      reader->entries(is, js, out, part);
      asked += out.size();
      for (std::size_t k = 0; k < out.size(); ++k) same(out[k], is[k], js[k]);
    }
    EXPECT_LE(grazing, asked / 10000);
    EXPECT_EQ(metered.total().entries, asked);
  }
}

INSTANTIATE_TEST_SUITE_P(Lights, SceneReader, ::testing::Bool(),
                         [](const auto& lights) { return lights.param ? "Spheres" : "Points"; });

}  // namespace
}  // namespace lumirank::transport::testing
