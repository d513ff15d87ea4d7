#include "pipeline/paths_beside.h"

#include <gtest/gtest.h>

#include <cmath>

namespace lumirank::pipeline {
namespace {

constexpr int kSide = 64;

NoisyPicture even_noise(float light, float noise) {
  return {image::Image(kSide, kSide, Rgb(light)), image::Image(kSide, kSide, Rgb(noise))};
}

// Noise falls with the root of the seconds, so ten times the seconds for the same noise are √10 times as bad.
TEST(PathsBeside, WhatIsComparedIsNoiseForTheSameSeconds) {
  const NoisyPicture noise = even_noise(1, 0.2f), twice = even_noise(1, 0.4f);
  const double even = passes_over_paths(noise, 1, noise, 1, false);
  EXPECT_GT(even, 1) << "that of passes looks worse";
  EXPECT_NEAR(passes_over_paths(twice, 1, noise, 1, false), 2 * even, 1e-6);
  EXPECT_NEAR(passes_over_paths(noise, 1, twice, 1, false), even / 2, 1e-6);
  EXPECT_NEAR(passes_over_paths(noise, 10, noise, 1, false), std::sqrt(10) * even, 1e-6);
  EXPECT_NEAR(passes_over_paths(noise, 1, noise, 10, false), even / std::sqrt(10), 1e-6);
}

TEST(PathsBeside, PassesCountByOneOverVariance) {
  EXPECT_DOUBLE_EQ(share_of_passes(1, 3, 3), 0.5);
  EXPECT_DOUBLE_EQ(share_of_passes(2, 1, 1), 0.2);
  EXPECT_EQ(share_of_passes(2, 0, 1), 0);
  // No other share has less variance.
  const double ratio = 1.3, passes = 2, paths = 5, best = share_of_passes(ratio, passes, paths);
  const auto variance = [&](double share) {
    return share * share * ratio * ratio / passes + (1 - share) * (1 - share) / paths;
  };
  EXPECT_LT(variance(best), variance(best + 0.01));
  EXPECT_LT(variance(best), variance(best - 0.01));
}

// A thousandth of the picture is a window, and the noise of all else is what is seen.
TEST(PathsBeside, NoiseInTheDarkCounts) {
  NoisyPicture a = even_noise(1, 0.1f), b = a;
  for (NoisyPicture* picture : {&a, &b})
    for (int x = 0; x < 4; ++x) picture->picture.at(x, 0) = Rgb(1000);
  for (int x = 0; x < 4; ++x) a.difference.at(x, 0) = Rgb(400);
  const double even = passes_over_paths(b, 1, b, 1, false);
  EXPECT_LT(passes_over_paths(a, 1, b, 1, false), 1.4 * even) << "five times by the light that is off";
  for (Rgb& p : b.difference.pixels) p = 2 * p;
  EXPECT_GT(passes_over_paths(b, 1, a, 1, false), 1.5 * even);
}

// What few paths have found is bright where it was found: its own brightness must not hide the noise.
TEST(PathsBeside, RareBrightPixelsAreNoise) {
  NoisyPicture rare{image::Image(kSide, kSide, Rgb(0.5f)), image::Image(kSide, kSide)};
  for (int y = 0; y < kSide; y += 8)
    for (int x = 0; x < kSide; x += 8) rare.picture.at(x, y) = Rgb(32.5f), rare.difference.at(x, y) = Rgb(64);
  const NoisyPicture spread = even_noise(1, 1);  // as much in the mean
  EXPECT_NEAR(passes_over_paths(rare, 1, spread, 1, false) / passes_over_paths(spread, 1, spread, 1, false),
              1, 0.1);
}

// A pixel that a leaf and the sky behind it share: what one sends more, the other sends less.
TEST(PathsBeside, EmissionIsTheirOwnWhereNoiseCancels) {
  const image::Image picture(8, 8, Rgb(1));
  image::Image sent(8, 8), all(8, 8);
  for (int x = 0; x < 8; ++x) sent.at(x, 3) = Rgb(x % 2 ? 0.5f : -0.5f), all.at(x, 3) = sent.at(x, 3) * 0.2f;
  EXPECT_LT(own_emission_over_apart(picture, all, sent, 16, 64), 0.3);
}

// At a lamp's edge all noise is its own, and film samples there are more than paths; once these are more,
// they have less.
TEST(PathsBeside, EmissionOfLampsIsByFilmSamples) {
  image::Image picture(8, 8, Rgb(0.1f)), sent(8, 8), all(8, 8);
  for (int x = 0; x < 8; ++x) picture.at(x, 3) = Rgb(10), all.at(x, 3) = Rgb(x % 2 ? 16.0f : -16.0f);
  EXPECT_NEAR(own_emission_over_apart(picture, all, sent, 8, 32), std::sqrt((16 + 48 + 32 / 8) / 32.0), 1e-3);
  EXPECT_LT(own_emission_over_apart(picture, all, sent, 8, 1024), 1);
}

TEST(PathsBeside, WithoutEmissionBothAreAlike) {
  const image::Image picture(8, 8, Rgb(1)), noise(8, 8, Rgb(0.1f)), black(8, 8);
  EXPECT_NEAR(own_emission_over_apart(picture, noise, noise, 8, 32), 1, 1e-6);
  EXPECT_EQ(own_emission_over_apart(black, black, black, 8, 32), 1);
}

// A ball of glass that paths leave black, in a sixteenth of the picture.
TEST(MissedLight, IsWhatPassesShowAndPathsDoNot) {
  const NoisyPicture passes = even_noise(1, 0.2f);
  NoisyPicture paths = even_noise(1, 0.3f);
  EXPECT_EQ(missed_light(passes, paths), 0);
  for (int y = 16; y < 32; ++y)
    for (int x = 8; x < 24; ++x) paths.picture.at(x, y) = Rgb(0), paths.difference.at(x, y) = Rgb(0);
  EXPECT_NEAR(missed_light(passes, paths), (1 - 0.2) / 1.1 / 16, 1e-6) << "beyond two deviations";
  EXPECT_NEAR(missed_light({passes.picture, {}}, paths), 1 / 1.1 / 16, 1e-6);
  EXPECT_EQ(missed_light(paths, passes), 0) << "what paths alone have found, as caustics";
}

// Rough glass that passes leave dark, in 64 of 4,096 pixels: it counts more than their noise.
TEST(PathsBeside, PassesThatMissLightAreWorse) {
  NoisyPicture passes = even_noise(1, 0.02f);
  const NoisyPicture paths = even_noise(1, 0.02f);
  const double even = passes_over_paths(passes, 1, paths, 1, false);
  for (int y = 8; y < 16; ++y)
    for (int x = 8; x < 16; ++x) passes.picture.at(x, y) = Rgb(0.4f);
  EXPECT_GT(passes_over_paths(passes, 1, paths, 1, false), 2 * even);
  EXPECT_NEAR(passes_over_paths(paths, 1, passes, 1, false), even, 1e-6)
      << "paths that miss are told otherwise";
}

// What few paths have found is noise, however little the others have.
TEST(MissedLight, NoiseIsNoLightThatIsMissed) {
  const NoisyPicture passes = even_noise(1, 0.05f);
  NoisyPicture paths{image::Image(kSide, kSide, Rgb(0.2f)), image::Image(kSide, kSide)};
  for (int y = 0; y < kSide; y += 4)
    for (int x = 0; x < kSide; x += 4) {
      const float found = (x + y) % 8 ? 1.0f : 19;  // a fifth of the light in every second one is lacking
      paths.picture.at(x, y) = Rgb(found), paths.difference.at(x, y) = Rgb(2 * found);
    }
  EXPECT_LT(missed_light(passes, paths), 0.03);
}

TEST(PathsThatFit, MayEndALittleLate) {
  EXPECT_EQ(paths_that_fit(5, 1, 100), 5);
  EXPECT_EQ(paths_that_fit(4.75, 1, 100), 5)
      << "by less than a third of a path, and a hundredth of the budget";
  EXPECT_EQ(paths_that_fit(4.65, 1, 100), 4);
  EXPECT_EQ(paths_that_fit(4.85, 1, 10), 4);
  EXPECT_EQ(paths_that_fit(-3, 1, 10), 0);
  EXPECT_GT(paths_that_fit(10, 1e-9, 10), 1000000);
}

}  // namespace
}  // namespace lumirank::pipeline
