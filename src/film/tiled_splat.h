// Pictures made of film samples that nobody keeps: as splat(), from samples that come tile by tile.
#pragma once

#include <cstddef>
#include <vector>

#include "base/rgb.h"
#include "base/vec.h"
#include "film/filter.h"
#include "image/image.h"

namespace lumirank::film {

// The film is cut into tiles whose places do not depend on the window, each with sums of its own, so that
// threads can work on different tiles and neither they nor the window change a bit: the order of sums is that
// of tiles, then of the samples of a tile.
class TiledSplat {
 public:
  // The window of the film, its upper left pixel at `corner`.
  TiledSplat(int width, int height, const Filter& filter, Vec2i corner);

  struct Box {
    int x0, y0, x1, y1;  // x1, y1: one past the last
  };
  std::size_t tiles() const { return static_cast<std::size_t>(across_) * static_cast<std::size_t>(down_); }
  // The pixels of the film (negative ones too, where there is no film) that tile t takes samples of.
  Box pixels(std::size_t t) const;
  // One sample of these pixels. One thread for a tile at a time.
  void add(std::size_t t, Vec2f film, Rgb value);
  // Every pixel the weighted mean of its samples; what happens where negative lobes cancel is as in splat().
  image::Image image() const;

 private:
  struct Pixel {
    double r = 0, g = 0, b = 0, weight = 0, magnitude = 0;
  };
  struct Tile {
    Box pixels;  // that it adds to: its own and as far as the filter reaches, within the window
    std::vector<Pixel> sums;
    std::vector<Pixel> magnitudes;  // sums with the weights' magnitudes, of filters that go negative
  };
  Tile& sums_of(std::size_t t);
  void resolve_row(int y, Rgb* out) const;

  int width_, height_;
  Filter filter_;
  Vec2i corner_;
  int reach_;
  bool goes_negative_;
  int first_x_, first_y_, across_, down_;  // of tiles
  std::vector<Tile> sums_;
};

}  // namespace lumirank::film
