#include "denoise/shrinkage.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/random.h"

namespace lumirank::denoise {
namespace {

using image::Image;

constexpr int kWidth = 96, kHeight = 64;

struct Halves {
  Image mean, difference;
};

// Two halves of a picture with Gaussian noise, `deviation` of the mean's.
Halves with_noise(const Image& truth, float deviation, std::uint64_t seed) {
  Halves halves{truth, Image(truth.width, truth.height)};
  Rng random(seed, Stage::projection, 7);
  for (std::size_t p = 0; p < truth.pixels.size(); ++p)
    for (int c = 0; c < 3; ++c) {
      const float size = deviation * std::sqrt(2.0f);
      const auto a = size * static_cast<float>(random.next_gaussian()),
                 b = size * static_cast<float>(random.next_gaussian());
      halves.mean.pixels[p][c] += 0.5f * (a + b);
      halves.difference.pixels[p][c] = a - b;
    }
  return halves;
}

// A step from dark to bright in the middle.
Image step() {
  Image image(kWidth, kHeight, Rgb(0.2f));
  for (int y = 0; y < kHeight; ++y)
    for (int x = kWidth / 2; x < kWidth; ++x) image.at(x, y) = Rgb(1);
  return image;
}

// What a denoiser makes of it that does not see the edge.
Image ramp() {
  Image image = step();
  for (int y = 0; y < kHeight; ++y)
    for (int x = -4; x < 4; ++x)
      image.at(kWidth / 2 + x, y) = Rgb(0.2f + 0.8f * (static_cast<float>(x) + 4.5f) / 8);
  return image;
}

double rms(const Image& a, const Image& b) {
  double sum = 0;
  for (std::size_t p = 0; p < a.pixels.size(); ++p)
    for (int c = 0; c < 3; ++c) sum += std::pow(static_cast<double>(a.pixels[p][c] - b.pixels[p][c]), 2);
  return std::sqrt(sum / static_cast<double>(3 * a.pixels.size()));
}

TEST(Shrinkage, NoiseStaysAway) {
  const Image truth = step();
  for (std::uint64_t seed : {1, 2, 3}) {
    const Halves noisy = with_noise(truth, 0.1f, seed);
    const Shrunk shrunk = shrink(noisy.mean, truth, noisy.difference);
    EXPECT_LT(shrunk.kept, 1e-4);
    EXPECT_LT(rms(shrunk.picture, truth), 1e-3);
  }
}

TEST(Shrinkage, AnEdgeThatWasLostComesBack) {
  const Image truth = step(), denoised = ramp();
  const Halves noisy = with_noise(truth, 0.02f, 1);
  const Shrunk shrunk = shrink(noisy.mean, denoised, noisy.difference);
  EXPECT_LT(rms(shrunk.picture, truth), 0.15 * rms(denoised, truth));
  EXPECT_LT(rms(shrunk.picture, truth), 0.6 * rms(noisy.mean, truth)) << "and no noise with it elsewhere";
  EXPECT_GT(shrunk.kept, 0.05);
  EXPECT_LT(shrunk.kept, 0.3);
}

// A glint that the denoiser took comes back, and none of the noise around it.
TEST(Shrinkage, AGlintBringsNoNoiseBack) {
  const Image flat(kWidth, kHeight, Rgb(0.5f));
  constexpr int kAtX = kWidth / 2, kAtY = kHeight / 2;
  Image truth = flat;
  truth.at(kAtX, kAtY) = Rgb(200);
  const Halves noisy = with_noise(truth, 0.05f, 1);
  const Shrunk shrunk = shrink(noisy.mean, flat, noisy.difference);
  EXPECT_NEAR(shrunk.picture.at(kAtX, kAtY).r, 200, 1);
  double before = 0, left = 0;
  for (int y = kAtY - 6; y <= kAtY + 6; ++y)
    for (int x = kAtX - 6; x <= kAtX + 6; ++x) {
      if (std::abs(x - kAtX) < 3 && std::abs(y - kAtY) < 3) continue;
      before += std::abs(static_cast<double>(noisy.mean.at(x, y).r - 0.5f));
      left += std::abs(static_cast<double>(shrunk.picture.at(x, y).r - 0.5f));
    }
  EXPECT_LT(left, 0.15 * before);
}

// One pixel in 150 of one half holds nearly all light, as of a lamp that few paths find: most windows are
// dark in both halves, which is no sign that the picture is.
TEST(Shrinkage, RareLightLeavesNoHoles) {
  const Image truth(kWidth, kHeight, Rgb(1));
  Image mean(kWidth, kHeight, Rgb(0.05f)), difference(kWidth, kHeight);
  Rng random(5, Stage::projection, 7);
  for (std::size_t p = 0; p < mean.pixels.size(); ++p)
    for (const float sign : {1.0f, -1.0f})
      if (random.next_below(150) == 0) mean.pixels[p] += Rgb(71), difference.pixels[p] += Rgb(142 * sign);
  const Shrunk shrunk = shrink(mean, truth, difference);
  float darkest = 1;
  for (const Rgb& p : shrunk.picture.pixels) darkest = std::min(darkest, p.r);
  EXPECT_GT(darkest, 0.8f);
}

// The longer a render takes, the less a denoiser's mistake counts: in the end it is gone.
TEST(Shrinkage, ConvergesToTheTruth) {
  const Image truth = step(), denoised = ramp();
  double before = rms(denoised, truth);
  for (float deviation : {0.1f, 0.03f, 0.01f, 0.001f}) {
    const Halves noisy = with_noise(truth, deviation, 5);
    const double now = rms(shrink(noisy.mean, denoised, noisy.difference).picture, truth);
    EXPECT_LT(now, before) << deviation;
    before = now;
  }
  EXPECT_LT(before, 2e-3);
}

// One path in many that found a lamp is in one half alone.
TEST(Shrinkage, FirefliesStayAway) {
  const Image truth = step();
  Halves noisy = with_noise(truth, 0.001f, 9);
  for (int x = 10; x < kWidth; x += 20) {
    noisy.mean.at(x, 30) += Rgb(50);
    noisy.difference.at(x, 30) += Rgb(100);
  }
  const Shrunk shrunk = shrink(noisy.mean, truth, noisy.difference);
  for (int x = 10; x < kWidth; x += 20)
    EXPECT_NEAR(shrunk.picture.at(x, 30).g, truth.at(x, 30).g, 0.01f) << x;
}

TEST(Shrinkage, OtherBrightnessIsTheSamePicture) {
  const Image denoised = ramp();
  Halves noisy = with_noise(step(), 0.05f, 3);
  const Shrunk once = shrink(noisy.mean, denoised, noisy.difference);
  constexpr float kScale = 4096;
  Image bright = denoised;
  for (Image* image : {&noisy.mean, &noisy.difference, &bright})
    for (Rgb& c : image->pixels) c *= kScale;
  const Shrunk again = shrink(noisy.mean, bright, noisy.difference);
  for (std::size_t p = 0; p < denoised.pixels.size(); ++p)
    EXPECT_NEAR(again.picture.pixels[p].r, kScale * once.picture.pixels[p].r, 1e-4f * kScale);
}

TEST(Shrinkage, BlackPicturesAndOddSizes) {
  const Image black(5, 3);
  EXPECT_EQ(shrink(black, black, black).kept, 0);
  EXPECT_EQ(shrink({}, {}, {}).picture.pixels.size(), 0u);
  EXPECT_THROW(shrink(black, Image(4, 3), black), InternalError);
}

}  // namespace
}  // namespace lumirank::denoise
