#include "film/tiled_splat.h"

#include <gtest/gtest.h>

#include "base/random.h"

namespace lumirank::film {
namespace {

struct FilmSamples {
  std::vector<Vec2f> film;
  std::vector<Rgb> values;
};

// Some per pixel of a film of 70 × 50, row by row.
FilmSamples random_samples() {
  FilmSamples samples;
  for (int y = 0; y < 50; ++y)
    for (int x = 0; x < 70; ++x)
      for (std::uint64_t k = 0; k < 3; ++k) {
        Rng rng(1, Stage::test, static_cast<std::uint64_t>(100 * y + x), k);
        const Vec2f u = rng.next_2d();
        samples.film.push_back({static_cast<float>(x) + u.x, static_cast<float>(y) + u.y});
        samples.values.push_back({rng.next_float(), rng.next_float(), 2});
      }
  return samples;
}

image::Image tiled(const FilmSamples& samples, const Filter& filter, Vec2i corner, int width, int height) {
  TiledSplat splat(width, height, filter, corner);
  for (std::size_t t = 0; t < splat.tiles(); ++t) {
    const auto box = splat.pixels(t);
    for (std::size_t s = 0; s < samples.film.size(); ++s) {
      const int x = static_cast<int>(samples.film[s].x), y = static_cast<int>(samples.film[s].y);
      if (x >= box.x0 && x < box.x1 && y >= box.y0 && y < box.y1)
        splat.add(t, samples.film[s], samples.values[s]);
    }
  }
  return splat.image();
}

constexpr FilterKind kKinds[] = {FilterKind::box,      FilterKind::tent,       FilterKind::gaussian,
                                 FilterKind::mitchell, FilterKind::catmullrom, FilterKind::lanczos};

TEST(TiledSplat, IsTheSplatOfAllSamples) {
  const FilmSamples samples = random_samples();
  for (const FilterKind kind : kKinds) {
    const Filter filter = Filter::standard(kind);
    const image::Image whole = splat(70, 50, filter, samples.film, samples.values);
    const image::Image by_tiles = tiled(samples, filter, {0, 0}, 70, 50);
    for (std::size_t p = 0; p < whole.pixels.size(); ++p)
      for (int c = 0; c < 3; ++c)
        ASSERT_NEAR(by_tiles.pixels[p][c], whole.pixels[p][c], 2e-6f) << static_cast<int>(kind) << " " << p;
  }
}

TEST(TiledSplat, AWindowHasTheBitsOfTheWhole) {
  const FilmSamples samples = random_samples();
  for (const FilterKind kind : kKinds) {
    const Filter filter = Filter::standard(kind);
    const image::Image whole = tiled(samples, filter, {0, 0}, 70, 50);
    const image::Image window = tiled(samples, filter, {21, 13}, 20, 25);
    for (int y = 0; y < 25; ++y)
      for (int x = 0; x < 20; ++x)
        ASSERT_EQ(window.pixels[static_cast<std::size_t>(20 * y + x)],
                  whole.pixels[static_cast<std::size_t>(70 * (y + 13) + x + 21)]);
  }
}

}  // namespace
}  // namespace lumirank::film
