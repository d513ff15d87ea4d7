// Bounds of entries: above every sum of entries, and equal to the entry where nothing is lost.
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <tuple>

#include "matrix/entry_bounds.h"
#include "matrix_fixture.h"

namespace lumirank::transport::testing {
namespace {

using matrix::ColumnSet;
using matrix::Emission;
using matrix::Index;
using matrix::Part;

struct Case {
  std::string name;
  float clamp = 0, traced_below = 0;
  bool spheres = false;
  SphereRules rules;
};
std::vector<Case> cases() {
  std::vector<Case> all{{"unclamped", 0, 0, false, {}},
                        {"clamped", 0.03f, 0, false, {}},
                        {"traced", 0.03f, 0.15f, false, {}},
                        {"all_traced", 0, 2, false, {}},
                        {"spheres", 0.03f, 0, true, {}}};
  SphereRules rules;
  rules.indicator = SphereRules::Indicator::cosine, rules.beyond = 1.5f;
  all.push_back({"spheres_by_cosine", 0, 0, true, rules});
  rules = {};
  rules.samples = SphereRules::Samples::cone;
  all.push_back({"spheres_by_cone", 0, 0, true, rules});
  return all;
}

class RowBoundsOfScenes : public ::testing::TestWithParam<int> {
 protected:
  static constexpr std::size_t kRows = 900, kColumns = 800;

  static void SetUpTestSuite() {
    scenedesc::SceneDesc desc = room_with_blocks();
    add_all_bsdfs(desc);
    world_ = std::make_unique<world::World>(build_world(desc));
  }
  static void TearDownTestSuite() { world_.reset(); }

  void SetUp() override {
    the_case_ = cases()[static_cast<std::size_t>(GetParam())];
    ends_ = random_ends(*world_, kRows, kColumns, 21);
    if (the_case_.spheres) {
      Rng rng(22, Stage::test);
      for (std::size_t j = 0; j < kColumns; ++j) {
        const bool surface = ends_.lights.kind[j] == LightKind::surface;
        ends_.lights.radius.push_back(surface ? std::exp(-4 * rng.next_float()) : 0.0f);
        ends_.lights.hidden.push_back(rng.next_float() < 0.5f ? 0.9f * rng.next_float() : 0.0f);
      }
    }
    SceneMatrixSettings settings;
    settings.clamp = the_case_.clamp, settings.traced_direct_below = the_case_.traced_below;
    settings.spheres = the_case_.rules;
    matrix_ = std::make_unique<SceneMatrix>(*world_, ends_.receivers, ends_.lights, settings);
    entries_.resize(kRows * kColumns);
    for (Index i = 0; i < kRows; ++i)
      matrix_->row(i, std::span(entries_).subspan(i * kColumns, kColumns), Part::unoccluded);
  }

