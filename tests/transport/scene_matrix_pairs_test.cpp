// Random pairs of every kind of receiver and light, against the definition of an entry written out for one
// pair.
#include <gtest/gtest.h>

#include <cmath>

#include "base/parallel.h"
#include "matrix/metered_matrix.h"
#include "matrix_fixture.h"

namespace lumirank::transport::testing {
namespace {

using matrix::Index;
using matrix::Part;

class SceneMatrixPairs : public ::testing::Test {
 protected:
  static constexpr std::size_t kRows = 600, kColumns = 500;

  static void SetUpTestSuite() {
    scenedesc::SceneDesc desc = room_with_blocks();
    add_all_bsdfs(desc);
    world_ = std::make_unique<world::World>(build_world(desc));
    ends_ = std::make_unique<RandomEnds>(random_ends(*world_, kRows, kColumns, 7));
  }
  static void TearDownTestSuite() { ends_.reset(), world_.reset(); }

  static SceneMatrix make(float clamp = 0) {
    SceneMatrixSettings settings;
    settings.clamp = clamp;
    return SceneMatrix(*world_, ends_->receivers, ends_->lights, settings);
  }
  static std::vector<Rgb> all(const matrix::LightingMatrix& matrix, Part part) {
    std::vector<Rgb> out(kRows * kColumns);
    for (Index i = 0; i < kRows; ++i) matrix.row(i, std::span(out).subspan(i * kColumns, kColumns), part);
    return out;
  }

