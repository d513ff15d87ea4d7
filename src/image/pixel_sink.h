// Destination of what readers of image formats read: first what the picture is, then its rows from the top. A
// reader needs no memory for the whole picture, and what a header promises but the file does not hold never
// takes any.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace lumirank::image {

// What the rows that follow hold.
struct PixelLayout {
  int width = 0, height = 0;
  int channels = 0;                   // samples of each pixel, side by side
  std::array<int, 3> color{0, 0, 0};  // which of them become red, green and blue
  int alpha = -1;                     // -1: none
  bool encoded = true;                // as sRGB says; false: proportional to light
};

// Gray, gray with alpha, RGB, RGB with alpha: what most formats know.
inline PixelLayout usual_layout(int width, int height, int channels) {
  return {width,
          height,
          channels,
          channels < 3 ? std::array{0, 0, 0} : std::array{0, 1, 2},
          channels == 2 || channels == 4 ? channels - 1 : -1,
          true};
}

class PixelSink {
 public:
  virtual ~PixelSink() = default;
  // Throws InputError if the size is not one of a picture or above what is allowed.
  virtual void begin(const PixelLayout& layout) = 0;
  // Whole numbers stand for fractions of their type's largest.
  virtual void add(const std::uint8_t* samples, std::size_t pixels) = 0;
  virtual void add(const std::uint16_t* samples, std::size_t pixels) = 0;
  virtual void add(const float* samples, std::size_t pixels) = 0;
};

// Rows that a reader should hand over at once: about a million pixels.
inline int strip_rows(const PixelLayout& layout) {
  const int rows = (1 << 20) / layout.width;
  return rows < 1 ? 1 : rows > layout.height ? layout.height : rows;
}

}  // namespace lumirank::image
