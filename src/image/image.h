// Images of linear RGB radiance (or any three numbers per pixel), row 0 at the top.
#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "base/rgb.h"

namespace lumirank::image {

struct Image {
  int width = 0, height = 0;
  std::vector<Rgb> pixels;

  Image() = default;
  Image(int w, int h, Rgb fill = Rgb{})
      : width(w), height(h), pixels(static_cast<std::size_t>(w) * h, fill) {}
  Rgb& at(int x, int y) { return pixels[static_cast<std::size_t>(y) * width + x]; }
  const Rgb& at(int x, int y) const { return pixels[static_cast<std::size_t>(y) * width + x]; }
};

// Of one size: pixel by pixel.
inline void add_to(Image& sum, const Image& image) {
  for (std::size_t p = 0; p < image.pixels.size(); ++p) sum.pixels[p] += image.pixels[p];
}

// A picture with named layers besides its colors: layer "direct" becomes the EXR channels direct.R,
// direct.G, direct.B.
struct LayeredImage {
  Image color;
  std::vector<std::pair<std::string, Image>> layers;
};

}  // namespace lumirank::image
