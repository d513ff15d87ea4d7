#include <cmath>

#include "base/error.h"
#include "base/parallel.h"
#include "film/filter.h"

namespace lumirank::film {
namespace {

// Sample numbers grouped by the pixel row that they fall in, in their own order within a row. Group k holds
// row first + k; samples farther from the window than the filter reaches are left out.
struct Rows {
  int first = 0;
  std::vector<std::size_t> begin;
  std::vector<std::uint32_t> samples;
  int count() const { return static_cast<int>(begin.size()) - 1; }
};

Rows group_by_row(int top, int height, int reach, std::span<const Vec2f> positions) {
  Rows rows;
  rows.first = top - reach;
  const int count = height + 2 * reach;
  const auto row_of = [&](Vec2f p) {
    if (!std::isfinite(p.x) || !std::isfinite(p.y))
      throw InternalError("a receiver's position on the film is not finite");
    const float row = std::floor(p.y) - static_cast<float>(rows.first);
    return row >= 0 && row < static_cast<float>(count) ? static_cast<int>(row) : -1;
  };
  rows.begin.assign(count + 1, 0);
  for (const Vec2f p : positions)
    if (const int row = row_of(p); row >= 0) ++rows.begin[row + 1];
  for (int k = 0; k < count; ++k) rows.begin[k + 1] += rows.begin[k];
  rows.samples.resize(rows.begin.back());
  std::vector<std::size_t> next(rows.begin.begin(), rows.begin.end() - 1);
  for (std::size_t i = 0; i < positions.size(); ++i)
    if (const int row = row_of(positions[i]); row >= 0)
      rows.samples[next[row]++] = static_cast<std::uint32_t>(i);
  return rows;
}

struct Pixel {
  double r = 0, g = 0, b = 0, weight = 0;
  void add(Rgb value, double w) {
    r += w * value.r, g += w * value.g, b += w * value.b;
    weight += w;
  }
  Rgb mean() const {
    return {static_cast<float>(r / weight), static_cast<float>(g / weight), static_cast<float>(b / weight)};
  }
};

struct Splatter {
  Vec2i corner;  // of the window
  int width;
  const Filter& filter;
  std::span<const Vec2f> positions;
  std::span<const Rgb> values;
  const Rows& rows;
  int reach;

  // Calls visit(x, weight, value) for what row y receives, in the order of sample rows, then of samples.
  template <typename Visit>
  void gather(int y, Visit&& visit) const {
    for (int k = y; k <= y + 2 * reach; ++k)  // group k holds row k - reach
      for (std::size_t s = rows.begin[k]; s < rows.begin[k + 1]; ++s) {
        const std::uint32_t i = rows.samples[s];
        const float wy = filter.eval(positions[i].y - (static_cast<float>(corner.y + y) + 0.5f));
        if (wy == 0) continue;
        const float column = std::floor(positions[i].x) - static_cast<float>(corner.x);
        if (!(column >= static_cast<float>(-reach) && column < static_cast<float>(width + reach))) continue;
        const int center = static_cast<int>(column);
        for (int x = std::max(0, center - reach); x <= std::min(width - 1, center + reach); ++x) {
          const float wx = filter.eval(positions[i].x - (static_cast<float>(corner.x + x) + 0.5f));
          if (wx != 0) visit(x, static_cast<double>(wx) * wy, values[i]);
        }
      }
  }

  void row(int y, Rgb* out) const {
    std::vector<Pixel> sums(width);
    std::vector<double> magnitudes(width, 0.0);
    gather(y, [&](int x, double w, Rgb value) {
      sums[x].add(value, w);
      magnitudes[x] += std::abs(w);
    });
    bool cancelled = false;
    for (int x = 0; x < width; ++x) {
      if (magnitudes[x] == 0) continue;
      if (std::abs(sums[x].weight) < kCancelled * magnitudes[x]) {
        cancelled = true;
      } else {
        out[x] = sums[x].mean();
      }
    }
    if (!cancelled) return;
    std::vector<Pixel> positive(width);
    gather(y, [&](int x, double w, Rgb value) { positive[x].add(value, std::abs(w)); });
    for (int x = 0; x < width; ++x)
      if (magnitudes[x] != 0 && std::abs(sums[x].weight) < kCancelled * magnitudes[x])
        out[x] = positive[x].mean();
  }

  // Below this ratio of signed to unsigned weight the quotient would be mostly amplified noise.
  static constexpr double kCancelled = 0.05;
};

}  // namespace

image::Image splat(int width, int height, const Filter& filter, std::span<const Vec2f> positions,
                   std::span<const Rgb> values, Vec2i corner) {
  if (positions.size() != values.size()) throw InternalError("as many film positions as values are needed");
  if (positions.size() > UINT32_MAX) throw InternalError("more than 2^32 - 1 film samples");
  image::Image image(width, height);
  const int reach = filter.reach();
  const Rows rows = group_by_row(corner.y, height, reach, positions);
  const Splatter splatter{corner, width, filter, positions, values, rows, reach};
  const bool own_pixel_only = filter.kind == FilterKind::box && filter.radius == 0.5f;
  parallel_for(static_cast<std::size_t>(height), 4, [&](std::size_t begin, std::size_t end) {
    for (std::size_t y = begin; y < end; ++y) {
      Rgb* out = &image.pixels[y * width];
      if (!own_pixel_only) {
        splatter.row(static_cast<int>(y), out);
        continue;
      }
      std::vector<Pixel> sums(width);
      for (std::size_t s = rows.begin[y]; s < rows.begin[y + 1]; ++s) {
        const std::uint32_t i = rows.samples[s];
        const float column = std::floor(positions[i].x) - static_cast<float>(corner.x);
        if (column >= 0 && column < static_cast<float>(width))
          sums[static_cast<int>(column)].add(values[i], 1);
      }
      for (int x = 0; x < width; ++x)
        if (sums[x].weight > 0) out[x] = sums[x].mean();
    }
  });
  return image;
}

}  // namespace lumirank::film
