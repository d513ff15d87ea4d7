#include "image/false_color.h"

#include <cmath>

#include "base/error.h"
#include "base/parallel.h"
#include "base/vec.h"
#include "image/metrics.h"

namespace lumirank::image {
namespace {

// Ottosson 2020, "A perceptual color space for image processing".
Rgb oklab_to_linear(float lightness, float a, float b) {
  const float l = lightness + 0.3963377774f * a + 0.2158037573f * b;
  const float m = lightness - 0.1055613458f * a - 0.0638541728f * b;
  const float s = lightness - 0.0894841775f * a - 1.2914855480f * b;
  const float l3 = l * l * l, m3 = m * m * m, s3 = s * s * s;
  return {4.0767416621f * l3 - 3.3077115913f * m3 + 0.2309699292f * s3,
          -1.2684380046f * l3 + 2.6097574011f * m3 - 0.3413193965f * s3,
          -0.0041960863f * l3 - 0.7034186147f * m3 + 1.7076147010f * s3};
}

}  // namespace

Rgb false_color(float t) {
  if (std::isnan(t)) return {1, 0, 1};
  t = std::clamp(t, 0.0f, 1.0f);
  const float lightness = 0.20f + 0.72f * t;
  const float hue = (285 - 180 * t) * (kPi / 180);
  // A parabola that stays under the largest chroma that sRGB has along this path; teal, in the middle, has
  // least.
  const float chroma = 0.08f * (1 - t) * (1 - t) + 0.12f * t * (1 - t) + 0.155f * t * t;
  const Rgb c = oklab_to_linear(lightness, chroma * std::cos(hue), chroma * std::sin(hue));
  return {std::clamp(c.r, 0.0f, 1.0f), std::clamp(c.g, 0.0f, 1.0f), std::clamp(c.b, 0.0f, 1.0f)};
}

Image color_bar(int width, int height) {
  Image bar(width, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      bar.at(x, y) = false_color((static_cast<float>(x) + 0.5f) / static_cast<float>(width));
  return bar;
}

Image false_color_error(const Image& image, const Image& reference, float full) {
  if (image.width != reference.width || image.height != reference.height)
    throw InputError("a false-color error needs an image and a reference of one size");
  const double total = parallel_sum(reference.pixels.size(), 1 << 14, 0.0, [&](std::size_t b, std::size_t e) {
    double s = 0;
    for (std::size_t i = b; i < e; ++i) s += mean(reference.pixels[i]);
    return s;
  });
  const double scale = total > 0 ? static_cast<double>(reference.pixels.size()) / (total * full) : 0;
  Image out(image.width, image.height);
  parallel_for(image.pixels.size(), 1 << 14, [&](std::size_t b, std::size_t e) {
    for (std::size_t i = b; i < e; ++i) {
      const Rgb d = image.pixels[i] - reference.pixels[i];
      const float difference = (std::abs(d.r) + std::abs(d.g) + std::abs(d.b)) / 3;
      out.pixels[i] = false_color(scale > 0 ? static_cast<float>(difference * scale)
                                            : (difference == 0  ? 0.0f
                                               : difference > 0 ? 1.0f
                                                                : difference));
    }
  });
  return out;
}

}  // namespace lumirank::image
