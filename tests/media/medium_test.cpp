// Grids, the cells that a ray passes, and flights, against quadrature.
#include <gtest/gtest.h>

#include <numeric>

#include "base/random.h"
#include "media/tracking.h"
#include "support/statistics.h"

namespace lumirank::media {
namespace {

using test::expect_mean;
using test::RunningMean;

std::vector<float> some_values(std::size_t count, std::uint64_t seed) {
  Rng rng(seed, Stage::test);
  std::vector<float> values(count);
  for (float& v : values) {
    const float u = rng.next_float();
    v = u < 0.3f ? 0.0f : 2 * u;  // with holes
  }
  return values;
}

std::shared_ptr<const Grid> some_grid(std::array<int, 3> size, int channels, Grid::Sampling sampling) {
  const auto count = static_cast<std::size_t>(size[0] * size[1] * size[2] * channels);
  return std::make_shared<const Grid>(size, channels, some_values(count, count), sampling);
}

// Colored smoke in the box [-1, 1]³ turned and stretched.
Medium smoke(Grid::Sampling sampling = Grid::Sampling::centers, int channels = 3) {
  const Transform box =
      Transform::rotate(1, 2, 3, 40) * Transform::scale(2, 1, 1.5) * Transform::translate(-0.5, -0.5, -0.5);
  const Transform to_unit = *box.inverse();
  Field extinction{{1.5f, 1, 3}, some_grid({13, 9, 17}, channels, sampling), to_unit, true};
  Field albedo{{0.9f, 0.8f, 0.5f}};
  return {Medium::Form::extinction_and_albedo, extinction, albedo, Field{}, PhaseFunction{}};
}

struct Line {
  Vec3f origin, direction;
  float length;
};

std::vector<Line> some_lines() {
  std::vector<Line> lines{
      {{-3, 0.1f, 0.05f}, {1, 0, 0}, 6}, {{0, 0, 0}, {0, 0, -1}, 0.4f}, {{0, 5, 0}, {0, 0, 1}, 9}};
  Rng rng(3, Stage::test);
  for (int k = 0; k < 4; ++k) {
    const Vec3f from{rng.next_float() * 2 - 1, rng.next_float() * 2 - 1, -2},
        to{rng.next_float() * 2 - 1, 0.3f, 2};
    lines.push_back({from, normalize(to - from), 3});
  }
  return lines;
}

// ∫ extinction along the line.
Rgb optical_thickness(const Medium& medium, const Line& line) {
  constexpr int kSteps = 20000;
  double sum[3] = {};
  for (int k = 0; k < kSteps; ++k) {
    const float t = line.length * (static_cast<float>(k) + 0.5f) / kSteps;
    const Rgb extinction = medium.at(line.origin + line.direction * t).extinction;
    for (int c = 0; c < 3; ++c) sum[c] += static_cast<double>(extinction[c]);
  }
  const double step = static_cast<double>(line.length) / kSteps;
  return {static_cast<float>(sum[0] * step), static_cast<float>(sum[1] * step),
          static_cast<float>(sum[2] * step)};
}

TEST(Grid, ValuesAreWhereTheSamplingSays) {
  const std::vector<float> values{1, 2, 4, 8};
  const auto at = [&](Grid::Sampling sampling, float u) {
    return Grid({4, 1, 1}, 1, values, sampling).at({u, 0.5f, 0.5f}).r;
  };
  EXPECT_FLOAT_EQ(at(Grid::Sampling::corners, 0), 1);
  EXPECT_FLOAT_EQ(at(Grid::Sampling::corners, 1), 8);
  EXPECT_FLOAT_EQ(at(Grid::Sampling::corners, 1.0f / 3), 2);
  EXPECT_FLOAT_EQ(at(Grid::Sampling::corners, 0.5f), 3);
  EXPECT_FLOAT_EQ(at(Grid::Sampling::centers, 0.125f), 1);
  EXPECT_FLOAT_EQ(at(Grid::Sampling::centers, 0.05f), 1);
  EXPECT_FLOAT_EQ(at(Grid::Sampling::centers, 0.25f), 1.5f);
  EXPECT_FLOAT_EQ(at(Grid::Sampling::centers, 1), 8);
  EXPECT_FLOAT_EQ(Grid({4, 1, 1}, 1, values, Grid::Sampling::fading_cells).at({0.25f, 0.5f, 0.5f}).r, 1.5f);
  EXPECT_FLOAT_EQ(Grid({4, 1, 1}, 1, values, Grid::Sampling::fading_cells).at({0, 0.5f, 0.5f}).r, 0.5f);
  const Grid nearest({4, 1, 1}, 1, values, Grid::Sampling::centers, true);
  EXPECT_FLOAT_EQ(nearest.at({0.24f, 0.5f, 0.5f}).r, 1);
  EXPECT_FLOAT_EQ(nearest.at({0.26f, 0.5f, 0.5f}).r, 2);
}

TEST(Grid, ChannelsAndAxesAreInOrder) {
  std::vector<float> values(2 * 3 * 4 * 3);
  std::iota(values.begin(), values.end(), 0.0f);
  const Grid grid({2, 3, 4}, 3, values, Grid::Sampling::corners);
  EXPECT_EQ(grid.at({1, 0, 0}), (Rgb{3, 4, 5}));
  EXPECT_EQ(grid.at({0, 0.5f, 0}), (Rgb{6, 7, 8}));
  EXPECT_EQ(grid.at({0, 0, 1}), (Rgb{54, 55, 56}));
}

TEST(Grid, RangesHoldWhatIsInThem) {
  for (const auto sampling :
       {Grid::Sampling::corners, Grid::Sampling::centers, Grid::Sampling::fading_cells}) {
    const auto grid = some_grid({7, 5, 9}, 3, sampling);
    Rng rng(5, Stage::test);
    for (int k = 0; k < 200; ++k) {
      const Vec3f a{rng.next_float(), rng.next_float(), rng.next_float()};
      const Vec3f b{rng.next_float(), rng.next_float(), rng.next_float()};
      const Vec3f lo = min(a, b), hi = max(a, b);
      const Grid::Range range = grid->range(lo, hi);
      for (int n = 0; n < 50; ++n) {
        const Rgb value = grid->at({lerp(lo.x, hi.x, rng.next_float()), lerp(lo.y, hi.y, rng.next_float()),
                                    lerp(lo.z, hi.z, rng.next_float())});
        for (int c = 0; c < 3; ++c) {
          EXPECT_LE(range.least[c], value[c] + 1e-5f);
          EXPECT_GE(range.most[c], value[c] - 1e-5f);
        }
      }
    }
  }
}

TEST(Medium, PiecesOfAWalkCoverTheLineAndBoundTheExtinction) {
  for (const auto sampling :
       {Grid::Sampling::corners, Grid::Sampling::centers, Grid::Sampling::fading_cells}) {
    const Medium medium = smoke(sampling);
    for (const Line& line : some_lines()) {
      std::vector<Medium::Walk::Piece> pieces;
      Medium::Walk walk(medium, line.origin, line.direction, line.length);
      for (Medium::Walk::Piece piece; walk.next(piece);) pieces.push_back(piece);
      for (std::size_t k = 1; k < pieces.size(); ++k) EXPECT_EQ(pieces[k].begin, pieces[k - 1].end);
      for (int n = 0; n < 2000; ++n) {
        const float t = line.length * (static_cast<float>(n) + 0.5f) / 2000;
        const Rgb extinction = medium.at(line.origin + line.direction * t).extinction;
        const auto in = std::find_if(pieces.begin(), pieces.end(), [&](const auto& piece) {
          return t > piece.begin + 1e-5f && t < piece.end - 1e-5f;
        });
        const bool at_a_face = std::any_of(pieces.begin(), pieces.end(), [&](const auto& piece) {
          return std::abs(t - piece.begin) <= 1e-5f || std::abs(t - piece.end) <= 1e-5f;
        });
        if (in == pieces.end()) {
          EXPECT_TRUE(at_a_face || is_black(extinction)) << t;
          continue;
        }
        for (int c = 0; c < 3; ++c) {
          EXPECT_LE(in->extinction.least[c], extinction[c] + 1e-5f);
          EXPECT_GE(in->extinction.most[c], extinction[c] - 1e-5f);
        }
      }
    }
  }
}

TEST(Transmittance, AgreesWithQuadrature) {
  for (const int channels : {1, 3}) {
    const Medium medium = smoke(Grid::Sampling::centers, channels);
    std::uint64_t key = 0;
    for (const Line& line : some_lines()) {
      const Rgb expected = passed(optical_thickness(medium, line), 1);
      RunningMean means[3];
      Rng rng(11, Stage::test, ++key);
      for (int n = 0; n < 20000; ++n) {
        const Rgb t =
            transmittance(medium, line.origin, line.direction, line.length, [&] { return rng.next_float(); });
        for (int c = 0; c < 3; ++c) means[c].add(static_cast<double>(t[c]));
      }
      for (int c = 0; c < 3; ++c) expect_mean(means[c], static_cast<double>(expected[c]), 2e-4);
    }
  }
}

// Beside a dense wall, in cells whose bounds reach from nothing to 100 mean free paths in each.
TEST(Transmittance, BesideDenseSmokeIsNotSpentInNoise) {
  constexpr int kSide = 24;
  std::vector<float> values(kSide * kSide * kSide);
  for (std::size_t k = 0; k < values.size(); ++k) values[k] = k / kSide % kSide % 4 == 3 ? 3000.0f : 0.01f;
  const Field extinction{Rgb(1),
                         std::make_shared<const Grid>(std::array<int, 3>{kSide, kSide, kSide}, 1, values,
                                                      Grid::Sampling::centers),
                         Transform{}, true};
  const Medium medium{Medium::Form::extinction_and_albedo, extinction, Field{Rgb(0.9f)}, Field{},
                      PhaseFunction{}};
  Rng rng(1, Stage::test);
  RunningMean left;
  for (int k = 0; k < 2000; ++k)
    left.add(static_cast<double>(transmittance(medium, {-1, 1.5f / kSide, 0.5f}, {1, 0, 0}, 3, [&rng] {
                                   return rng.next_float();
                                 }).r));
  expect_mean(left, std::exp(-0.01));
  EXPECT_LT(left.standard_error(), 0.02);
}

// Smoke files end in numbers near the least that there are, and random numbers may be 0.
TEST(Flight, HardlyAnySmokeIsNone) {
  std::vector<float> values(64, 1e-42f);
  for (std::size_t k = 0; k < values.size(); k += 3) values[k] = 3e-41f;
  const Field extinction{
      Rgb(1), std::make_shared<const Grid>(std::array<int, 3>{4, 4, 4}, 1, values, Grid::Sampling::centers),
      Transform{}, true};
  const Medium medium{Medium::Form::extinction_and_albedo, extinction, Field{Rgb(0.9f)}, Field{},
                      PhaseFunction{}};
  const auto zero = [] { return 0.0f; };
  const Vec3f from{-1, 0.4f, 0.3f}, along{1, 0, 0};
  EXPECT_EQ(transmittance(medium, from, along, 3, zero), Rgb(1));
  ChannelThroughput path;
  EXPECT_TRUE(fly(medium, from, along, 3, 1, zero, path, [](float, const Coefficients&, Rgb) {
    ADD_FAILURE() << "nothing to collide with";
    return true;
  }));
  EXPECT_EQ(path.weight(), Rgb(1));
}

TEST(Transmittance, IsExactInAHomogeneousMedium) {
  const Medium medium(Medium::Form::absorption_and_scattering, Field{{0.5f, 0, 2}}, Field{{0.25f, 0, 1}},
                      Field{}, {});
  const auto never = [] {
    ADD_FAILURE() << "nothing needs to be drawn";
    return 0.5f;
  };
  const Rgb t = transmittance(medium, {1, 2, 3}, {0, 1, 0}, 2, never);
  EXPECT_FLOAT_EQ(t.r, std::exp(-1.5f));
  EXPECT_FLOAT_EQ(t.g, 1);
  EXPECT_FLOAT_EQ(t.b, std::exp(-6.0f));
  EXPECT_EQ(transmittance(medium, {1, 2, 3}, {0, 1, 0}, kInfinity, never), (Rgb{0, 1, 0}));
}

// A path's real collisions on a line: whatever the hero, the sum of its weights is what scatters before the
// end, and what arrives there is the transmittance.
void expect_flights(const Medium& medium, const Line& line, std::uint64_t key) {
  RunningMean arrived[3], scattered[3];
  Rng rng(17, Stage::test, key);
  const auto random = [&] { return rng.next_float(); };
  for (int n = 0; n < 60000; ++n) {
    const int hero = static_cast<int>(rng.next_below(3));
    ChannelThroughput path;
    Rgb collision{0};
    const bool through = fly(medium, line.origin, line.direction, line.length, hero, random, path,
                             [&](float, const Coefficients& at, Rgb bound) {
                               const Rgb null = bound - at.extinction;
                               if (rng.next_float() * bound[hero] < at.extinction[hero]) {
                                 path.event(at.scattering, at.extinction, hero);
                                 collision = path.weight();
                                 return false;
                               }
                               path.event(null, null, hero);
                               return true;
                             });
    const Rgb end = through ? path.weight() : Rgb{0};
    for (int c = 0; c < 3; ++c) {
      arrived[c].add(static_cast<double>(end[c]));
      scattered[c].add(static_cast<double>(collision[c]));
    }
  }
  // The albedo is the same everywhere, so what scatters is the albedo of what does not arrive.
  const Rgb albedo =
      medium.at({}).extinction.r > 0 ? medium.at({}).scattering / medium.at({}).extinction : Rgb{0};
  const Rgb through = passed(optical_thickness(medium, line), 1);
  for (int c = 0; c < 3; ++c) {
    expect_mean(arrived[c], static_cast<double>(through[c]), 3e-4);
    expect_mean(scattered[c], static_cast<double>(albedo[c] * (1 - through[c])), 3e-4);
  }
}

TEST(Flight, CollisionsAgreeWithQuadrature) {
  const Transform to_unit = *(Transform::scale(2, 2, 2) * Transform::translate(-0.5, -0.5, -0.5)).inverse();
  Field extinction{{1.5f, 1, 3}, some_grid({12, 12, 12}, 1, Grid::Sampling::centers), to_unit, true};
  const Medium medium(Medium::Form::extinction_and_albedo, extinction, Field{{0.9f, 0.8f, 0.5f}}, Field{},
                      {});
  ASSERT_GT(medium.at({}).extinction.r, 0);
  std::uint64_t key = 0;
  for (const Line& line : some_lines()) expect_flights(medium, line, ++key);
}

TEST(Flight, CollisionsOfAHomogeneousMediumAgreeWithTheClosedForm) {
  const Medium medium(Medium::Form::extinction_and_albedo, Field{{0.2f, 1, 3}}, Field{{0.9f, 0.8f, 0.5f}},
                      Field{}, {});
  std::uint64_t key = 100;
  for (const Line& line : some_lines()) expect_flights(medium, line, ++key);
}

TEST(Flight, EndsInAnEndlessMedium) {
  const Medium medium(Medium::Form::extinction_and_albedo, Field{{0.2f, 1, 3}}, Field{Rgb(1)}, Field{}, {});
  Rng rng(1, Stage::test);
  for (int n = 0; n < 100; ++n) {
    ChannelThroughput path;
    bool collided = false;
    const bool through = fly(
        medium, {}, {1, 0, 0}, kInfinity, n % 3, [&] { return rng.next_float(); }, path,
        [&](float, const Coefficients&, Rgb) {
          collided = true;
          return false;
        });
    EXPECT_FALSE(through);
    EXPECT_TRUE(collided);
  }
}

}  // namespace
}  // namespace lumirank::media
