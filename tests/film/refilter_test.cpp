#include "film/refilter.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace lumirank::film {
namespace {

// r²/3, r²/6, σ² as good as uncut, B/3 by eq. 8 of Mitchell and Netravali 1988, and so 0 for Catmull-Rom.
TEST(Refilter, VariancesOfFilters) {
  Filter filter = Filter::standard(FilterKind::box);
  EXPECT_NEAR(variance(filter), 1.0 / 12, 1e-6);
  filter.radius = 2;
  EXPECT_NEAR(variance(filter), 4.0 / 3, 1e-5);
  EXPECT_NEAR(variance(Filter::standard(FilterKind::tent)), 1.0 / 6, 1e-6);
  filter = Filter::standard(FilterKind::gaussian);
  filter.radius = 4;
  EXPECT_NEAR(variance(filter), 0.25, 1e-4);
  EXPECT_NEAR(variance(Filter::standard(FilterKind::mitchell)), 1.0 / 9, 1e-4);
  EXPECT_NEAR(variance(Filter::standard(FilterKind::catmullrom)), 0, 1e-4);
}

image::Image with_light_at(int x, int y) {
  image::Image image(21, 21);
  image.at(x, y) = {1, 2, 3};
  return image;
}

TEST(Refilter, APixelsLightIsSpreadByWhatTheBoxLacks) {
  Filter wide = Filter::standard(FilterKind::tent);
  for (const float radius : {1.0f, 2.0f, 3.0f}) {
    wide.radius = radius;
    const image::Image image = refiltered(with_light_at(10, 10), wide);
    Rgb sum{0};
    double x2 = 0, y2 = 0, xy = 0;
    for (int y = 0; y < 21; ++y)
      for (int x = 0; x < 21; ++x) {
        sum += image.at(x, y);
        const auto red = static_cast<double>(image.at(x, y).r);
        EXPECT_GE(red, 0);
        x2 += red * (x - 10) * (x - 10), y2 += red * (y - 10) * (y - 10), xy += red * (x - 10) * (y - 10);
      }
    EXPECT_NEAR(sum.r, 1, 1e-5f);
    EXPECT_NEAR(sum.b, 3, 1e-5f);
    const double lacking = static_cast<double>(radius * radius) / 6 - 1.0 / 12;
    EXPECT_NEAR(x2, lacking, 1e-4) << radius;
    EXPECT_NEAR(y2, lacking, 1e-4) << radius;
    EXPECT_NEAR(xy, 0, 1e-6);
  }
}

TEST(Refilter, AnEvenPictureStaysEvenUpToItsBorders) {
  image::Image even(5, 3);
  for (Rgb& pixel : even.pixels) pixel = {2, 4, 8};
  for (const Rgb& pixel : refiltered(even, Filter::standard(FilterKind::gaussian)).pixels) {
    EXPECT_NEAR(pixel.r, 2, 1e-5f);
    EXPECT_NEAR(pixel.b, 8, 1e-5f);
  }
}

TEST(Refilter, WhatIsNoWiderThanTheBoxLeavesThePictureAlone) {
  const image::Image image = with_light_at(3, 4);
  for (const FilterKind kind : {FilterKind::box, FilterKind::catmullrom, FilterKind::lanczos})
    EXPECT_EQ(refiltered(image, Filter::standard(kind)).pixels, image.pixels) << static_cast<int>(kind);
}

// The light of a pixel centered `at` pixels beyond the edge of something that shines.
double light_beyond_edge(const Filter& filter, double at) {
  constexpr int kSteps = 2000;
  double light = 0, all = 0;
  for (int k = 0; k < kSteps; ++k) {
    const double x = (2 * (k + 0.5) / kSteps - 1) * static_cast<double>(filter.radius);
    const auto weight = static_cast<double>(filter.eval(static_cast<float>(x)));
    all += weight, light += at + x > 0 ? weight : 0;
  }
  return light / all;
}

// Edges anywhere in a pixel: squares of what is off beside the filter's own picture, over those of the box.
TEST(Refilter, EdgesLookMoreAsByTheFilterItself) {
  const struct {
    FilterKind kind;
    double most;
  } cases[] = {{FilterKind::gaussian, 0.2}, {FilterKind::tent, 0.45}, {FilterKind::mitchell, 0.8}};
  for (const auto& [kind, most] : cases) {
    const Filter filter = Filter::standard(kind);
    double off = 0, off_of_box = 0;
    for (double edge = 10; edge < 11; edge += 0.1) {
      image::Image of_box(21, 1);
      for (int x = 0; x < 21; ++x)
        of_box.at(x, 0) = Rgb(static_cast<float>(std::clamp(x + 1 - edge, 0.0, 1.0)));
      const image::Image shown = refiltered(of_box, filter);
      for (int x = 0; x < 21; ++x) {
        const double wanted = light_beyond_edge(filter, x + 0.5 - edge);
        off += std::pow(static_cast<double>(shown.at(x, 0).r) - wanted, 2);
        off_of_box += std::pow(static_cast<double>(of_box.at(x, 0).r) - wanted, 2);
      }
    }
    EXPECT_LT(off, most * off_of_box) << static_cast<int>(kind);
  }
}

}  // namespace
}  // namespace lumirank::film
