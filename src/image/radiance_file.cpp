#include "image/radiance_file.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <vector>

namespace lumirank::image {
namespace {

using Rgbe = std::array<unsigned char, 4>;

// How the pixels follow each other: along a scanline the `fast` axis, x (0) or y (1); `reversed` tells
// whether x goes to the left and y upwards.
struct RadianceSize {
  std::array<int, 2> size{0, 0};
  int fast = 0;
  std::array<bool, 2> reversed{false, false};
};

class RadianceBytes {
 public:
  explicit RadianceBytes(std::string_view bytes) : rest_(bytes) {}

  std::string_view line() {
    const std::size_t end = rest_.find('\n');
    if (end == std::string_view::npos) throw std::runtime_error("its header has no end");
    std::string_view line = rest_.substr(0, end);
    rest_.remove_prefix(end + 1);
    while (!line.empty() && (line.back() == '\r' || line.back() == ' ')) line.remove_suffix(1);
    return line;
  }
  unsigned char byte() {
    if (rest_.empty()) throw std::runtime_error("it is truncated");
    const auto value = static_cast<unsigned char>(rest_.front());
    rest_.remove_prefix(1);
    return value;
  }
  Rgbe pixel() {
    const std::string_view four = peek();
    rest_.remove_prefix(4);
    return {static_cast<unsigned char>(four[0]), static_cast<unsigned char>(four[1]),
            static_cast<unsigned char>(four[2]), static_cast<unsigned char>(four[3])};
  }
  // Whether the next scanline says that its components lie apart, in runs.
  bool starts_components() const {
    const std::string_view four = peek();
    return four[0] == 2 && four[1] == 2 && static_cast<unsigned char>(four[2]) < 128;
  }
  std::size_t left() const { return rest_.size(); }

 private:
  std::string_view peek() const {
    if (rest_.size() < 4) throw std::runtime_error("it is truncated");
    return rest_.substr(0, 4);
  }
  std::string_view rest_;
};

// "-Y 480 +X 640": 480 scanlines from the top, each of 640 pixels from the left.
std::optional<RadianceSize> parse_radiance_size(std::string_view line) {
  RadianceSize size;
  const auto take_axis = [&]() -> int {
    while (line.starts_with(' ')) line.remove_prefix(1);
    if (line.size() < 4 || (line[0] != '-' && line[0] != '+') || (line[1] != 'X' && line[1] != 'Y') ||
        line[2] != ' ')
      return -1;
    const std::size_t axis = line[1] == 'X' ? 0 : 1;
    size.reversed[axis] = line[0] == (axis == 0 ? '-' : '+');
    line.remove_prefix(3);
    while (line.starts_with(' ')) line.remove_prefix(1);
    const auto [end, error] = std::from_chars(line.data(), line.data() + line.size(), size.size[axis]);
    if (error != std::errc()) return -1;
    line.remove_prefix(static_cast<std::size_t>(end - line.data()));
    return static_cast<int>(axis);
  };
  const int slow = take_axis();
  size.fast = take_axis();
  if (slow < 0 || size.fast < 0 || slow == size.fast || !line.empty()) return std::nullopt;
  return size;
}

RadianceSize read_radiance_header(RadianceBytes& in) {
  if (!in.line().starts_with("#?")) throw std::runtime_error("it is not a Radiance file");
  bool colors = false;
  for (std::string_view line = in.line(); !line.empty(); line = in.line()) {
    if (!line.starts_with("FORMAT=")) continue;
    if (line != "FORMAT=32-bit_rle_rgbe")
      throw std::runtime_error("its pixels are not of the kind 32-bit_rle_rgbe (" + std::string(line) + ")");
    colors = true;
  }
  if (!colors) throw std::runtime_error("its header does not name its format");
  const auto size = parse_radiance_size(in.line());
  if (!size) throw std::runtime_error("its header does not state its size");
  return *size;
}

// Reds, greens, blues and exponents, one after the other: runs of one value (above 128: so many more) and
// stretches of different ones.
void read_component_runs(RadianceBytes& in, std::vector<Rgbe>& line) {
  const Rgbe head = in.pixel();
  if (static_cast<std::size_t>(head[2] * 256 + head[3]) != line.size())
    throw std::runtime_error("a scanline has another length than the picture");
  for (std::size_t c = 0; c < 4; ++c)
    for (std::size_t x = 0; x < line.size();) {
      const unsigned char code = in.byte();
      const std::size_t count = code > 128 ? code - 128u : code;
      if (count == 0 || count > line.size() - x) throw std::runtime_error("a scanline is damaged");
      unsigned char value = code > 128 ? in.byte() : 0;
      for (std::size_t k = 0; k < count; ++k) line[x++][c] = code > 128 ? value : in.byte();
    }
}

// Whole pixels; three mantissas of 1, which no normalized color has, repeat the one before. Several of them
// in a row are the digits of a count, the lowest first.
void read_pixels_in_a_row(RadianceBytes& in, std::vector<Rgbe>& line) {
  std::size_t shift = 0;
  for (std::size_t x = 0; x < line.size();) {
    const Rgbe p = in.pixel();
    if (p[0] != 1 || p[1] != 1 || p[2] != 1) {
      line[x++] = p;
      shift = 0;
      continue;
    }
    if (x == 0 || shift > 24) throw std::runtime_error("a scanline is damaged");
    const std::size_t count = static_cast<std::size_t>(p[3]) << shift;
    if (count > line.size() - x) throw std::runtime_error("a scanline is damaged");
    std::fill_n(line.begin() + static_cast<std::ptrdiff_t>(x), count, line[x - 1]);
    x += count, shift += 8;
  }
}

class RadianceReader {
 public:
  explicit RadianceReader(std::string_view bytes) : in_(bytes), size_(read_radiance_header(in_)) {
    for (int e = 1; e < 256; ++e) unit_[static_cast<std::size_t>(e)] = std::ldexp(1.0f, e - 136);
  }

