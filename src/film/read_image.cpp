#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <array>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <memory>
#include <mutex>
#include <sstream>

#include "base/error.h"
#include "base/parallel.h"
#include "film/exr_header.h"
#include "film/file_end.h"
#include "film/image_io.h"
#include "film/pfm.h"
#include "film/srgb.h"

namespace lumirank::film {
namespace {
namespace fs = std::filesystem;

// Which channels of the file become colour and alpha; -1: none.
struct Channels {
  std::array<int, 3> color{-1, -1, -1};
  int alpha = -1;
  int begin = 0, end = 0;  // the range that has to be read
};

Channels choose_channels(const OIIO::ImageSpec& spec) {
  Channels chosen;
  const auto find = [&](const char* name) {
    for (int c = 0; c < spec.nchannels; ++c)
      if (spec.channel_name(c) == name) return c;
    return -1;
  };
  chosen.alpha = spec.alpha_channel;
  chosen.color = {find("R"), find("G"), find("B")};
  if (*std::min_element(chosen.color.begin(), chosen.color.end()) < 0) {
    std::vector<int> others;
    for (int c = 0; c < spec.nchannels; ++c)
      if (c != chosen.alpha) others.push_back(c);
    if (others.empty()) others.push_back(chosen.alpha);  // a file of nothing but alpha is read as grey
    if (others.size() >= 3) {
      chosen.color = {others[0], others[1], others[2]};
    } else {
      chosen.color = {others[0], others[0], others[0]};
    }
  }
  const auto [lowest, highest] = std::minmax_element(chosen.color.begin(), chosen.color.end());
  chosen.begin = *lowest, chosen.end = *highest + 1;
  if (chosen.alpha >= 0) {
    chosen.begin = std::min(chosen.begin, chosen.alpha);
    chosen.end = std::max(chosen.end, chosen.alpha + 1);
  }
  return chosen;
}

// Encoded to linear for integer files; 8-bit ones by a table.
class Decoder {
 public:
  Decoder(const OIIO::TypeDesc& format, bool raw) : decode_(!raw && !format.is_floating_point()) {
    if (format.basetype == OIIO::TypeDesc::UINT8)
      for (int i = 0; i < 256; ++i) table_.push_back(srgb_decode(static_cast<float>(i) / 255.0f));
  }
  float operator()(float v) const {
    if (!decode_) return v;
    if (table_.empty()) return srgb_decode(v);
    return table_[static_cast<std::size_t>(std::lround(std::clamp(v, 0.0f, 1.0f) * 255.0f))];
  }

 private:
  bool decode_;
  std::vector<float> table_;
};

class Reader {
 public:
  Reader(const std::string& filename, bool raw, std::size_t max_pixels)
      : filename_(filename), raw_(raw), max_pixels_(max_pixels) {}

  // The file `filename`, or with `memory` the bytes there, whose format the ending of `opened_as` tells.
  LoadedImage read(OIIO::Filesystem::IOProxy* memory = nullptr, const std::string& opened_as = {}) {
    OIIO::ImageSpec wishes;
    wishes.attribute("oiio:UnassociatedAlpha", 1);  // colours as stored, not multiplied by alpha
    if (memory) wishes.attribute("oiio:ioproxy", OIIO::TypeDesc::PTR, &memory);
    const auto input = open(memory ? opened_as : filename_, wishes);
    if (!input) fail(OIIO::geterror());
    input->threads(1);
    const OIIO::ImageSpec spec = input->spec();
    check(spec);
    const Channels channels = choose_channels(spec);
    const Decoder decoder(spec.format, raw_);

    // Read in strips and grow: a header that promises more than the file holds fails before its memory is
    // taken.
    LoadedImage loaded;
    loaded.color.width = spec.width, loaded.color.height = spec.height;
    const int count = channels.end - channels.begin;
    const int rows = strip_rows(spec);
    std::vector<float> strip;
    for (int y = 0; y < spec.height; y += rows) {
      const int end = std::min(spec.height, y + rows);
      strip.resize(static_cast<std::size_t>(end - y) * spec.width * count);
      const bool ok = spec.tile_width > 0
                          ? input->read_tiles(0, 0, spec.x, spec.x + spec.width, spec.y + y, spec.y + end,
                                              spec.z, spec.z + 1, channels.begin, channels.end,
                                              OIIO::TypeDesc::FLOAT, strip.data())
                          : input->read_scanlines(0, 0, spec.y + y, spec.y + end, spec.z, channels.begin,
                                                  channels.end, OIIO::TypeDesc::FLOAT, strip.data());
      if (!ok) fail(input->geterror());
      append(loaded, strip, count, channels, decoder);
    }
    return loaded;
  }