  static std::unique_ptr<world::World> world_;
  Case the_case_;
  RandomEnds ends_;
  std::unique_ptr<SceneMatrix> matrix_;
  std::vector<Rgb> entries_;
};
std::unique_ptr<world::World> RowBoundsOfScenes::world_;

// The count things of `all` that are nearest to a random one of them, or random ones.
std::vector<Index> some_of(const std::vector<Index>& all, const std::vector<Vec3f>& places, std::size_t count,
                           Rng& rng) {
  std::vector<Index> some = all;
  if (rng.next_float() < 0.3f) {
    for (std::size_t k = 0; k < some.size(); ++k)
      std::swap(some[k], some[k + rng.next_below(some.size() - k)]);
  } else {
    const Vec3f p = places[all[rng.next_below(all.size())]];
    std::sort(some.begin(), some.end(), [&](Index a, Index b) {
      const float da = length_squared(places[a] - p), db = length_squared(places[b] - p);
      return da != db ? da < db : a < b;
    });
  }
  some.resize(std::min(count, some.size()));
  return some;
}

TEST_P(RowBoundsOfScenes, AreAboveAllSums) {
  Rng rng(23, Stage::test, static_cast<std::uint64_t>(GetParam()));
  std::map<std::tuple<Emission, bool>, std::vector<Index>> kinds;
  for (Index j = 0; j < kColumns; ++j) {
    const ColumnSet set = matrix_->column_set(j);
    kinds[{set.emission, set.spherical}].push_back(j);
  }
  std::vector<Index> rows(kRows);
  for (Index i = 0; i < kRows; ++i) rows[i] = i;
  const auto bounds = matrix_->row_bounds();
  std::size_t finite = 0, infinite = 0;
  const std::size_t row_counts[] = {1, 1, 1, 2, 4, 8, 20, 300};
  for (int trial = 0; trial < 1200; ++trial) {
    const auto some_rows = some_of(rows, ends_.receivers.position, row_counts[rng.next_below(8)], rng);
    bounds->set_rows(some_rows);
    for (const auto& [kind, columns] : kinds) {
      for (const std::size_t count : {1, 2, 7, 30}) {
        const auto some = some_of(columns, ends_.lights.position, count, rng);
        ColumnSet set = matrix_->column_set(some[0]);
        for (std::size_t k = 1; k < some.size(); ++k) set = join(set, matrix_->column_set(some[k]));
        const Rgb bound = bounds->bound(set);
        ++(std::isfinite(max_component(bound)) ? finite : infinite);
        const matrix::BoundParts parts = bounds->parts(set);
        ASSERT_LE(parts.far, parts.near);
        for (int c = 0; c < 3; ++c)
          ASSERT_EQ(bound[c] > 0, parts.reflected[c] > 0 && set.ceiling[c] > 0) << bound[c];
        for (const Index i : some_rows) {
          double sum[3] = {0, 0, 0};
          for (const Index j : some)
            for (int c = 0; c < 3; ++c) sum[c] += entries_[i * kColumns + j][c];
          for (int c = 0; c < 3; ++c)
            ASSERT_LE(sum[c], bound[c] * (1 + 1e-6))
                << "row " << i << " of " << some_rows.size() << ", column " << some[0] << " of "
                << some.size() << ", kind " << static_cast<int>(ends_.lights.kind[some[0]]) << " closure "
                << ends_.lights.closure[some[0]] << " row's " << ends_.receivers.closure[i];
        }
      }
    }
  }
  if (the_case_.clamp > 0) {
    EXPECT_LT(infinite, finite / 5);
  }
}

INSTANTIATE_TEST_SUITE_P(Cases, RowBoundsOfScenes, ::testing::Range(0, static_cast<int>(cases().size())),
                         [](const auto& at) { return cases()[static_cast<std::size_t>(at.param)].name; });

// One lambertian receiver and one light whose emission is known: the bound is the entry.
TEST(RowBounds, OfOneMattPairAreTheEntry) {
  const world::World world = build_world(room_with_blocks());
  Rng rng(24, Stage::test);
  RandomEnds ends;
  for (int i = 0; i < 300; ++i) {
    const Vec3f n = random_direction(rng);
    add_receiver(ends.receivers, random_direction(rng) * 0.5f, n, n, Rgb(rng.next_float(), 0.5f, 0.25f));
  }
  for (int j = 0; j < 300; ++j) {
    const LightKind kinds[] = {LightKind::omni, LightKind::oriented, LightKind::surface,
                               LightKind::directional};
    add_light(ends.lights, kinds[j % 4], random_direction(rng) * 1.5f,
              j % 4 == 0 ? Vec3f{} : random_direction(rng), Rgb(rng.next_float(), 1, 2));
  }
  SceneMatrixSettings settings;
  settings.clamp = 0;
  const SceneMatrix matrix(world, ends.receivers, ends.lights, settings);
  const auto bounds = matrix.row_bounds();
  std::vector<Rgb> row(300);
  std::size_t black = 0;
  for (Index i = 0; i < 300; ++i) {
    matrix.row(i, row, Part::unoccluded);
    bounds->set_rows({&i, 1});
    for (Index j = 0; j < 300; ++j) {
      const Rgb bound = bounds->bound(matrix.column_set(j));
      // Cosines get a slack of 3e-7 and are seldom below 1e-3.
      for (int c = 0; c < 3; ++c)
        ASSERT_NEAR(bound[c], row[j][c], 1e-5f * row[j][c] + 1e-5f) << i << ' ' << j;
      black += is_black(row[j]) == is_black(bound);
    }
  }
  EXPECT_GT(black, 300u * 300u * 999 / 1000);
}

}  // namespace
}  // namespace lumirank::transport::testing