  void read(PixelSink& sink) {
    PixelLayout layout = usual_layout(size_.size[0], size_.size[1], 3);
    layout.encoded = false;
    sink.begin(layout);
    const std::array<std::size_t, 2> size{static_cast<std::size_t>(size_.size[0]),
                                          static_cast<std::size_t>(size_.size[1])};
    const auto fast = static_cast<std::size_t>(size_.fast);
    if (in_.left() / 4 < size[1 - fast])
      throw std::runtime_error("its header promises more than the file holds");
    line_.resize(size[fast]);
    if (fast == 0 && !size_.reversed[0] && !size_.reversed[1]) {
      std::vector<float> colors(3 * size[0]);
      for (std::size_t y = 0; y < size[1]; ++y) {
        next_line();
        for (std::size_t x = 0; x < size[0]; ++x) decode(line_[x], &colors[3 * x]);
        sink.add(colors.data(), size[0]);
      }
      return;
    }
    std::vector<Rgbe> stored;
    for (std::size_t k = 0; k < size[1 - fast]; ++k) {
      next_line();
      stored.insert(stored.end(), line_.begin(), line_.end());
    }
    std::vector<float> colors(3 * size[0]);
    for (std::size_t y = 0; y < size[1]; ++y) {
      for (std::size_t x = 0; x < size[0]; ++x) {
        const std::array<std::size_t, 2> at{size_.reversed[0] ? size[0] - 1 - x : x,
                                            size_.reversed[1] ? size[1] - 1 - y : y};
        decode(stored[at[1 - fast] * size[fast] + at[fast]], &colors[3 * x]);
      }
      sink.add(colors.data(), size[0]);
    }
  }

 private:
  void next_line() {
    // Only lengths that fit into two bytes come in components.
    if (line_.size() >= 8 && line_.size() <= 0x7fff && in_.starts_components()) {
      read_component_runs(in_, line_);
    } else {
      read_pixels_in_a_row(in_, line_);
    }
  }
  void decode(const Rgbe& p, float* color) const {
    for (std::size_t c = 0; c < 3; ++c) color[c] = static_cast<float>(p[c]) * unit_[p[3]];
  }

  RadianceBytes in_;
  const RadianceSize size_;
  std::array<float, 256> unit_{};  // of a mantissa, by the exponent; 0 for black
  std::vector<Rgbe> line_;
};

}  // namespace

void read_radiance(std::string_view bytes, PixelSink& sink) { RadianceReader(bytes).read(sink); }

}  // namespace lumirank::image
