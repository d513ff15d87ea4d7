// Makes a LoadedImage of the rows that a reader hands over.
#pragma once

#include <array>
#include <string>

#include "image/image_io.h"
#include "image/pixel_sink.h"

namespace lumirank::image {

class ImageBuilder final : public PixelSink {
 public:
  // `name`: of the file, for messages. `raw`: colors stay as they are stored; otherwise encoded ones are
  // decoded. Alpha is coverage and never decoded.
  ImageBuilder(std::string name, bool raw, std::size_t max_pixels);

  void begin(const PixelLayout& layout) override;
  void add(const std::uint8_t* samples, std::size_t pixels) override;
  void add(const std::uint16_t* samples, std::size_t pixels) override;
  void add(const float* samples, std::size_t pixels) override;

  // Once, after the last row.
  LoadedImage take();

 private:
  template <typename Sample, typename Color, typename Coverage>
  void append(const Sample* samples, std::size_t pixels, const Color& color, const Coverage& coverage);

  const std::string name_;
  const bool raw_;
  const std::size_t max_pixels_;
  PixelLayout layout_;
  std::array<float, 256> of_byte_{};  // what a byte of color stands for
  LoadedImage image_;
};

}  // namespace lumirank::image
