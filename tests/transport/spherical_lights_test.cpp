// Spherical lights: the estimate of equation 5 of the 2009 paper against quadrature, and its rules.
#include <gtest/gtest.h>

#include <cmath>

#include "base/parallel.h"
#include "base/warp.h"
#include "matrix_fixture.h"
#include "transport/lights/light_areas.h"
#include "transport/lights/light_reach.h"
#include "transport/lights/sphere_lights.h"
#include "transport/pairs/sphere_integral.h"

namespace lumirank::transport::testing {
namespace {

using matrix::Index;
using matrix::Part;

// ∫ over the cone by n directions of a lattice, all equally dense; of the red channel.
double quadrature(const SphereEnds& ends, int n) {
  const SphereCone cone = sphere_cone(ends.n, ends.w, ends.radius);
  const Frame frame = Frame::from_normal(cone.axis);
  double sum = 0;
  for (int k = 0; k < n; ++k) {
    const double u = (k + 0.5) / n, v = k * 0.6180339887498949;
    const double below = u * cone.solid_angle / (2 * kPi), r = std::sqrt(below * (2 - below));
    const double phi = 2 * kPi * (v - std::floor(v));
    const Vec3f l = frame.to_world({static_cast<float>(r * std::cos(phi)),
                                    static_cast<float>(r * std::sin(phi)), static_cast<float>(1 - below)});
    sum += static_cast<double>(sphere_integrand(ends, l).r);
  }
  return sum / n * cone.solid_angle;
}

class SphericalPairs : public ::testing::TestWithParam<SphereRules> {
 protected:
  static constexpr std::size_t kRows = 110, kColumns = 110;
  static void SetUpTestSuite() {
    scenedesc::SceneDesc desc = room_with_blocks();
    add_all_bsdfs(desc);
    world_ = std::make_unique<world::World>(build_world(desc));
    ends_ = std::make_unique<RandomEnds>(random_ends(*world_, kRows, kColumns, 22));
    VirtualLights& lights = ends_->lights;
    // From a tenth of the room to more than it: receivers far away, close by and inside.
    for (std::size_t j = 0; j < kColumns; ++j) {
      const float radius[] = {0.1f, 0.5f, 2.5f};
      lights.radius.push_back(lights.kind[j] == LightKind::surface ? radius[j % 3] : 0);
      lights.hidden.push_back(0);
    }
  }
  static void TearDownTestSuite() { ends_.reset(), world_.reset(); }
  static SceneMatrix make(const SphereRules& rules, std::uint64_t seed = 1) {
    SceneMatrixSettings settings;
    settings.clamp = 0, settings.spheres = rules, settings.seed = seed;
    return SceneMatrix(*world_, ends_->receivers, ends_->lights, settings);
  }
  static std::unique_ptr<world::World> world_;
  static std::unique_ptr<RandomEnds> ends_;
};
std::unique_ptr<world::World> SphericalPairs::world_;
std::unique_ptr<RandomEnds> SphericalPairs::ends_;

// The mean of an entry over 300 seeds against a quadrature, pair by pair. With some 300 pairs, six standard
// errors leave a chance below 1 in 10⁶ for normal means; skewed ones get the room up to about 1 in 1000.
TEST_P(SphericalPairs, EntriesAreOnAverageTheIntegral) {
  constexpr int kSeeds = 300, kPoints = 40000;
  const Receivers& receivers = ends_->receivers;
  const VirtualLights& lights = ends_->lights;
  std::vector<Index> is, js;
  {
    const SceneMatrix matrix = make(GetParam());
    std::vector<Rgb> row(kColumns);
    for (Index i = 0; i < kRows; ++i) {
      matrix.row(i, row, Part::unoccluded);
      for (Index j = i % 3; j < kColumns; j += 3)
        if (lights.kind[j] == LightKind::surface && !is_black(row[j])) is.push_back(i), js.push_back(j);
    }
  }
  ASSERT_GT(is.size(), 100u);
  std::vector<double> sum(is.size()), sum2(is.size());
  std::vector<Rgb> e(is.size());
  for (int seed = 0; seed < kSeeds; ++seed) {
    make(GetParam(), static_cast<std::uint64_t>(seed) + 1).entries(is, js, e, Part::unoccluded);
    for (std::size_t k = 0; k < e.size(); ++k) {
      const double x = static_cast<double>(e[k].r);
      sum[k] += x, sum2[k] += x * x;
    }
  }
  std::vector<double> truth(is.size()), error(is.size());
  parallel_for(is.size(), 1, [&](std::size_t k, std::size_t) {
    const Index i = is[k], j = js[k];
    const scatter::Closure x = receivers.closure_at(i), y = lights.closure_at(j);
    const Vec3f w = lights.position[j] - receivers.position[i];
    const float r = lights.radius[j];
    const float side = dot(receivers.normal[i], receivers.wo[i]) < 0 ? -1.0f : 1.0f;
    SphereEnds ends{
        x, y, receivers.wo[i], lights.incoming[j],
        // A fiber has no hemisphere but that of the light.
        x.is_fiber() ? normalize(w) : receivers.normal[i] * side, lights.ng[j], w, r,
        GetParam().indicator == SphereRules::Indicator::disc && length_squared(w) < square(kDiscReach * r)};
    const double per = static_cast<double>(lights.power[j].r) / (kPi * static_cast<double>(r) * r);
    const double fine = quadrature(ends, kPoints), coarse = quadrature(ends, kPoints / 4);
    truth[k] = fine * per;
    error[k] = std::abs(fine - coarse) * per;
  });
  int inside = 0, far = 0;
  for (std::size_t k = 0; k < is.size(); ++k) {
    const Vec3f w = lights.position[js[k]] - receivers.position[is[k]];
    inside += length_squared(w) < square(lights.radius[js[k]]);
    far += length_squared(w) > square(kDiscReach * lights.radius[js[k]]);
    const double average = sum[k] / kSeeds;
    const double deviation = std::sqrt(std::max(0.0, sum2[k] / kSeeds - average * average) / kSeeds);
    EXPECT_NEAR(average, truth[k], 6 * deviation + error[k] + 2e-3 * truth[k])
        << "row " << is[k] << ", column " << js[k] << ", " << length(w) / lights.radius[js[k]] << " radii";
  }
  EXPECT_GT(inside, 10);
  EXPECT_GT(far, 10);
}

TEST_P(SphericalPairs, AnEntryHasOneValueHoweverItIsAskedFor) {
  const SceneMatrix matrix = make(GetParam());
  std::vector<Rgb> rows(kRows * kColumns), column(kRows), block(kRows * kColumns);
  for (const Part part : {Part::value, Part::unoccluded}) {
    for (Index i = 0; i < kRows; ++i) matrix.row(i, std::span(rows).subspan(i * kColumns, kColumns), part);
    for (Index j = 0; j < kColumns; ++j) {
      matrix.column(j, column, part);
      for (Index i = 0; i < kRows; ++i) ASSERT_EQ(column[i], rows[i * kColumns + j]) << i << ' ' << j;
    }
    std::vector<Index> is(kRows), js(kColumns);
    for (Index k = 0; k < kRows; ++k) is[k] = k;
    for (Index k = 0; k < kColumns; ++k) js[k] = kColumns - 1 - k;
    matrix.block(is, js, block, part);
    for (Index i = 0; i < kRows; ++i)
      for (Index k = 0; k < kColumns; ++k)
        ASSERT_EQ(block[i * kColumns + k], rows[i * kColumns + js[k]]) << i << ' ' << js[k];
  }
}

INSTANTIATE_TEST_SUITE_P(
    Rules, SphericalPairs,
    ::testing::Values(
        SphereRules{},
        SphereRules{SphereRules::Indicator::cosine, SphereRules::Strategies::all,
                    SphereRules::Samples::overlap},
        SphereRules{SphereRules::Indicator::cosine, SphereRules::Strategies::all, SphereRules::Samples::cone},
        SphereRules{SphereRules::Indicator::disc, SphereRules::Strategies::cone, SphereRules::Samples::cone}),
    [](const ::testing::TestParamInfo<SphereRules>& rules) {
      return std::string(rules.param.indicator == SphereRules::Indicator::disc ? "Disc" : "Cosine") +
             (rules.param.strategies == SphereRules::Strategies::all ? "All" : "Cone") +
             (rules.param.samples == SphereRules::Samples::overlap ? "ByOverlap" : "ByCone");
    });

// Whatever the ends, an entry is what it was, or nothing where the receiver is too close.
TEST_P(SphericalPairs, NothingArrivesFromWithinTheReachThatIsTraced) {
  SphereRules rules = GetParam();
  const SceneMatrix whole = make(rules);
  rules.beyond = 2;
  const SceneMatrix far = make(rules);
  std::vector<Rgb> a(kRows), b(kRows);
  std::size_t left_out = 0, kept = 0;
  for (Index j = 0; j < kColumns; ++j) {
    whole.column(j, a, Part::unoccluded), far.column(j, b, Part::unoccluded);
    for (std::size_t i = 0; i < kRows; ++i) {
      const float reach = 2 * ends_->lights.radius[j];
      const float d = length(ends_->lights.position[j] - ends_->receivers.position[i]);
      if (std::abs(d - reach) < 1e-5f) continue;
      if (is_black(a[i])) continue;
      EXPECT_EQ(b[i], d < reach ? Rgb(0) : a[i]) << i << ", " << j;
      ++(d < reach ? left_out : kept);
    }
  }
  EXPECT_GT(left_out, 100u);
  EXPECT_GT(kept, 100u);
}

struct Facing {
  world::World world = build_world(empty_space());
  RandomEnds ends;
  Rgb entry(const SphereRules& rules = {}) const {
    SceneMatrixSettings settings;
    settings.clamp = 0, settings.spheres = rules;
    const SceneMatrix matrix(world, ends.receivers, ends.lights, settings);
    Rgb e;
    matrix.row(0, std::span(&e, 1), Part::unoccluded);
    return e;
  }
};

// On the axis, ∫ cos²θ dl over a cone of half angle asin(r/d) is 2π/3·(1 - cos³): with albedos of 1 and ½,
// the entry is Φ/(πr²)·1/π·½/π of it.
TEST(SphericalLights, MattPairsFarApartAreTheClosedForm) {
  Facing facing;
  const float d = 5, r = 1;
  add_receiver(facing.ends.receivers, {0, 0, 0}, {0, 0, 1}, {0, 0, 1}, Rgb(1));
  add_light(facing.ends.lights, LightKind::surface, {0, 0, d}, {0, 0, -1}, Rgb(3));
  facing.ends.lights.radius = {r}, facing.ends.lights.hidden = {0};
  const double cosine = std::sqrt(1 - 1.0 / (d * d));
  const double expected = 3 / kPi * (1 / kPi) * (0.5 / kPi) * 2 * kPi / 3 * (1 - std::pow(cosine, 3));
  EXPECT_NEAR(facing.entry().r, expected, 2e-6 * expected);
}

// Right in front of a disc of radiosity Φ/(πr²)·½ a parallel matt receiver at distance h has the form factor
// r²/(r² + h²); the cosine sees the same from everywhere inside of the sphere: ½ - … of ∫ cos² = 2π/3.
TEST(SphericalLights, CloseByTheDiscIsADisc) {
  Facing facing;
  const float r = 1, h = 0.5f;
  add_receiver(facing.ends.receivers, {0, 0, 0}, {0, 0, 1}, {0, 0, 1}, Rgb(1));
  add_light(facing.ends.lights, LightKind::surface, {0, 0, h}, {0, 0, -1}, Rgb(1));
  facing.ends.lights.radius = {r}, facing.ends.lights.hidden = {0};
  const double per = 1 / (kPi * r * r) * (1 / kPi) * (0.5 / kPi);
  const double disc = per * kPi * r * r / (r * r + h * h), sphere = per * 2 * kPi / 3;
  // One estimate is of about 32 directions in the hemisphere, stratified.
  EXPECT_NEAR(facing.entry().r, disc, 0.1 * disc);
  SphereRules rules;
  rules.indicator = SphereRules::Indicator::cosine;
  EXPECT_NEAR(facing.entry(rules).r, sphere, 0.1 * sphere);
}

// A light on a wall, in the very corner with the receiver's floor: half of its disc is below the floor.
TEST(SphericalLights, WhatTheFloorHidesIsNotLost) {
  Facing facing;
  add_receiver(facing.ends.receivers, {0, 0, 0}, {0, 0, 1}, {0, 0, 1}, Rgb(1));
  add_light(facing.ends.lights, LightKind::surface, {1.5f, 0, 1e-4f}, {-1, 0, 0}, Rgb(1));
  facing.ends.lights.radius = {1}, facing.ends.lights.hidden = {0};
  const float whole = facing.entry().r;
  ASSERT_GT(whole, 0);
  facing.ends.lights.hidden = {0.5f};
  EXPECT_NEAR(facing.entry().r, 2 * whole, 1e-3 * whole);
  // Half a radius up, the part of the circle below the floor is acos(½)/π - √3/4/π.
  facing.ends.lights.position[0].z = 0.5f;
  const float higher = facing.entry().r;
  facing.ends.lights.hidden = {0};
  EXPECT_NEAR(higher, facing.entry().r / (1 - (std::acos(0.5) - std::sqrt(3.0) / 4) / kPi), 1e-3 * higher);
  // What the light has hidden elsewhere is no matter of this floor.
  facing.ends.lights.position[0].z = 1.2f;
  const float free = facing.entry().r;
  facing.ends.lights.hidden = {0.5f};
  EXPECT_EQ(facing.entry().r, free);
}

TEST(SphericalLights, StrategiesAgreeOnNarrowLobes) {
  scatter::Closure x, y;
  scatter::Lobe lobe;
  lobe.kind = scatter::LobeKind::microfacet_reflect;
  lobe.color = Rgb(0.8f), lobe.alpha_u = 0.06f, lobe.alpha_v = 0.1f;
  x.frame = Frame::from_normal({0, 0, 1}), x.ng = {0, 0, 1};
  x.add(lobe);
  lobe.alpha_u = lobe.alpha_v = 0.12f;
  y.frame = Frame::from_normal({-1, 0, 0}), y.ng = {-1, 0, 0};
  y.add(lobe);
  const Vec3f l = normalize(Vec3f{1, 0.1f, 1});  // what the eye sees by reflection
  const SphereEnds ends{x,         y,          {-l.x, -l.y, l.z}, normalize(Vec3f{-1.0f, 0.2f, 1.1f}),
                        {0, 0, 1}, {-1, 0, 0}, {1, 0, 1},         0.4f,
                        true};
  const double truth = quadrature(ends, 400000);
  ASSERT_GT(truth, 0);
  for (const SphereSamples samples :
       {SphereSamples{6, 0, 0}, SphereSamples{1, 3, 0}, SphereSamples{1, 0, 3}, SphereSamples{2, 2, 2}}) {
    constexpr int kTrials = 20000;
    double sum = 0, sum2 = 0;
    for (int t = 0; t < kTrials; ++t) {
      const double v = static_cast<double>(sphere_integral(ends, samples, static_cast<std::uint64_t>(t)).r);
      sum += v, sum2 += v * v;
    }
    const double average = sum / kTrials;
    // 3.9 standard errors: 99.99 % for each of the four.
    EXPECT_NEAR(average, truth,
                3.9 * std::sqrt((sum2 / kTrials - average * average) / kTrials) + 1e-3 * truth)
        << samples.cone << samples.receiver << samples.light;
  }
}

// [-1,1]³, seen from inside, and lights 0.1 apart on its floor; the 60th is in the middle.
world::World cube() {
  scenedesc::SceneDesc desc;
  add_shape(desc, scenedesc::CubeDesc{}, Transform{});
  return build_world(desc);
}
VirtualLights grid_on_the_floor() {
  VirtualLights lights;
  for (int a = -5; a <= 5; ++a)
    for (int b = -5; b <= 5; ++b)
      add_light(lights, LightKind::surface, {0.1f * static_cast<float>(a), 0.1f * static_cast<float>(b), -1},
                {0, 0, 1}, Rgb(1));
  return lights;
}

TEST(SphericalLights, RadiiFollowTheTenthNeighborAndCornersHideAQuarter) {
  const world::World world = cube();
  VirtualLights lights = grid_on_the_floor();
  add_light(lights, LightKind::omni, {0, 0, 0}, {}, Rgb(1));
  EXPECT_EQ(make_spherical(lights, world, {2}), 2);
  const std::size_t middle = 60;
  // Of the neighbors of a grid's point, four are 1 away, four √2, four 2: the tenth is at 2.
  EXPECT_NEAR(lights.radius[middle], 2 * 0.2f, 1e-5);
  EXPECT_EQ(lights.hidden[middle], 0);
  EXPECT_EQ(lights.radius.back(), 0);
  // Against a wall: half of the disc; eight sectors of a circle that the wall cuts at its center know it
  // exactly.
  VirtualLights corner;
  for (int k = 0; k < 12; ++k)
    add_light(corner, LightKind::surface, {-0.9999f, 0.05f * static_cast<float>(k), -1}, {0, 0, 1}, Rgb(1));
  make_spherical(corner, world, {1});
  EXPECT_NEAR(corner.hidden[6], 0.5f, 0.01f);
}

TEST(SphericalLights, AReachIsSoManyRadii) {
  const world::World world = cube();
  VirtualLights lights = grid_on_the_floor();
  add_light(lights, LightKind::omni, {0, 0, 0.1f}, {}, Rgb(1));  // has no radius
  make_spherical(lights, world, {2});
  const LightReach reach(lights, world, 2, 3);
  // Seen from a grid's point, itself among them: one at 0, four at 1, four at √2, the tenth at 2.
  EXPECT_NEAR(reach.at({0, 0, -1}), 3 * 2 * 0.2f, 1e-5);
  // From the middle of a cell: four at √½, eight at √2.5.
  EXPECT_NEAR(reach.at({0.05f, 0.05f, -1}), 3 * 2 * 0.1f * std::sqrt(2.5f), 1e-5);
  EXPECT_EQ(LightReach(VirtualLights(), world, 2, 3).at({0, 0, 0}), 0);
}

// A reach holds as many lights as were asked for, by the density of the eleven by eleven in their square.
TEST(SphericalLights, AReachOfPointsHoldsSoManyOfThem) {
  VirtualLights lights = grid_on_the_floor();
  lights.half.resize(lights.size()), lights.path.resize(lights.size()), lights.area.resize(lights.size());
  for (std::size_t j = 0; j < lights.size(); ++j) {
    lights.half[j] = static_cast<std::uint8_t>(1 + j % 2);
    lights.path[j] = static_cast<std::uint32_t>(j);
  }
  measure_areas(lights, 2);
  const float max_reach = give_reach(lights, 5);
  const float dense = std::sqrt(5 * 0.01f / kPi);
  EXPECT_NEAR(lights.reach[60], dense, 0.15f * dense);
  const LightReach reach(lights, 5, max_reach);
  EXPECT_NEAR(reach.at({0.02f, 0.03f, -1}), dense, 0.15f * dense);
  // Far from them all it is no more than twice what nine of ten lights have.
  EXPECT_EQ(reach.at({0, 0, 1}), max_reach);
  EXPECT_LT(max_reach, 4 * dense);
  VirtualLights none;
  EXPECT_EQ(give_reach(none, 5), 0);
  EXPECT_EQ(LightReach(none, 5, 0).at({0, 0, 0}), 0);
}

// Radii fall with the sixth root of the number of lights: the tenth neighbor's distance with the square root.
TEST(SphericalLights, AutomaticRadiiBalanceBlurAndNoise) {
  EXPECT_EQ(automatic_radius_scale(1), 1);
  EXPECT_NEAR(automatic_radius_scale(3760), 2, 1e-5);
  for (const double n : {1e4, 1e5})
    EXPECT_NEAR(automatic_radius_scale(static_cast<std::size_t>(64 * n)) / std::sqrt(64.0),
                automatic_radius_scale(static_cast<std::size_t>(n)) / 2.0, 1e-3);
}

TEST(SphericalLights, AnyNumberOfThreadsGivesTheSameBits) {
  scenedesc::SceneDesc desc = room_with_blocks();
  add_all_bsdfs(desc);
  const world::World world = build_world(desc);
  RandomEnds ends = random_ends(world, 3000, 2000, 5);
  std::vector<std::vector<Rgb>> sums;
  std::vector<std::vector<float>> hidden;
  std::vector<matrix::ScaledColumn> columns;
  for (Index j = 0; j < 2000; j += 50) columns.push_back({j, Rgb(1.5f), 0.5f});
  for (const int threads : {1, 2, 4})
    with_threads(threads, [&] {
      make_spherical(ends.lights, world, {2});
      hidden.push_back(ends.lights.hidden);
      const SceneMatrix matrix(world, ends.receivers, ends.lights, {});
      sums.emplace_back(3000);
      matrix.accumulate(columns, sums.back(), {});
    });
  for (std::size_t k = 1; k < 3; ++k) {
    EXPECT_EQ(sums[k], sums[0]);
    EXPECT_EQ(hidden[k], hidden[0]);
  }
}

}  // namespace
}  // namespace lumirank::transport::testing
