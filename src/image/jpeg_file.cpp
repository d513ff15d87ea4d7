#include "image/jpeg_file.h"

#include <algorithm>
#include <csetjmp>
#include <cstdio>  // jpeglib.h needs it before itself
#include <stdexcept>
#include <vector>

#include <jpeglib.h>

namespace lumirank::image {
namespace {

// libjpeg leaves a failed call by longjmp, over frames that must own nothing: those of libjpeg and of the
// small function objects given to `jpeg_step`.
struct JpegErrors {
  jpeg_error_mgr base;
  std::jmp_buf back;
  char message[JMSG_LENGTH_MAX];
};

[[noreturn]] void jpeg_failed(j_common_ptr info) {
  auto* errors = reinterpret_cast<JpegErrors*>(info->err);
  (*info->err->format_message)(info, errors->message);
  std::longjmp(errors->back, 1);
}

void jpeg_warned(j_common_ptr) {}

// Every scan of a progressive file costs a pass over all its pixels, and a scan may be a few bytes long.
// Real files have about ten.
void limit_scans(j_common_ptr info) {
  constexpr int kMaxScans = 500;
  if (!info->is_decompressor || reinterpret_cast<j_decompress_ptr>(info)->input_scan_number <= kMaxScans)
    return;
  auto* errors = reinterpret_cast<JpegErrors*>(info->err);
  std::snprintf(errors->message, sizeof errors->message, "it has more than %d scans", kMaxScans);
  std::longjmp(errors->back, 1);
}

template <typename Step>
[[gnu::noinline]] bool jpeg_step(JpegErrors& errors, const Step& step) {
  if (setjmp(errors.back) != 0) return false;
  step();
  return true;
}

// Four inks as Adobe's programs store them, 255 standing for none, to colors.
void inks_to_colors(const unsigned char* inks, std::size_t pixels, unsigned char* colors) {
  for (std::size_t i = 0; i < pixels; ++i) {
    const float paper = static_cast<float>(inks[4 * i + 3]) * (1 / 255.0f);
    for (std::size_t c = 0; c < 3; ++c) {
      const float v = static_cast<float>(inks[4 * i + c]) * (1 / 255.0f) * paper;
      colors[3 * i + c] = static_cast<unsigned char>(v * 255 + 0.5f);
    }
  }
}

class JpegReader {
 public:
  explicit JpegReader(std::string_view bytes) {
    info_.err = jpeg_std_error(&errors_.base);
    errors_.base.error_exit = jpeg_failed;
    errors_.base.output_message = jpeg_warned;
    progress_.progress_monitor = limit_scans;
    const auto* data = reinterpret_cast<const unsigned char*>(bytes.data());
    const auto size = static_cast<unsigned long>(bytes.size());
    attempt([&] {
      jpeg_create_decompress(&info_);
      info_.progress = &progress_;
      jpeg_mem_src(&info_, data, size);
    });
  }
  ~JpegReader() { jpeg_destroy_decompress(&info_); }
  JpegReader(const JpegReader&) = delete;
  JpegReader& operator=(const JpegReader&) = delete;

  void read(PixelSink& sink) {
    attempt([this] { jpeg_read_header(&info_, TRUE); });
    const bool inks = info_.jpeg_color_space == JCS_CMYK || info_.jpeg_color_space == JCS_YCCK;
    if (inks) info_.out_color_space = JCS_CMYK;
    const int stored = info_.num_components, channels = inks ? 3 : stored;
    if (channels != 1 && channels != 3)
      throw std::runtime_error("it has " + std::to_string(stored) + " channels of a kind that is unknown");
    const PixelLayout layout =
        usual_layout(static_cast<int>(info_.image_width), static_cast<int>(info_.image_height), channels);
    sink.begin(layout);
    attempt([this] { jpeg_start_decompress(&info_); });
    if (info_.output_components != stored) throw std::runtime_error("its header is damaged");

    const auto width = static_cast<std::size_t>(layout.width);
    const int strip = strip_rows(layout);
    std::vector<unsigned char> pixels(width * static_cast<std::size_t>(stored * strip)), colors;
    for (int y = 0; y < layout.height; y += strip) {
      const int count = std::min(strip, layout.height - y);
      attempt([&] {
        for (int r = 0; r < count;) {
          JSAMPROW row = pixels.data() + static_cast<std::size_t>(r * stored) * width;
          r += static_cast<int>(jpeg_read_scanlines(&info_, &row, 1));
        }
      });
      const std::size_t n = width * static_cast<std::size_t>(count);
      if (inks) {
        colors.resize(3 * n);
        inks_to_colors(pixels.data(), n, colors.data());
      }
      sink.add(inks ? colors.data() : pixels.data(), n);
    }
  }

 private:
  template <typename Step>
  void attempt(const Step& step) {
    if (!jpeg_step(errors_, step)) throw std::runtime_error(errors_.message);
  }

  jpeg_decompress_struct info_{};
  jpeg_progress_mgr progress_{};
  JpegErrors errors_{};
};

}  // namespace

void read_jpeg(std::string_view bytes, PixelSink& sink) { JpegReader(bytes).read(sink); }

}  // namespace lumirank::image
