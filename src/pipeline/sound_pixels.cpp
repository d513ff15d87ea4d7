#include "pipeline/sound_pixels.h"

#include <string>

#include "base/error.h"

namespace lumirank::pipeline {

void check_pixels(const image::Image& image) {
  std::size_t bad = 0, first = 0;
  for (std::size_t p = 0; p < image.pixels.size(); ++p)
    if (!is_finite(image.pixels[p]) && bad++ == 0) first = p;
  if (bad == 0) return;
  const auto width = static_cast<std::size_t>(image.width);
  throw InputError(std::to_string(bad) + " of " + std::to_string(image.pixels.size()) +
                       " pixels are not finite numbers (the first: column " + std::to_string(first % width) +
                       ", row " + std::to_string(first / width) + ")",
                   "most likely a light is far too bright, or a number of a material far too large, for "
                   "32-bit arithmetic: check the scene for values with many zeros");
}

}  // namespace lumirank::pipeline
