#include "film/filter_sampler.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/random.h"
#include "support/statistics.h"

namespace lumirank::film {
namespace {

// A place counts for a pixel as the normalized filter says, in the mean over the numbers that choose it.
TEST(FilterSampler, PixelsOfAPlaceAreDrawnByTheFilter) {
  for (const FilterKind kind : {FilterKind::box, FilterKind::tent, FilterKind::gaussian, FilterKind::mitchell,
                                FilterKind::catmullrom, FilterKind::lanczos}) {
    const Filter filter = Filter::standard(kind);
    const FilterSampler sampler(filter);
    double integral = 0;
    for (int k = 0; k < 4000; ++k)
      integral += filter.eval(filter.radius * (2 * (static_cast<float>(k) + 0.5f) / 4000 - 1));
    integral *= 2 * filter.radius / 4000;
    const Vec2f film{7.3f, 4.9f};
    for (const Vec2i pixel : {Vec2i{7, 4}, Vec2i{6, 4}, Vec2i{8, 5}}) {
      Rng rng(3, Stage::test);
      test::RunningMean mean;
      for (int k = 0; k < 20000; ++k) {
        const auto drawn = sampler.pixel(film, rng.next_2d());
        mean.add(drawn.at.x == pixel.x && drawn.at.y == pixel.y ? static_cast<double>(drawn.weight) : 0.0);
      }
      const float x = filter.eval(film.x - (static_cast<float>(pixel.x) + 0.5f));
      const float y = filter.eval(film.y - (static_cast<float>(pixel.y) + 0.5f));
      test::expect_mean(mean, static_cast<double>(x * y) / (integral * integral), 1e-3);
    }
  }
}

}  // namespace
}  // namespace lumirank::film
