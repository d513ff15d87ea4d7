#include "image/scale_bar.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "base/parallel.h"
#include "image/false_color.h"

namespace lumirank::image {
namespace {

constexpr int kGlyphWidth = 5, kGlyphHeight = 7;

// Rows from the top; the leftmost pixel is bit 4.
struct Glyph {
  char letter;
  unsigned char rows[kGlyphHeight];
};
constexpr Glyph kGlyphs[] = {
    {'0', {0x0e, 0x11, 0x13, 0x15, 0x19, 0x11, 0x0e}}, {'1', {0x04, 0x0c, 0x04, 0x04, 0x04, 0x04, 0x0e}},
    {'2', {0x0e, 0x11, 0x01, 0x02, 0x04, 0x08, 0x1f}}, {'3', {0x1f, 0x02, 0x04, 0x02, 0x01, 0x11, 0x0e}},
    {'4', {0x02, 0x06, 0x0a, 0x12, 0x1f, 0x02, 0x02}}, {'5', {0x1f, 0x10, 0x1e, 0x01, 0x01, 0x11, 0x0e}},
    {'6', {0x06, 0x08, 0x10, 0x1e, 0x11, 0x11, 0x0e}}, {'7', {0x1f, 0x01, 0x02, 0x04, 0x08, 0x08, 0x08}},
    {'8', {0x0e, 0x11, 0x11, 0x0e, 0x11, 0x11, 0x0e}}, {'9', {0x0e, 0x11, 0x11, 0x0f, 0x01, 0x02, 0x0c}},
    {'.', {0x00, 0x00, 0x00, 0x00, 0x00, 0x0c, 0x0c}}, {'k', {0x10, 0x10, 0x12, 0x14, 0x18, 0x14, 0x12}},
    {'M', {0x11, 0x1b, 0x15, 0x15, 0x11, 0x11, 0x11}}, {'l', {0x0c, 0x04, 0x04, 0x04, 0x04, 0x04, 0x0e}},
    {'u', {0x00, 0x00, 0x11, 0x11, 0x11, 0x13, 0x0d}}, {'x', {0x00, 0x00, 0x11, 0x0a, 0x04, 0x0a, 0x11}},
};

void draw(Image& image, int x, int y, int zoom, const std::string& text) {
  for (const char letter : text) {
    for (const Glyph& glyph : kGlyphs) {
      if (glyph.letter != letter) continue;
      for (int r = 0; r < kGlyphHeight * zoom; ++r)
        for (int c = 0; c < kGlyphWidth * zoom; ++c) {
          const bool set = glyph.rows[r / zoom] >> (kGlyphWidth - 1 - c / zoom) & 1;
          if (set && x + c >= 0 && x + c < image.width && y + r < image.height)
            image.at(x + c, y + r) = Rgb(1);
        }
    }
    x += (kGlyphWidth + 1) * zoom;
  }
}

int text_width(const std::string& text, int zoom) {
  return (static_cast<int>(text.size()) * (kGlyphWidth + 1) - 1) * zoom;
}

std::string number(float value) {
  const char* suffix = "";
  if (value >= 1e6f) {
    value /= 1e6f, suffix = "M";
  } else if (value >= 1e4f) {
    value /= 1e3f, suffix = "k";
  }
  char text[32];
  std::snprintf(text, sizeof text, "%.*f",
                value >= 100  ? 0
                : value >= 10 ? 1
                : value >= 1  ? 2
                              : 3,
                static_cast<double>(value));
  std::string out = text;
  if (out.find('.') != std::string::npos) {
    out.erase(out.find_last_not_of('0') + 1);
    if (out.back() == '.') out.pop_back();
  }
  return out + suffix;
}

}  // namespace

Range round_range(const Image& values) {
  std::vector<float> v;
  for (const Rgb& p : values.pixels)
    if (std::isfinite(p.r)) v.push_back(p.r);
  if (v.empty()) return {};
  const auto place = static_cast<std::ptrdiff_t>(v.size() - 1 - v.size() / 200);
  std::nth_element(v.begin(), v.begin() + place, v.end());
  const float max_value = v[static_cast<std::size_t>(place)];
  if (!(max_value > 0)) return {};
  const double power = std::pow(10.0, std::floor(std::log10(double{max_value})));
  for (const double step : {1.0, 2.0, 3.0, 5.0, 10.0})
    if (max_value <= step * power * (1 + 1e-6)) return {0, static_cast<float>(step * power)};
  return {0, static_cast<float>(10 * power)};
}

Image with_scale(const Image& values, Range range, const std::string& unit) {
  const int zoom = std::max(1, values.width / 400), line = (kGlyphHeight + 4) * zoom;
  Image out(values.width, values.height + 2 * line);
  const float scale = 1 / (range.high - range.low);
  parallel_for(static_cast<std::size_t>(values.height), 16, [&](std::size_t begin, std::size_t end) {
    for (std::size_t y = begin; y < end; ++y)
      for (int x = 0; x < values.width; ++x)
        out.at(x, static_cast<int>(y)) =
            false_color((values.at(x, static_cast<int>(y)).r - range.low) * scale);
  });
  const Image bar = color_bar(values.width, line - 2 * zoom);
  std::copy(bar.pixels.begin(), bar.pixels.end(),
            out.pixels.begin() + static_cast<std::ptrdiff_t>(values.pixels.size()));

  // As many numbers as there is room for, evenly spaced.
  const int steps = values.width >= 240 * zoom ? 5 : values.width >= 120 * zoom ? 2 : 1;
  for (int k = 0; k <= steps; ++k) {
    const float t = static_cast<float>(k) / static_cast<float>(steps);
    const std::string text =
        number(range.low + (range.high - range.low) * t) + (k == steps ? " " + unit : "");
    const int width = text_width(text, zoom),
              tick = static_cast<int>(t * static_cast<float>(values.width - 1));
    const int x = std::clamp(tick - width / 2, zoom, std::max(zoom, values.width - width - zoom));
    draw(out, x, values.height + line + 2 * zoom, zoom, text);
    for (int y = values.height + line - 2 * zoom; y < values.height + line + zoom; ++y)
      out.at(tick, y) = Rgb(1);
  }
  return out;
}

}  // namespace lumirank::image
