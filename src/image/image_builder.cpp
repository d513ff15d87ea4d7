#include "image/image_builder.h"

#include "base/error.h"
#include "base/parallel.h"
#include "image/srgb.h"

namespace lumirank::image {

ImageBuilder::ImageBuilder(std::string name, bool raw, std::size_t max_pixels)
    : name_(std::move(name)), raw_(raw), max_pixels_(max_pixels) {
  for (int i = 0; i < 256; ++i) {
    const auto code = static_cast<float>(i);
    of_byte_[static_cast<std::size_t>(i)] = raw ? code * (1 / 255.0f) : srgb_decode(code / 255.0f);
  }
}

void ImageBuilder::begin(const PixelLayout& layout) {
  if (layout.width <= 0 || layout.height <= 0 || layout.channels <= 0)
    throw InputError(SourceLocation{name_, 0}, "cannot read the image: it has no pixels");
  if (static_cast<std::size_t>(layout.width) > max_pixels_ / static_cast<std::size_t>(layout.height))
    throw InputError(SourceLocation{name_, 0},
                     "the image has " + std::to_string(layout.width) + " x " + std::to_string(layout.height) +
                         " pixels, more than the limit of " + std::to_string(max_pixels_));
  layout_ = layout;
  image_.color.width = layout.width, image_.color.height = layout.height;
}

template <typename Sample, typename Color, typename Coverage>
void ImageBuilder::append(const Sample* samples, std::size_t pixels, const Color& color,
                          const Coverage& coverage) {
  const std::size_t first = image_.color.pixels.size();
  image_.color.pixels.resize(first + pixels);
  if (layout_.alpha >= 0) image_.alpha.resize(first + pixels);
  const auto channels = static_cast<std::size_t>(layout_.channels);
  parallel_for(pixels, 1 << 15, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Sample* values = samples + i * channels;
      Rgb& pixel = image_.color.pixels[first + i];
      for (int c = 0; c < 3; ++c) pixel[c] = color(values[layout_.color[static_cast<std::size_t>(c)]]);
      if (layout_.alpha >= 0) image_.alpha[first + i] = coverage(values[layout_.alpha]);
    }
  });
}

void ImageBuilder::add(const std::uint8_t* samples, std::size_t pixels) {
  append(
      samples, pixels, [this](std::uint8_t v) { return of_byte_[v]; },
      [](std::uint8_t v) { return static_cast<float>(v) * (1 / 255.0f); });
}

void ImageBuilder::add(const std::uint16_t* samples, std::size_t pixels) {
  const auto fraction = [](std::uint16_t v) { return static_cast<float>(v) * (1 / 65535.0f); };
  const auto color = [&](std::uint16_t v) { return raw_ ? fraction(v) : srgb_decode(fraction(v)); };
  append(samples, pixels, color, fraction);
}

void ImageBuilder::add(const float* samples, std::size_t pixels) {
  const bool decode = layout_.encoded && !raw_;
  append(
      samples, pixels, [decode](float v) { return decode ? srgb_decode(v) : v; }, [](float v) { return v; });
}

LoadedImage ImageBuilder::take() {
  if (image_.color.pixels.empty() ||
      image_.color.pixels.size() !=
          static_cast<std::size_t>(layout_.width) * static_cast<std::size_t>(layout_.height))
    throw InternalError("the reader of " + name_ + " left rows out");
  return std::move(image_);
}

}  // namespace lumirank::image