 private:
  // One at a time: while it opens a file OpenImageIO (2.4.7) decodes its ICC profile by way of a table that
  // several threads corrupt.
  static std::unique_ptr<OIIO::ImageInput> open(const std::string& name, const OIIO::ImageSpec& wishes) {
    static std::mutex mutex;
    const std::lock_guard lock(mutex);
    return OIIO::ImageInput::open(name, &wishes);
  }

  [[noreturn]] void fail(const std::string& why) const {
    throw InputError(SourceLocation{filename_, 0},
                     "cannot read the image: " + (why.empty() ? "it is damaged" : why));
  }

  void check(const OIIO::ImageSpec& spec) const {
    if (spec.width <= 0 || spec.height <= 0 || spec.nchannels <= 0) fail("it has no pixels");
    if (spec.depth > 1 || spec.deep) fail("volumes and deep images are not pictures");
    const auto pixels =
        static_cast<unsigned long long>(spec.width) * static_cast<unsigned long long>(spec.height);
    if (pixels > max_pixels_)
      throw InputError(SourceLocation{filename_, 0},
                       "the image has " + std::to_string(spec.width) + " x " + std::to_string(spec.height) +
                           " pixels, more than the limit of " + std::to_string(max_pixels_));
  }

  // About a million pixels, whole tiles, at least one row.
  static int strip_rows(const OIIO::ImageSpec& spec) {
    const int wanted = std::max(1, (1 << 20) / spec.width);
    if (spec.tile_width <= 0) return wanted;
    return std::max(1, wanted / spec.tile_height) * spec.tile_height;
  }

  static void append(LoadedImage& loaded, const std::vector<float>& strip, int count,
                     const Channels& channels, const Decoder& decoder) {
    const std::size_t pixels = strip.size() / count, first = loaded.color.pixels.size();
    loaded.color.pixels.resize(first + pixels);
    if (channels.alpha >= 0) loaded.alpha.resize(first + pixels);
    parallel_for(pixels, 1 << 15, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        const float* values = &strip[i * count];
        Rgb& pixel = loaded.color.pixels[first + i];
        for (int c = 0; c < 3; ++c) pixel[c] = decoder(values[channels.color[c] - channels.begin]);
        if (channels.alpha >= 0) loaded.alpha[first + i] = values[channels.alpha - channels.begin];
      }
    });
  }

  const std::string& filename_;
  const bool raw_;
  const std::size_t max_pixels_;
};

bool starts_with_pfm_magic(const std::string& filename) {
  std::ifstream in(filename, std::ios::binary);
  char magic[3] = {};
  in.read(magic, 3);
  return in && magic[0] == 'P' && (magic[1] == 'F' || magic[1] == 'f') &&
         std::isspace(static_cast<unsigned char>(magic[2]));
}

// Whatever a decoder throws, as an InputError.
template <typename Read>
LoadedImage guarded(const std::string& name, const Read& read) {
  try {
    return read();
  } catch (const InputError&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw InputError(SourceLocation{name, 0}, "the image needs more memory than there is");
  } catch (const std::exception& failure) {
    throw InputError(SourceLocation{name, 0}, std::string("cannot read the image: ") + failure.what());
  }
}

}  // namespace

LoadedImage read_image(const std::string& filename, bool raw, std::size_t max_pixels) {
  std::error_code error;
  const fs::file_status status = fs::status(filename, error);
  if (!fs::exists(status))
    throw InputError(SourceLocation{filename, 0}, "the image does not exist", "check its path");
  if (!fs::is_regular_file(status))
    throw InputError(SourceLocation{filename, 0}, "this is not a file, let alone an image");
  if (starts_with_pfm_magic(filename)) return {read_pfm(filename, max_pixels), {}};
  require_file_end(filename);
  require_sane_exr_header(filename, max_pixels);
  return guarded(filename, [&] { return Reader(filename, raw, max_pixels).read(); });
}

LoadedImage decode_image(const std::string& bytes, const std::string& name, bool raw,
                         std::size_t max_pixels) {
  const bool png = bytes.starts_with("\x89PNG\r\n\x1a\n"), jpeg = bytes.starts_with("\xff\xd8\xff");
  if (!png && !jpeg)
    throw InputError(SourceLocation{name, 0}, "an image in memory is neither a PNG nor a JPEG file",
                     "embed one of these, or keep the image in a file of its own");
  std::istringstream in(bytes, std::ios::binary);
  require_file_end(in, name);
  return guarded(name, [&] {
    OIIO::Filesystem::IOMemReader memory(bytes.data(), bytes.size());
    return Reader(name, raw, max_pixels).read(&memory, png ? "memory.png" : "memory.jpg");
  });
}

}  // namespace lumirank::film
