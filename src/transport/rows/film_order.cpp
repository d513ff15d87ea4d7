#include "transport/rows/film_order.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "base/morton.h"
#include "base/random.h"

namespace lumirank::transport {
namespace {

std::vector<int> permutation(int n, std::uint64_t key) {
  std::vector<int> order(static_cast<std::size_t>(n));
  std::iota(order.begin(), order.end(), 0);
  for (std::size_t k = order.size(); k > 1; --k) std::swap(order[k - 1], order[(key = mix64(key)) % k]);
  return order;
}

// The most nearly square a × b = n with a ≤ b ≤ 2a; 0 if there is none.
int grid_side(int n) {
  for (int a = n; a >= 1; --a)
    if (a * a <= n && n % a == 0) return n / a <= 2 * a ? a : 0;
  return 0;
}

float inside(float u) { return std::min(u, 0x1.fffffep-1f); }

float within(int pixel, float u) {
  const auto p = static_cast<float>(pixel);
  return std::min(p + u, std::nextafter(p + 1, 0.0f));
}

}  // namespace

FilmOrder::FilmOrder(int width_, int height_) : width(width_), height(height_) {
  const int nx = (width + kTile - 1) / kTile, ny = (height + kTile - 1) / kTile;
  std::vector<std::pair<std::uint64_t, Tile>> coded;
  coded.reserve(static_cast<std::size_t>(nx) * static_cast<std::size_t>(ny));
  for (int y = 0; y < ny; ++y)
    for (int x = 0; x < nx; ++x)
      coded.push_back(
          {morton2(static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y)), {x * kTile, y * kTile, 0}});
  std::sort(coded.begin(), coded.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  std::uint32_t rank = 0;
  for (auto& [code, tile] : coded) {
    tile.first_pixel = rank;
    rank += static_cast<std::uint32_t>(std::min(kTile, width - tile.x) * std::min(kTile, height - tile.y));
    tiles.push_back(tile);
  }
}

std::vector<Vec2i> FilmOrder::pixels(const Tile& tile) const {
  std::vector<Vec2i> result;
  for (int code = 0; code < kTile * kTile; ++code) {
    // The Morton code's bits are y1 x1 y0 x0.
    const int x = tile.x + ((code & 1) | (code >> 1 & 2)), y = tile.y + ((code >> 1 & 1) | (code >> 2 & 2));
    if (x < width && y < height) result.push_back({x, y});
  }
  return result;
}

Vec2f on_pixel(Vec2i pixel, Vec2f place) { return {within(pixel.x, place.x), within(pixel.y, place.y)}; }

PixelPattern::PixelPattern(int spp, std::uint64_t key) : spp_(spp), across_(grid_side(spp)) {
  lens_order_ = permutation(spp, mix64(key ^ 1));
  if (across_ == 0) {
    film_rows_ = permutation(spp, mix64(key ^ 2));
    lens_rows_ = permutation(spp, mix64(key ^ 3));
  }
}

Vec2f PixelPattern::stratum(int index, const std::vector<int>& rows, Vec2f jitter) const {
  const int nx = across_ == 0 ? spp_ : spp_ / across_, ny = across_ == 0 ? spp_ : across_;
  const int x = index % nx, y = across_ == 0 ? rows[static_cast<std::size_t>(index)] : index / nx;
  return {inside((static_cast<float>(x) + jitter.x) / static_cast<float>(nx)),
          inside((static_cast<float>(y) + jitter.y) / static_cast<float>(ny))};
}

PixelPattern::Place PixelPattern::place(int sample, Vec2f film_jitter, Vec2f lens_jitter) const {
  return {stratum(sample, film_rows_, film_jitter),
          stratum(lens_order_[static_cast<std::size_t>(sample)], lens_rows_, lens_jitter)};
}

}  // namespace lumirank::transport
