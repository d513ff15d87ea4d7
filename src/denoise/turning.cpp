#include "denoise/turning.h"

#include <cstddef>

#include "base/parallel.h"

namespace lumirank::denoise {
namespace {

constexpr std::size_t kRowsOfTurned = 16;

}  // namespace

image::Image turned(const image::Image& image, int quarters) {
  const int turns = ((quarters % 4) + 4) % 4;
  if (turns == 0) return image;
  const bool on_its_side = turns % 2 == 1;
  image::Image out(on_its_side ? image.height : image.width, on_its_side ? image.width : image.height);
  const int last_x = image.width - 1, last_y = image.height - 1;
  parallel_for(static_cast<std::size_t>(out.height), kRowsOfTurned, [&](std::size_t begin, std::size_t end) {
    for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y)
      for (int x = 0; x < out.width; ++x)
        out.at(x, y) = turns == 1   ? image.at(y, last_y - x)
                       : turns == 2 ? image.at(last_x - x, last_y - y)
                                    : image.at(last_x - y, x);
  });
  return out;
}

}  // namespace lumirank::denoise
