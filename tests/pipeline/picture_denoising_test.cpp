#include "pipeline/picture_denoising.h"

#include <gtest/gtest.h>

namespace lumirank::pipeline {
namespace {

// What denoising is expected to take, over the budget, of a film whose noisy features in one orientation take
// so much of it.
double part_of_budget(double once, int divisor = 1) {
  RenderSettings settings;
  settings.time = 10;
  world::View view;
  view.width = 64, view.height = 48;
  methods::TimedChoices choices;
  PictureDenoising denoising(settings, view, choices, {}, once * settings.time / (64 * 48));
  denoising.make_smaller(divisor);
  return denoising.seconds() / settings.time;
}

class PictureDenoised : public testing::Test {
 protected:
  void SetUp() override {
    if (denoise::Denoiser::find().absent) GTEST_SKIP() << denoise::Denoiser::find().trouble;
  }
};

// Clean features take 2.4 times as long, and each orientation as long as the first.
TEST_F(PictureDenoised, AsWellAsABudgetPays) {
  EXPECT_NEAR(part_of_budget(0.006), 0.006 * 2.4 * 4, 1e-9);
  EXPECT_NEAR(part_of_budget(0.007), 0.007 * 2.4 * 2, 1e-9);
  EXPECT_NEAR(part_of_budget(0.02), 0.02 * 2.4 * 2, 1e-9);
  EXPECT_NEAR(part_of_budget(0.04), 0.04 * 2.4, 1e-9);
  EXPECT_NEAR(part_of_budget(0.06), 0.06, 1e-9);
  EXPECT_NEAR(part_of_budget(3), 3, 1e-9);
}

// The film that is rendered decides, and the whole one what enlarging takes.
TEST_F(PictureDenoised, ASmallerFilmBetter) {
  const double enlarging = 0.25 * 0.06;
  EXPECT_NEAR(part_of_budget(0.06, 2), 0.06 / 4 * 2.4 * 2 + enlarging, 1e-9);
  EXPECT_NEAR(part_of_budget(0.06, 4), 0.06 / 16 * 2.4 * 4 + enlarging, 1e-9);
}

}  // namespace
}  // namespace lumirank::pipeline
