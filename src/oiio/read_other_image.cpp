// The module that reads what OpenImageIO reads; see film/other_formats.h.
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "image/other_formats.h"

namespace lumirank::image {
namespace {

struct ReadFailure {
  std::string why;
};

// A run of channels that holds color and alpha, and the layout of what is read of it.
struct ChannelRange {
  int begin = 0, end = 0;
  PixelLayout layout;
};

ChannelRange choose_channels(const OIIO::ImageSpec& spec) {
  ChannelRange range;
  PixelLayout& layout = range.layout;
  layout.width = spec.width, layout.height = spec.height;
  layout.encoded = !spec.format.is_floating_point();
  layout.alpha = spec.alpha_channel;
  const auto find = [&](const char* name) {
    for (int c = 0; c < spec.nchannels; ++c)
      if (spec.channel_name(c) == name) return c;
    return -1;
  };
  layout.color = {find("R"), find("G"), find("B")};
  if (*std::min_element(layout.color.begin(), layout.color.end()) < 0) {
    std::vector<int> others;
    for (int c = 0; c < spec.nchannels; ++c)
      if (c != layout.alpha) others.push_back(c);
    if (others.empty()) others.push_back(layout.alpha);  // a file of nothing but alpha is read as gray
    const std::size_t step = others.size() >= 3 ? 1 : 0;
    layout.color = {others[0], others[step], others[2 * step]};
  }
  const auto [lowest, highest] = std::minmax_element(layout.color.begin(), layout.color.end());
  range.begin = *lowest, range.end = *highest + 1;
  if (layout.alpha >= 0) {
    range.begin = std::min(range.begin, layout.alpha);
    range.end = std::max(range.end, layout.alpha + 1);
    layout.alpha -= range.begin;
  }
  for (int& c : layout.color) c -= range.begin;
  layout.channels = range.end - range.begin;
  return range;
}

// One at a time: while it opens a file OpenImageIO (2.4.7) decodes its ICC profile by way of a table that
// several threads corrupt.
std::unique_ptr<OIIO::ImageInput> open(const std::string& filename) {
  static std::mutex mutex;
  const std::lock_guard lock(mutex);
  OIIO::ImageSpec wishes;
  wishes.attribute("oiio:UnassociatedAlpha", 1);  // colors as stored, not multiplied by alpha
  return OIIO::ImageInput::open(filename, &wishes);
}

class OtherReader {
 public:
  OtherReader(const std::string& filename, PixelSink& sink) : input_(open(filename)), sink_(sink) {
    if (!input_) fail(OIIO::geterror());
    input_->threads(1);
  }

  void read() const {
    const OIIO::ImageSpec spec = input_->spec();
    if (spec.width <= 0 || spec.height <= 0 || spec.nchannels <= 0) fail("it has no pixels");
    if (spec.depth > 1 || spec.deep) fail("volumes and deep images are not pictures");
    const ChannelRange range = choose_channels(spec);
    sink_.begin(range.layout);
    if (spec.format.basetype == OIIO::TypeDesc::UINT8) {
      read_rows<std::uint8_t>(spec, range, OIIO::TypeDesc::UINT8);
    } else if (spec.format.basetype == OIIO::TypeDesc::UINT16) {
      read_rows<std::uint16_t>(spec, range, OIIO::TypeDesc::UINT16);
    } else {
      read_rows<float>(spec, range, OIIO::TypeDesc::FLOAT);
    }
  }

 private:
  template <typename Sample>
  void read_rows(const OIIO::ImageSpec& spec, const ChannelRange& range, OIIO::TypeDesc type) const {
    int rows = strip_rows(range.layout);
    if (spec.tile_width > 0) rows = std::max(1, rows / spec.tile_height) * spec.tile_height;
    std::vector<Sample> strip;
    for (int y = 0; y < spec.height; y += rows) {
      const int end = std::min(spec.height, y + rows);
      const std::size_t pixels = static_cast<std::size_t>(end - y) * static_cast<std::size_t>(spec.width);
      strip.resize(pixels * static_cast<std::size_t>(range.layout.channels));
      const bool read =
          spec.tile_width > 0
              ? input_->read_tiles(0, 0, spec.x, spec.x + spec.width, spec.y + y, spec.y + end, spec.z,
                                   spec.z + 1, range.begin, range.end, type, strip.data())
              : input_->read_scanlines(0, 0, spec.y + y, spec.y + end, spec.z, range.begin, range.end, type,
                                       strip.data());
      // Some of its readers leave out what a file lacks, and say so only here.
      if (!read || input_->has_error()) fail(input_->geterror());
      if constexpr (std::is_same_v<Sample, std::uint8_t>)
        if (multiplied_by_alpha(spec)) divide_by_alpha(range.layout, strip);
      sink_.add(strip.data(), pixels);
    }
  }

  // WebP's colors are not, but its reader (2.4.7) does it whatever is wished.
  bool multiplied_by_alpha(const OIIO::ImageSpec& spec) const {
    return std::string_view(input_->format_name()) == "webp" && spec.alpha_channel >= 0 &&
           spec.get_int_attribute("oiio:UnassociatedAlpha") == 0;
  }
  static void divide_by_alpha(const PixelLayout& layout, std::vector<std::uint8_t>& strip) {
    for (std::size_t at = 0; at < strip.size(); at += static_cast<std::size_t>(layout.channels)) {
      const int alpha = strip[at + static_cast<std::size_t>(layout.alpha)];
      if (alpha == 0) continue;
      for (const int c : layout.color) {
        std::uint8_t& value = strip[at + static_cast<std::size_t>(c)];
        value = static_cast<std::uint8_t>(std::min(255, (255 * value + alpha / 2) / alpha));
      }
    }
  }

  [[noreturn]] static void fail(const std::string& why) {
    throw ReadFailure{why.empty() ? "it is damaged" : why};
  }

  const std::unique_ptr<OIIO::ImageInput> input_;
  PixelSink& sink_;
};

}  // namespace
}  // namespace lumirank::image

// What the sink throws goes through; what goes wrong here is stated in `error`.
extern "C" [[gnu::visibility("default")]] void lumirank_read_other_image(const std::string& filename,
                                                                         lumirank::image::PixelSink& sink,
                                                                         std::string& error) {
  try {
    lumirank::image::OtherReader(filename, sink).read();
  } catch (const lumirank::image::ReadFailure& failure) {
    error = failure.why;
  }
}
