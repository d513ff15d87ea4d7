#include "film/tiled_splat.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"

namespace lumirank::film {
namespace {

constexpr int kTilePixels = 32;
constexpr double kCancelledShare = 0.05;  // as in splat()

int tile_of(int pixel) {
  return pixel >= 0 ? pixel / kTilePixels : -((-pixel + kTilePixels - 1) / kTilePixels);
}

}  // namespace

TiledSplat::TiledSplat(int width, int height, const Filter& filter, Vec2i corner)
    : width_(width),
      height_(height),
      filter_(filter),
      corner_(corner),
      reach_(filter.reach()),
      goes_negative_(filter.kind == FilterKind::mitchell || filter.kind == FilterKind::catmullrom ||
                     filter.kind == FilterKind::lanczos),
      first_x_(tile_of(corner.x - reach_)),
      first_y_(tile_of(corner.y - reach_)),
      across_(tile_of(corner.x + width - 1 + reach_) - first_x_ + 1),
      down_(tile_of(corner.y + height - 1 + reach_) - first_y_ + 1),
      sums_(tiles()) {}

TiledSplat::Box TiledSplat::pixels(std::size_t t) const {
  const int x = (first_x_ + static_cast<int>(t) % across_) * kTilePixels,
            y = (first_y_ + static_cast<int>(t) / across_) * kTilePixels;
  return {std::max(x, corner_.x - reach_), std::max(y, corner_.y - reach_),
          std::min(x + kTilePixels, corner_.x + width_ + reach_),
          std::min(y + kTilePixels, corner_.y + height_ + reach_)};
}

TiledSplat::Tile& TiledSplat::sums_of(std::size_t t) {
  Tile& tile = sums_[t];
  if (!tile.sums.empty()) return tile;
  const Box own = pixels(t);
  tile.pixels = {std::max(own.x0 - reach_, corner_.x), std::max(own.y0 - reach_, corner_.y),
                 std::min(own.x1 + reach_, corner_.x + width_),
                 std::min(own.y1 + reach_, corner_.y + height_)};
  const auto count = static_cast<std::size_t>(std::max(0, tile.pixels.x1 - tile.pixels.x0)) *
                     static_cast<std::size_t>(std::max(0, tile.pixels.y1 - tile.pixels.y0));
  tile.sums.resize(count);
  if (goes_negative_) tile.magnitudes.resize(count);
  return tile;
}

void TiledSplat::add(std::size_t t, Vec2f film, Rgb value) {
  Tile& tile = sums_of(t);
  const Box& box = tile.pixels;
  const int center_x = static_cast<int>(std::floor(film.x)), center_y = static_cast<int>(std::floor(film.y));
  for (int y = std::max(box.y0, center_y - reach_); y <= std::min(box.y1 - 1, center_y + reach_); ++y) {
    const float wy = filter_.eval(film.y - (static_cast<float>(y) + 0.5f));
    if (wy == 0) continue;
    const std::size_t row = static_cast<std::size_t>(y - box.y0) * static_cast<std::size_t>(box.x1 - box.x0);
    for (int x = std::max(box.x0, center_x - reach_); x <= std::min(box.x1 - 1, center_x + reach_); ++x) {
      const double w = static_cast<double>(filter_.eval(film.x - (static_cast<float>(x) + 0.5f))) * wy;
      if (w == 0) continue;
      const auto add_to = [&](Pixel& p, double weight) {
        p.r += weight * value.r, p.g += weight * value.g, p.b += weight * value.b;
        p.weight += weight, p.magnitude += std::abs(weight);
      };
      const std::size_t at = row + static_cast<std::size_t>(x - box.x0);
      add_to(tile.sums[at], w);
      if (goes_negative_) add_to(tile.magnitudes[at], std::abs(w));
    }
  }
}

void TiledSplat::resolve_row(int y, Rgb* out) const {
  const auto columns = static_cast<std::size_t>(width_);
  std::vector<Pixel> sums(columns), magnitudes(columns);
  const auto gather = [&](const Tile& tile, const std::vector<Pixel>& from, std::vector<Pixel>& to) {
    if (from.empty() || y < tile.pixels.y0 || y >= tile.pixels.y1) return;
    const Pixel* p = &from[static_cast<std::size_t>(y - tile.pixels.y0) *
                           static_cast<std::size_t>(tile.pixels.x1 - tile.pixels.x0)];
    for (int x = tile.pixels.x0; x < tile.pixels.x1; ++x, ++p) {
      Pixel& q = to[static_cast<std::size_t>(x - corner_.x)];
      q.r += p->r, q.g += p->g, q.b += p->b, q.weight += p->weight, q.magnitude += p->magnitude;
    }
  };
  for (const Tile& tile : sums_) {
    gather(tile, tile.sums, sums);
    gather(tile, tile.magnitudes, magnitudes);
  }
  for (std::size_t x = 0; x < columns; ++x) {
    const bool cancelled = goes_negative_ && std::abs(sums[x].weight) < kCancelledShare * sums[x].magnitude;
    const Pixel& p = cancelled ? magnitudes[x] : sums[x];
    if (p.magnitude > 0)
      out[x] = {static_cast<float>(p.r / p.weight), static_cast<float>(p.g / p.weight),
                static_cast<float>(p.b / p.weight)};
  }
}

image::Image TiledSplat::image() const {
  image::Image image(width_, height_);
  parallel_for(static_cast<std::size_t>(height_), 4, [&](std::size_t begin, std::size_t end) {
    for (std::size_t y = begin; y < end; ++y)
      resolve_row(corner_.y + static_cast<int>(y), &image.pixels[y * static_cast<std::size_t>(width_)]);
  });
  return image;
}

}  // namespace lumirank::film