  static std::unique_ptr<world::World> world_;
  static std::unique_ptr<RandomEnds> ends_;
};
std::unique_ptr<world::World> SceneMatrixPairs::world_;
std::unique_ptr<RandomEnds> SceneMatrixPairs::ends_;

// One entry by the definition, in double precision but for scatter::eval_f.
struct Pair {
  double e[3] = {0, 0, 0};
  double bound = 0;      // a·G·(π f_x)(π f_y)
  double slack = 0;      // absolute
  bool grazing = false;  // some cosine is nothing but rounding
};
// How much f moves when each coordinate of both directions moves by 4 roundings of a float: what no
// evaluation in floats can know better.
double wobble(const scatter::Closure& closure, Vec3f wo, Vec3f wi, bool adjoint) {
  const Rgb f = scatter::eval_f(closure, wo, wi, adjoint);
  double sum = 0;
  for (int axis = 0; axis < 6; ++axis) {
    Vec3f moved[2] = {wo, wi};
    moved[axis / 3][axis % 3] += 2.4e-7f;
    const Rgb g = scatter::eval_f(closure, moved[0], moved[1], adjoint);
    double max_difference = 0;
    for (int c = 0; c < 3; ++c)
      max_difference = std::max(max_difference, static_cast<double>(std::abs(g[c] - f[c])));
    sum += max_difference;
  }
  return sum;
}
Pair one_pair(const RandomEnds& ends, Index i, Index j) {
  const Receivers& r = ends.receivers;
  const VirtualLights& l = ends.lights;
  Pair pair;
  const bool far = l.kind[j] == LightKind::directional;
  Vec3f w = far ? -l.normal[j] : l.position[j] - r.position[i];
  const double d = far ? 1 : length(w);
  w = w / static_cast<float>(d);
  const Rgb fx = scatter::eval_f(r.closure_at(i), r.wo[i], w);
  // A fiber has the sine of the angle to it instead.
  const double cos_x = r.closure_at(i).cosine(w);
  const double cos_y = l.kind[j] == LightKind::surface && l.closure_at(j).is_fiber()
                           ? l.closure_at(j).cosine(w)
                           : std::abs(dot(w, l.ng[j]));
  double g = cos_x / (d * d);
  double min_cosine = cos_x;
  Rgb fy(1);
  double fy_bound = kInvPi;
  if (l.kind[j] == LightKind::oriented) g *= std::max(0.0f, -dot(w, l.normal[j]));
  if (l.kind[j] == LightKind::surface) {
    g *= cos_y;
    fy = scatter::eval_f(l.closure_at(j), l.incoming[j], -w, true);
    fy_bound = max_component(fy);
  }
  if (l.kind[j] == LightKind::spot) {
    const SpotShape& spot = l.spots[l.closure[j]];
    const double angle = std::acos(std::clamp(-dot(w, l.normal[j]), -1.0f, 1.0f));
    // The angle is good to 3e-7 and the fall-off at least 0.15 wide.
    pair.slack = 2e-6 * max_component(l.power[j]) * max_component(fx) * g;
    fy = Rgb(static_cast<float>(std::clamp((spot.cutoff - angle) / (spot.cutoff - spot.beam), 0.0, 1.0)));
    if (spot.profile) {
      fy = spot.profile->intensity(spot.frame.to_local(-w));
      // The azimuth is good to 3e-7 over the sine; the table's slopes are 1 per radian and less.
      pair.slack *= 1 + 4 / std::max(1e-3, std::sin(angle));
      // At the edge of the table the intensity drops to 0.
      if (std::abs(angle - spot.cutoff) < 1e-6)
        pair.slack += 2 * max_component(l.power[j]) * max_component(fx) * g;
    }
  }
  double wobbles = wobble(r.closure_at(i), r.wo[i], w, false) * max_component(fy);
  if (l.kind[j] == LightKind::surface)
    wobbles += wobble(l.closure_at(j), l.incoming[j], -w, true) * max_component(fx);
  if (l.kind[j] == LightKind::oriented || l.kind[j] == LightKind::surface)
    min_cosine = std::min(min_cosine, cos_y);
  pair.grazing = min_cosine < 2e-6;
  pair.slack += wobbles * max_component(l.power[j]) * g;
  // A cosine is a sum of three products near 1, good to 3e-7.
  if (g > 0) pair.slack += 3e-7 / min_cosine * max_component(l.power[j] * fy * fx) * g;
  for (int c = 0; c < 3; ++c) pair.e[c] = static_cast<double>(l.power[j][c]) * fy[c] * fx[c] * g;
  pair.bound = l.area[j] * g * (kPi * max_component(fx)) * (kPi * fy_bound);
  return pair;
}

// Within 1e-5 and what the inputs' own rounding makes of it. Entries under a hundred-billionth of the
// greatest are compared absolutely: cosines near 0 have no relative precision.
TEST_F(SceneMatrixPairs, UnoccludedEntriesFollowTheDefinition) {
  const std::vector<Rgb> e = all(make(), Part::unoccluded);
  double max_entry = 0;
  for (const Rgb& c : e) max_entry = std::max(max_entry, static_cast<double>(max_component(c)));
  std::size_t not_black = 0;
  for (Index i = 0; i < kRows; ++i)
    for (Index j = 0; j < kColumns; ++j) {
      const Pair pair = one_pair(*ends_, i, j);
      if (pair.grazing) continue;
      const Rgb got = e[i * kColumns + j];
      not_black += !is_black(got);
      for (int c = 0; c < 3; ++c)
        ASSERT_NEAR(got[c], pair.e[c], 1e-5 * pair.e[c] + pair.slack + 1e-11 * max_entry)
            << "row " << i << ", column " << j << ", kind " << static_cast<int>(ends_->lights.kind[j]);
    }
  EXPECT_GT(not_black, kRows * kColumns / 10);
}

TEST_F(SceneMatrixPairs, AnEntryHasOneValueHoweverItIsAskedFor) {
  const SceneMatrix matrix = make(1);
  for (const Part part : {Part::value, Part::unoccluded, Part::visibility}) {
    const std::vector<Rgb> rows = all(matrix, part);
    std::vector<Rgb> column(kRows);
    for (Index j = 0; j < kColumns; ++j) {
      matrix.column(j, column, part);
      for (Index i = 0; i < kRows; ++i) ASSERT_EQ(column[i], rows[i * kColumns + j]) << i << ' ' << j;
    }
    Rng rng(3, Stage::test);
    std::vector<Index> is(97), js(131), pair_i(5000), pair_j(5000);
    for (Index& i : is) i = static_cast<Index>(rng.next_below(kRows));
    for (Index& j : js) j = static_cast<Index>(rng.next_below(kColumns));
    for (Index& i : pair_i) i = static_cast<Index>(rng.next_below(kRows));
    for (Index& j : pair_j) j = static_cast<Index>(rng.next_below(kColumns));
    std::vector<Rgb> block(is.size() * js.size()), entries(pair_i.size());
    matrix.block(is, js, block, part);
    for (std::size_t a = 0; a < is.size(); ++a)
      for (std::size_t b = 0; b < js.size(); ++b)
        ASSERT_EQ(block[a * js.size() + b], rows[is[a] * kColumns + js[b]]) << is[a] << ' ' << js[b];
    matrix.entries(pair_i, pair_j, entries, part);
    for (std::size_t k = 0; k < entries.size(); ++k)
      ASSERT_EQ(entries[k], rows[pair_i[k] * kColumns + pair_j[k]]) << pair_i[k] << ' ' << pair_j[k];
  }
}

TEST_F(SceneMatrixPairs, ValueIsUnoccludedTimesVisibility) {
  const SceneMatrix matrix = make(1);
  const std::vector<Rgb> value = all(matrix, Part::value), e = all(matrix, Part::unoccluded),
                         v = all(matrix, Part::visibility);
  for (std::size_t k = 0; k < value.size(); ++k) {
    ASSERT_TRUE(v[k] == Rgb(0) || v[k] == Rgb(1));
    ASSERT_EQ(value[k], e[k] * v[k]);
    ASSERT_FALSE(is_black(e[k]) && v[k] != Rgb(0));
  }
}

TEST_F(SceneMatrixPairs, VisibilityIsThatOfTheRayScene) {
  const SceneMatrix matrix = make();
  const std::vector<Rgb> v = all(matrix, Part::visibility), e = all(matrix, Part::unoccluded);
  std::size_t differ = 0, asked = 0, blocked = 0;
  for (Index i = 0; i < kRows; ++i)
    for (Index j = 0; j < kColumns; ++j) {
      if (is_black(e[i * kColumns + j])) continue;
      const bool far = ends_->lights.kind[j] == LightKind::directional;
      const Vec3f p = ends_->receivers.position[i];
      const Vec3f w = far ? -ends_->lights.normal[j] : ends_->lights.position[j] - p;
      // From 0.1 % off the receiver to 0.1 % before the light; to the far end of the room if there is none.
      const bool hidden = world_->rays().occluded({p, w, 1e-3f, far ? 100.0f : 0.999f}, 0);
      ++asked, blocked += hidden;
      differ += (v[i * kColumns + j] == Rgb(0)) != hidden;
    }
  EXPECT_GT(blocked, asked / 20);
  EXPECT_LT(blocked, asked - asked / 20);
  // The two rays start and end a little apart, so they may differ at edges and where walls meet: of rays of
  // length around 2, those that pass within 2e-3 of the room's edges, some 0.1 %.
  EXPECT_LE(differ, asked / 500);
}

TEST_F(SceneMatrixPairs, CostsAddUp) {
  const SceneMatrix scene = make();
  const matrix::MeteredMatrix metered(scene);
  const std::vector<Rgb> e = all(metered, Part::unoccluded);
  const matrix::Cost cost = metered.total();
  EXPECT_EQ(cost.rays, 0u);
  EXPECT_EQ(cost.entries, kRows * kColumns);
  const auto black = static_cast<std::uint64_t>(std::count(e.begin(), e.end(), Rgb(0)));
  // What is culled is black; what a lobe alone makes black is found after its ray.
  EXPECT_LE(cost.culled, black);
  EXPECT_GT(cost.culled, black / 2);
  std::vector<Rgb> sums(kRows);
  std::vector<matrix::ScaledColumn> columns;
  for (Index j = 0; j < kColumns; ++j) columns.push_back({j, Rgb(1)});
  const matrix::Cost summed = metered.accumulate(columns, sums, {});
  EXPECT_EQ(summed.entries, cost.entries);
  EXPECT_EQ(summed.culled, cost.culled);
  EXPECT_EQ(summed.rays, kRows * kColumns - cost.culled);
  EXPECT_EQ(metered.total(), cost + summed);
}

// What a call lost is the loss of its own entries, however much was evaluated before it; nothing where other
// parts of the picture give it back.
TEST_F(SceneMatrixPairs, ClampedEnergyIsTheCallsOwn) {
  const SceneMatrix scene = make(1e-3f);
  SceneMatrixSettings settings;
  settings.clamp = 1e-3f, settings.compensated = true;
  const SceneMatrix compensated(*world_, ends_->receivers, ends_->lights, settings);
  std::vector<Rgb> row(kColumns);
  const matrix::Cost first = scene.row(3, row, Part::value);
  all(scene, Part::value);
  EXPECT_EQ(scene.row(3, row, Part::value), first);
  EXPECT_EQ(first.lost, first.clamped);
  const matrix::Cost given_back = compensated.row(3, row, Part::value);
  EXPECT_EQ(given_back.clamped, first.clamped);
  EXPECT_EQ(given_back.lost, 0);
  double energy = 0;
  for (const Rgb& v : row) energy += static_cast<double>(v.r) + v.g + v.b;
  EXPECT_NEAR(first.energy, energy, 1e-12 * energy);
}

// What the matrix tells of all worlds is so: features of the right lengths, visibilities of 0 and 1.
TEST_F(SceneMatrixPairs, TellsWhatItSays) {
  VirtualLights lights = ends_->lights;
  lights.half.assign(lights.size(), 1);
  const SceneMatrix scene(*world_, ends_->receivers, lights, {});
  constexpr matrix::Capabilities kByCalls{matrix::Ability::bounds, matrix::Ability::binary_visibility};
  EXPECT_EQ(scene.matrix::LightingMatrix::capabilities().with(kByCalls), SceneMatrix::kCapabilities);
  EXPECT_EQ(scene.capabilities(), SceneMatrix::kCapabilities);
  for (const Rgb& v : all(scene, Part::visibility)) ASSERT_TRUE(v == Rgb(0) || v == Rgb(1));
}

TEST_F(SceneMatrixPairs, ClampedEntriesKeepTheBoundAndTheirColor) {
  const float limit = 1e-3f;
  const std::vector<Rgb> free = all(make(0), Part::unoccluded), held = all(make(limit), Part::unoccluded);
  std::size_t clamped = 0;
  for (Index i = 0; i < kRows; ++i)
    for (Index j = 0; j < kColumns; ++j) {
      const std::size_t k = i * kColumns + j;
      const double bound = one_pair(*ends_, i, j).bound;
      const double factor = bound > limit ? limit / bound : 1;
      if (factor < 1 - 1e-4) ++clamped;
      for (int c = 0; c < 3; ++c)
        ASSERT_NEAR(held[k][c], free[k][c] * factor, 2e-5 * free[k][c] * factor + 1e-12);
    }
  EXPECT_GT(clamped, 100u);
}

// A column that stands for `scale` times its area is one with a clamp that much lower; without clamping the
// bound is off.
TEST_F(SceneMatrixPairs, RepresentativesAreBoundedAsTheAreaTheyStandFor) {
  const float clamp = 0.03f, scale = 64, max_contribution = 0.5f;
  const auto sums_of = [&](const SceneMatrix& matrix, float bound) {
    std::vector<Rgb> sums(kRows);
    std::vector<matrix::ScaledColumn> columns;
    for (Index j = 0; j < kColumns; ++j) columns.push_back({j, Rgb(scale), bound});
    matrix.accumulate(columns, sums, {});
    return sums;
  };
  EXPECT_EQ(sums_of(make(clamp), max_contribution), sums_of(make(max_contribution / scale), 0));
  EXPECT_NE(sums_of(make(clamp), max_contribution), sums_of(make(clamp), 0));
  EXPECT_EQ(sums_of(make(clamp), 10 * scale), sums_of(make(clamp), 0));
  EXPECT_EQ(sums_of(make(0), max_contribution), sums_of(make(0), 0));
}

TEST_F(SceneMatrixPairs, ClampedFractionIsTheShareOfEnergyTakenAway) {
  const float limit = 1e-3f;
  const std::vector<Rgb> free = all(make(0), Part::value), held = all(make(limit), Part::value);
  Rng rng(5, Stage::test);
  std::vector<matrix::ScaledColumn> columns;
  double whole = 0, kept = 0;
  for (Index j = 0; j < kColumns; ++j) {
    columns.push_back({j, Rgb(rng.next_float() + 0.5f)});
    for (Index i = 0; i < kRows; ++i)
      for (int c = 0; c < 3; ++c) {
        whole += static_cast<double>(free[i * kColumns + j][c]) * columns.back().scale[c];
        kept += static_cast<double>(held[i * kColumns + j][c]) * columns.back().scale[c];
      }
  }
  const SceneMatrix scene = make(limit);
  std::vector<Rgb> sums(kRows);
  const matrix::Cost summed = scene.accumulate(columns, sums, {});
  EXPECT_GT(1 - kept / whole, 0.01);
  // Sums of at most 500 floats, and the clamping factors, are good to 1e-4 together.
  EXPECT_NEAR(clamped_fraction(summed), 1 - kept / whole, 1e-4);

  double whole_rows = 0, kept_rows = 0;
  for (const Rgb& c : free) whole_rows += static_cast<double>(c.r) + c.g + c.b;
  for (const Rgb& c : held) kept_rows += static_cast<double>(c.r) + c.g + c.b;
  const matrix::MeteredMatrix rowwise(scene);
  all(rowwise, Part::value);
  EXPECT_NEAR(clamped_fraction(rowwise.total()), 1 - kept_rows / whole_rows, 1e-5);
  EXPECT_EQ(make(0).accumulate(columns, sums, {}).clamped, 0);
}

TEST_F(SceneMatrixPairs, SumsAreThoseOfTheColumnsInTheirOrder) {
  const SceneMatrix matrix = make(1);
  Rng rng(6, Stage::test);
  std::vector<matrix::ScaledColumn> columns;
  for (int k = 0; k < 300; ++k)
    columns.push_back({static_cast<Index>(rng.next_below(kColumns)),
                       {rng.next_float(), rng.next_float(), 3 * rng.next_float()}});
  std::vector<Rgb> expected(kRows, Rgb(0.25f)), column(kRows);
  for (const matrix::ScaledColumn& s : columns) {
    matrix.column(s.column, column, Part::value);
    for (std::size_t i = 0; i < kRows; ++i) expected[i] += s.scale * column[i];
  }
  std::vector<Rgb> sums(kRows, Rgb(0.25f));
  matrix.accumulate(columns, sums, {});
  EXPECT_EQ(sums, expected);
  // In two batches: the same bits.
  std::vector<Rgb> halves(kRows, Rgb(0.25f));
  matrix.accumulate(std::span(columns).first(111), halves, {});
  matrix.accumulate(std::span(columns).subspan(111), halves, {});
  EXPECT_EQ(halves, expected);
}

TEST(SceneMatrixThreads, AnyNumberOfThreadsGivesTheSameBits) {
  scenedesc::SceneDesc desc = room_with_blocks();
  add_all_bsdfs(desc);
  const world::World world = build_world(desc);
  const RandomEnds ends = random_ends(world, 9000, 5000, 11);
  std::vector<matrix::ScaledColumn> columns;
  for (Index j = 0; j < 5000; j += 100) columns.push_back({j, Rgb(1.5f)});
  std::vector<std::vector<Rgb>> sums, rows;
  std::vector<matrix::Cost> costs;
  for (const int threads : {1, 2, 4}) {
    with_threads(threads, [&] {
      const SceneMatrix matrix(world, ends.receivers, ends.lights, {});
      sums.emplace_back(9000);
      costs.push_back(matrix.accumulate(columns, sums.back(), {}));
      rows.emplace_back(5000);
      costs.back() += matrix.row(17, rows.back(), Part::value);
    });
  }
  for (std::size_t k = 1; k < 3; ++k) {
    EXPECT_EQ(sums[k], sums[0]);
    EXPECT_EQ(rows[k], rows[0]);
    EXPECT_EQ(costs[k], costs[0]);
  }
}

TEST(SceneMatrixThreads, StopsWhenAsked) {
  const world::World world = build_world(room_with_blocks());
  RandomEnds some;
  add_receiver(some.receivers, {0, 0, 0}, {0, 0, 1}, {0, 0, 1}, Rgb(1));
  add_light(some.lights, LightKind::omni, {0, 0, 1}, {}, Rgb(1));
  const SceneMatrix matrix(world, some.receivers, some.lights, {});
  std::vector<Rgb> sums(1);
  const matrix::ScaledColumn column{0, Rgb(1)};
  const std::atomic<bool> stop{true};
  double last = -1;
  Sinks sinks;
  sinks.progress = [&](const char*, double fraction) { last = fraction; };
  matrix.accumulate(std::span(&column, 1), sums, sinks);
  EXPECT_EQ(last, 1);
  sinks.cancel = &stop;
  EXPECT_THROW(matrix.accumulate(std::span(&column, 1), sums, sinks), Cancelled);
}

TEST(SceneMatrixFeatures, TellPlainNumbers) {
  const world::World world = build_world(room_with_blocks());
  RandomEnds ends;
  add_receiver(ends.receivers, {0, 0, 0}, {0, 0, 1}, {0, 0, 1}, Rgb(1));
  add_light(ends.lights, LightKind::omni, {0, 0, 1}, {}, Rgb(1));
  add_light(ends.lights, LightKind::oriented, {0, 0, 1}, {0, 0, -1}, Rgb(1));
  add_light(ends.lights, LightKind::surface, {0, 0, 1}, {0, 0, -1}, Rgb(2));
  ends.lights.emitter = {4, 5, 6};
  SceneMatrixSettings settings;
  const SceneMatrix whole(world, ends.receivers, ends.lights, settings);
  settings.group_by_emitter = true;
  const SceneMatrix split(world, ends.receivers, ends.lights, settings);
  EXPECT_EQ(whole.row_features().pixel[0], ends.receivers.film[0]);
  const auto features = split.column_features();
  EXPECT_NEAR(features.power[0], 4 * kPi, 1e-5);
  EXPECT_NEAR(features.power[1], kPi, 1e-5);
  EXPECT_NEAR(features.power[2], 2 * 0.5f, 1e-6);  // Φ times the albedo
  EXPECT_EQ(features.group[2], 6);
  EXPECT_EQ(whole.column_features().group[2], 0);
  EXPECT_EQ(features.indirect[1], 0);
  EXPECT_EQ(features.indirect[2], 1);
}

}  // namespace
}  // namespace lumirank::transport::testing
