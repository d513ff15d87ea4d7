// The order in which film samples are traced and kept, and where in its pixel each one lies.
#pragma once

#include <cstdint>
#include <vector>

#include "base/vec.h"

namespace lumirank::transport {

inline constexpr int kTile = 4;  // pixels

// Tiles of 4×4 pixels along a Morton curve; pixels within a tile along one too. Tiles at the right and lower
// border may be cut off. A film sample's index is (rank of its pixel) · spp + its number within the pixel.
struct FilmOrder {
  struct Tile {
    int x, y;                   // upper left pixel
    std::uint32_t first_pixel;  // rank of its first pixel
  };
  std::vector<Tile> tiles;
  int width = 0, height = 0;

  FilmOrder(int width, int height);
  // The pixels of a tile, in order.
  std::vector<Vec2i> pixels(const Tile& tile) const;
};

// Of a place in a pixel's unit square on the whole film: pixel + place, below pixel + 1 whatever the
// rounding.
Vec2f on_pixel(Vec2i pixel, Vec2f place);

// Where the samples of one pixel lie on the film and on the lens. Both are stratified (√spp × √spp if spp is
// a square, a × b with b ≤ 2a if it is such a product, else one sample in each of spp columns and spp rows),
// and a permutation keyed by the pixel pairs film strata with lens strata.
class PixelPattern {
 public:
  PixelPattern(int spp, std::uint64_t key);
  struct Place {
    Vec2f film, lens;  // in the unit square
  };
  // `jitter`: two points, uniform in the unit square.
  Place place(int sample, Vec2f film_jitter, Vec2f lens_jitter) const;

 private:
  Vec2f stratum(int index, const std::vector<int>& rows, Vec2f jitter) const;

  int spp_, across_ = 0;  // across_ 0: no grid fits
  std::vector<int> lens_order_, film_rows_, lens_rows_;
};

}  // namespace lumirank::transport
