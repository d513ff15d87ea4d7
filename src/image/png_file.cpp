#include "image/png_file.h"

#include <png.h>

#include <algorithm>
#include <bit>
#include <csetjmp>
#include <cstdio>
#include <cstring>
#include <limits>
#include <new>
#include <stdexcept>

namespace lumirank::image {
namespace {

// What libpng's callbacks see.
struct PngBytes {
  const unsigned char* next = nullptr;
  std::size_t left = 0;
  std::string* written = nullptr;
  char message[160] = "";
};

// libpng leaves a failed call by longjmp, over frames that must own nothing: those of libpng and of the
// small function objects given to `attempt`.
[[noreturn]] void png_failed(png_structp png, png_const_charp message) {
  auto* bytes = static_cast<PngBytes*>(png_get_error_ptr(png));
  std::snprintf(bytes->message, sizeof bytes->message, "%s", message);
  png_longjmp(png, 1);
}

void png_warned(png_structp, png_const_charp) {}

void png_give(png_structp png, png_bytep to, std::size_t count) {
  auto* bytes = static_cast<PngBytes*>(png_get_io_ptr(png));
  if (count > bytes->left) png_error(png, "it is truncated");
  std::memcpy(to, bytes->next, count);
  bytes->next += count, bytes->left -= count;
}

void png_take(png_structp png, png_bytep from, std::size_t count) {
  bool full = false;
  try {
    static_cast<PngBytes*>(png_get_io_ptr(png))->written->append(reinterpret_cast<char*>(from), count);
  } catch (...) {
    full = true;
  }
  if (full) png_error(png, "there is not enough memory");
}

void png_flushed(png_structp) {}

template <typename Step>
[[gnu::noinline]] bool png_step(png_structp png, const Step& step) {
  if (setjmp(png_jmpbuf(png)) != 0) return false;
  step();
  return true;
}

class PngReader {
 public:
  explicit PngReader(std::string_view input) {
    bytes_.next = reinterpret_cast<const unsigned char*>(input.data()), bytes_.left = input.size();
    png_ = png_create_read_struct(PNG_LIBPNG_VER_STRING, &bytes_, png_failed, png_warned);
    if (png_) info_ = png_create_info_struct(png_);
    if (!info_) {
      png_destroy_read_struct(&png_, nullptr, nullptr);
      throw std::bad_alloc();
    }
    png_set_read_fn(png_, &bytes_, png_give);
  }
  ~PngReader() { png_destroy_read_struct(&png_, &info_, nullptr); }
  PngReader(const PngReader&) = delete;
  PngReader& operator=(const PngReader&) = delete;

  void read(PixelSink& sink) {
    const std::size_t file_size = bytes_.left;
    attempt([this] { read_header(); });
    const PixelLayout layout = usual_layout(static_cast<int>(width_), static_cast<int>(height_), channels());
    sink.begin(layout);
    // Deflate makes at most 1032 bytes of one, so that a header that lies takes no memory.
    const std::uint64_t row_bits = std::uint64_t{width_} * stored_channels() * static_cast<unsigned>(depth_);
    if ((row_bits / 8 + 1) * height_ / 1032 > file_size)
      throw std::runtime_error("its header promises more than the file holds");
    attempt([this] { png_read_update_info(png_, info_); });
    if (png_get_channels(png_, info_) != layout.channels) throw std::runtime_error("its header is damaged");
    const std::size_t row_bytes = png_get_rowbytes(png_, info_);

    // An interlaced picture is complete at its end only.
    const bool interlaced = interlace_ != PNG_INTERLACE_NONE;
    const int strip = interlaced ? layout.height : strip_rows(layout);
    std::vector<unsigned char> pixels(row_bytes * static_cast<std::size_t>(strip));
    std::vector<png_bytep> rows(static_cast<std::size_t>(strip));
    for (std::size_t r = 0; r < rows.size(); ++r) rows[r] = pixels.data() + r * row_bytes;
    for (int y = 0; y < layout.height; y += strip) {
      const int count = std::min(strip, layout.height - y);
      attempt([&] {
        if (interlaced) {
          png_read_image(png_, rows.data());
        } else {
          png_read_rows(png_, rows.data(), nullptr, static_cast<png_uint_32>(count));
        }
      });
      const std::size_t n = static_cast<std::size_t>(count) * static_cast<std::size_t>(layout.width);
      if (depth_ == 16) {
        sink.add(reinterpret_cast<const std::uint16_t*>(pixels.data()), n);
      } else {
        sink.add(pixels.data(), n);
      }
    }
  }

