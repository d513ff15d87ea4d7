#include "pipeline/smaller_film.h"

#include <gtest/gtest.h>

namespace lumirank::pipeline {
namespace {

View film_of(int width, int height) {
  View view;
  view.width = view.sensor.film.width = width, view.height = view.sensor.film.height = height;
  return view;
}

TEST(TrialDivisor, IsAQuarterUnlessThatIsLarge) {
  EXPECT_EQ(trial_divisor(film_of(1, 1)), 4);
  EXPECT_EQ(trial_divisor(film_of(640, 360)), 4);
  EXPECT_EQ(trial_divisor(film_of(960, 540)), 4);
  EXPECT_EQ(trial_divisor(film_of(961, 541)), 5);
  EXPECT_EQ(trial_divisor(film_of(1920, 1080)), 8);
  EXPECT_EQ(trial_divisor(film_of(1080, 1920)), 8);
  EXPECT_EQ(trial_divisor(film_of(3840, 2160)), 16);
}

TEST(SmallerFilm, HasAPixelAtLeastAndKeepsItsWindow) {
  View window = film_of(640, 360);
  window.crop_x = 320, window.crop_y = 180, window.width = 100, window.height = 60;
  EXPECT_FALSE(is_whole_film(window));
  const View small = smaller(window, 4);
  EXPECT_EQ(small.sensor.film.width, 160);
  EXPECT_EQ(small.sensor.film.height, 90);
  EXPECT_EQ(small.crop_x, 80);
  EXPECT_EQ(small.crop_y, 45);
  EXPECT_EQ(small.width, 25);
  EXPECT_EQ(small.height, 15);
  const View least = smaller(film_of(5, 3), 16);
  EXPECT_TRUE(is_whole_film(least));
  EXPECT_EQ(least.width, 1);
  EXPECT_EQ(least.height, 1);
}

TEST(SmallerFilm, PathsWithLightPathsBesideThemAreWorthMore) {
  View view;
  view.width = 640, view.height = 360;
  EXPECT_NEAR(paths_worth_a_pixel(view), 3.84, 1e-9);
  EXPECT_NEAR(paths_worth_a_pixel(view, 2), 1.92, 1e-9);
  view.width = 320, view.height = 180;
  EXPECT_EQ(paths_worth_a_pixel(view, 2), 1);
}

TEST(SmallerFilm, EnlargesLinearlyBetweenCenters) {
  Picture p;
  p.width = 2, p.height = 1;
  p.planes.push_back({"", {0, 1, 2, 4, 5, 6}});
  const Picture larger = enlarged(p, 4, 2);
  ASSERT_EQ(larger.planes[0].rgb.size(), 4u * 2 * 3);
  // Centers at 1/4, 3/4, 5/4, 7/4 of the smaller one's pixels, whose own are at 1/2 and 3/2.
  const float expected[] = {0, 1, 3, 4};
  for (std::size_t y = 0; y < 2; ++y)
    for (std::size_t x = 0; x < 4; ++x) EXPECT_FLOAT_EQ(larger.planes[0].rgb[3 * (y * 4 + x)], expected[x]);
}

}  // namespace
}  // namespace lumirank::pipeline
