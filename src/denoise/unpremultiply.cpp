#include "denoise/unpremultiply.h"

#include <algorithm>
#include <cstddef>
#include <tuple>

#include "base/error.h"
#include "base/parallel.h"

namespace lumirank::denoise {
namespace {

using image::Image;

// Of a pixel with so much of it, what covers it is known by itself.
constexpr float kBelieved = 0.5f;
constexpr std::size_t kRowsOfPyramid = 16;

struct Level {
  Image picture, cover;
};

Level coarser(const Level& fine) {
  const int width = (fine.picture.width + 1) / 2, height = (fine.picture.height + 1) / 2;
  Level out{Image(width, height), Image(width, height)};
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      Rgb sum(0);
      float cover = 0;
      for (int v = 2 * y; v < std::min(2 * y + 2, fine.picture.height); ++v)
        for (int u = 2 * x; u < std::min(2 * x + 2, fine.picture.width); ++u)
          sum += fine.picture.at(u, v), cover += fine.cover.at(u, v).r;
      // One that is covered says as much as four.
      const float part = cover > 1 ? 1 / cover : 1.0f;
      out.picture.at(x, y) = sum * part, out.cover.at(x, y) = Rgb(std::min(1.0f, cover));
    }
  return out;
}

// Of the coarser level, linearly between its pixels.
Rgb between(const Image& coarse, int x, int y) {
  const auto along = [](int at, int size) {
    const float place =
        std::clamp(0.5f * (static_cast<float>(at) + 0.5f) - 0.5f, 0.0f, static_cast<float>(size - 1));
    const int first = static_cast<int>(place);
    return std::tuple(first, std::min(first + 1, size - 1), place - static_cast<float>(first));
  };
  const auto [x0, x1, fx] = along(x, coarse.width);
  const auto [y0, y1, fy] = along(y, coarse.height);
  return (coarse.at(x0, y0) * (1 - fx) + coarse.at(x1, y0) * fx) * (1 - fy) +
         (coarse.at(x0, y1) * (1 - fx) + coarse.at(x1, y1) * fx) * fy;
}

Image filled(const Level& level) {
  const Image &picture = level.picture, &cover = level.cover;
  Image out(picture.width, picture.height), around;
  const bool believed =
      std::all_of(cover.pixels.begin(), cover.pixels.end(), [](Rgb part) { return part.r >= kBelieved; });
  if (!believed && picture.pixels.size() > 1) around = filled(coarser(level));
  parallel_for(static_cast<std::size_t>(picture.height), kRowsOfPyramid,
               [&](std::size_t begin, std::size_t end) {
                 for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y)
                   for (int x = 0; x < picture.width; ++x) {
                     const float c = cover.at(x, y).r;
                     out.at(x, y) = picture.at(x, y) * (1 / std::max(c, kBelieved));
                     if (c < kBelieved && !around.pixels.empty())
                       out.at(x, y) += between(around, x, y) * (1 - c / kBelieved);
                   }
               });
  return out;
}

void require_one_size(const Image& a, const Image& b) {
  if (a.width != b.width || a.height != b.height)
    throw InternalError("unpremultiplied: a picture and what is covered of it differ in size");
}

}  // namespace

Image unpremultiplied(const Image& picture, const Image& cover) {
  require_one_size(picture, cover);
  return filled({picture, cover});
}

void premultiply(Image& picture, const Image& cover) {
  require_one_size(picture, cover);
  for (std::size_t p = 0; p < picture.pixels.size(); ++p) picture.pixels[p] *= cover.pixels[p];
}

}  // namespace lumirank::denoise