 private:
  template <typename Step>
  void attempt(const Step& step) {
    if (!png_step(png_, step)) throw std::runtime_error(bytes_.message);
  }

  void read_header() {
    constexpr png_uint_32 kMaxSize = 0x7fffffff;  // `sink` has a limit of its own, and says so better
    png_set_user_limits(png_, kMaxSize, kMaxSize);
    // What is not read is not unpacked either.
    static const unsigned char ignored[] =
        "iCCP\0zTXt\0iTXt\0tEXt\0eXIf\0sPLT\0hIST\0tIME\0pCAL\0"
        "sCAL\0cHRM\0gAMA\0sRGB\0pHYs\0oFFs\0bKGD\0sBIT";
    png_set_keep_unknown_chunks(png_, PNG_HANDLE_CHUNK_NEVER, ignored, sizeof ignored / 5);
    png_read_info(png_, info_);
    int compression = 0, filter = 0;
    png_get_IHDR(png_, info_, &width_, &height_, &depth_, &color_, &interlace_, &compression, &filter);
    transparent_ = png_get_valid(png_, info_, PNG_INFO_tRNS) != 0;
    png_set_expand(png_);  // to 8 bits at least, palettes to colors, transparent colors to alpha
    if (std::endian::native == std::endian::little) png_set_swap(png_);
  }

  int channels() const {
    const int colors = color_ & PNG_COLOR_MASK_COLOR ? 3 : 1;
    return colors + (color_ & PNG_COLOR_MASK_ALPHA || transparent_ ? 1 : 0);
  }
  unsigned stored_channels() const {
    if (color_ & PNG_COLOR_MASK_PALETTE) return 1;
    return (color_ & PNG_COLOR_MASK_COLOR ? 3u : 1u) + (color_ & PNG_COLOR_MASK_ALPHA ? 1u : 0u);
  }

  PngBytes bytes_;
  png_structp png_ = nullptr;
  png_infop info_ = nullptr;
  png_uint_32 width_ = 0, height_ = 0;
  int depth_ = 0, color_ = 0, interlace_ = 0;
  bool transparent_ = false;
};

}  // namespace

void read_png(std::string_view bytes, PixelSink& sink) { PngReader(bytes).read(sink); }

std::string encode_png(int width, int height, const std::vector<unsigned char>& rgb) {
  std::string file;
  PngBytes bytes;
  bytes.written = &file;
  std::vector<png_bytep> rows(static_cast<std::size_t>(height));
  for (std::size_t y = 0; y < rows.size(); ++y)
    rows[y] = const_cast<png_bytep>(rgb.data()) + y * static_cast<std::size_t>(width) * 3;
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, &bytes, png_failed, png_warned);
  png_infop info = png ? png_create_info_struct(png) : nullptr;
  const bool done = info && png_step(png, [&] {
                      png_set_write_fn(png, &bytes, png_take, png_flushed);
                      png_set_IHDR(png, info, static_cast<png_uint_32>(width),
                                   static_cast<png_uint_32>(height), 8, PNG_COLOR_TYPE_RGB,
                                   PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
                      png_set_sRGB_gAMA_and_cHRM(png, info, PNG_sRGB_INTENT_PERCEPTUAL);
                      png_write_info(png, info);
                      png_write_image(png, rows.data());
                      png_write_end(png, info);
                    });
  png_destroy_write_struct(&png, &info);
  if (!done) throw std::runtime_error(bytes.message[0] ? bytes.message : "there is not enough memory");
  return file;
}

}  // namespace lumirank::image
