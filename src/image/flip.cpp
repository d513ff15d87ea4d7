#include "image/flip.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "base/error.h"
#include "base/parallel.h"

namespace lumirank::image {
namespace {

using Color = std::array<float, 3>;

// Linear sRGB and CIE XYZ under D65, as shares of white's XYZ.
Color xyz_over_white(float r, float g, float b) {
  return {(0.4124564f * r + 0.3575761f * g + 0.1804375f * b) / 0.9504700f,
          0.2126729f * r + 0.7151522f * g + 0.0721750f * b,
          (0.0193339f * r + 0.1191920f * g + 0.9503041f * b) / 1.0888300f};
}

Color rgb_of(const Color& over_white) {
  const float x = 0.9504700f * over_white[0], y = over_white[1], z = 1.0888300f * over_white[2];
  return {3.2404542f * x - 1.5371385f * y - 0.4985314f * z, -0.9692660f * x + 1.8760108f * y + 0.0415560f * z,
          0.0556434f * x - 0.2040259f * y + 1.0572252f * z};
}

// The paper's YyCxCz: what L*a*b* is, without its cube root, so that filters act on light.
Color to_opponent(Rgb c) {
  const auto clamped = [](float v) { return std::clamp(v, 0.0f, 1.0f); };
  const auto [x, y, z] = xyz_over_white(clamped(c.r), clamped(c.g), clamped(c.b));
  return {116 * y - 16, 500 * (x - y), 200 * (y - z)};
}

Color to_rgb(const Color& opponent) {
  const float y = (opponent[0] + 16) / 116;
  return rgb_of({y + opponent[1] / 500, y, y - opponent[2] / 200});
}

// L*a*b* of a color in [0, 1], with a* and b* fading in the dark (Hunt's effect).
Color perceived(const Color& rgb) {
  const auto response = [](float t) {
    constexpr float delta = 6.0f / 29;
    return t > delta * delta * delta ? std::cbrt(t) : t / (3 * delta * delta) + 4.0f / 29;
  };
  const auto [x, y, z] = xyz_over_white(rgb[0], rgb[1], rgb[2]);
  const float lightness = 116 * response(y) - 16, hunt = 0.01f * lightness;
  return {lightness, 500 * hunt * (response(x) - response(y)), 200 * hunt * (response(y) - response(z))};
}

float length(float x, float y) { return std::sqrt(x * x + y * y); }

// HyAB, the distance for large differences of color, to the paper's power q_c.
float color_distance(const Color& a, const Color& b) {
  const float hyab = std::abs(a[0] - b[0]) + length(a[1] - b[1], a[2] - b[2]);
  return std::pow(hyab, 0.7f);
}

// To [0, 1]: differences up to 0.4 of the largest possible take the lower 0.95, the rest is squeezed.
float color_error(float distance) {
  static const float largest = color_distance(perceived({0, 1, 0}), perceived({0, 0, 1}));
  constexpr float share = 0.4f, takes = 0.95f;
  const float knee = share * largest;
  if (distance < knee) return takes / knee * distance;
  return std::min(1.0f, takes + (distance - knee) / (largest - knee) * (1 - takes));
}

using Taps = std::vector<float>;  // of a filter along one axis, 2·radius + 1

// All filters of one viewing distance. Those for colors are the eye's contrast sensitivity, sums of
// Gaussians; those for features the first and second derivative of a Gaussian. All are products of filters
// along the axes or sums of such products.
struct FlipFilters {
  static constexpr double kPiSquared = std::numbers::pi * std::numbers::pi;

  explicit FlipFilters(double pixels_per_degree) {
    // Of the widest Gaussian three standard deviations, for all of them.
    const int color_radius =
        static_cast<int>(std::ceil(3 * std::sqrt(kWidest / (2 * kPiSquared)) * pixels_per_degree));
    const double deviation = 0.5 * 0.082 * pixels_per_degree;
    const int feature_radius = static_cast<int>(std::ceil(3 * deviation));
    radius = std::max(color_radius, feature_radius);

    const auto gaussian = [&](int within, double exponent) {
      std::vector<double> taps(static_cast<std::size_t>(2 * radius + 1), 0.0);
      for (int k = -within; k <= within; ++k)
        taps[static_cast<std::size_t>(radius + k)] = std::exp(-exponent * k * k);
      return taps;
    };
    const auto of_width = [&](double b) {
      return gaussian(color_radius, kPiSquared / (b * pixels_per_degree * pixels_per_degree));
    };
    achromatic = scaled(of_width(0.0047), 1 / sum(of_width(0.0047)));
    red_green = scaled(of_width(0.0053), 1 / sum(of_width(0.0053)));
    const std::vector<double> wide = of_width(kWidest), narrow = of_width(0.025);
    const double wide_weight = 34.1 * std::sqrt(std::numbers::pi / kWidest),
                 narrow_weight = 13.5 * std::sqrt(std::numbers::pi / 0.025);
    const double total =
        wide_weight * sum(wide) * sum(wide) + narrow_weight * sum(narrow) * sum(narrow);  // over the plane
    blue_yellow = {scaled(wide, std::sqrt(wide_weight / total)),
                   scaled(narrow, std::sqrt(narrow_weight / total))};

    const std::vector<double> g = gaussian(feature_radius, 0.5 / (deviation * deviation));
    std::vector<double> first = g, second = g;
    for (int k = -radius; k <= radius; ++k) {
      first[static_cast<std::size_t>(radius + k)] *= -k;
      second[static_cast<std::size_t>(radius + k)] *= k * k / (deviation * deviation) - 1;
    }
    smooth = scaled(g, 1 / sum(g));
    edge = balanced(first), point = balanced(second);
  }

  int radius = 0;
  Taps achromatic, red_green;
  std::array<Taps, 2> blue_yellow;
  Taps smooth, edge, point;

 private:
  static constexpr double kWidest = 0.04;

  static double sum(const std::vector<double>& taps) {
    double s = 0;
    for (const double t : taps) s += t;
    return s;
  }
  static Taps scaled(const std::vector<double>& taps, double scale) {
    Taps out;
    for (const double t : taps) out.push_back(static_cast<float>(t * scale));
    return out;
  }
  // Positive taps sum to 1 and negative ones to -1: the largest response in [0, 1] is 1.
  static Taps balanced(const std::vector<double>& taps) {
    double positive = 0, negative = 0;
    for (const double t : taps) (t > 0 ? positive : negative) += std::abs(t);
    Taps out;
    for (const double t : taps) out.push_back(static_cast<float>(t / (t > 0 ? positive : negative)));
    return out;
  }
};

struct FlipPlane {
  int width, height;
  std::vector<float> values;
  FlipPlane(int w, int h)
      : width(w), height(h), values(static_cast<std::size_t>(w) * static_cast<std::size_t>(h)) {}
  float* row(int y) { return values.data() + static_cast<std::ptrdiff_t>(y) * width; }
  const float* row(int y) const { return values.data() + static_cast<std::ptrdiff_t>(y) * width; }
};

// Where all taps have a value: the result is smaller by their number less one.
FlipPlane filtered_across(const FlipPlane& from, const Taps& taps) {
  const int n = static_cast<int>(taps.size());
  FlipPlane out(from.width - n + 1, from.height);
  for (int y = 0; y < out.height; ++y)
    for (int k = 0; k < n; ++k) {
      const float tap = taps[static_cast<std::size_t>(k)], *source = from.row(y) + k;
      float* target = out.row(y);
      for (int x = 0; x < out.width; ++x) target[x] += tap * source[x];
    }
  return out;
}

FlipPlane filtered_down(const FlipPlane& from, const Taps& taps) {
  const int n = static_cast<int>(taps.size());
  FlipPlane out(from.width, from.height - n + 1);
  for (int y = 0; y < out.height; ++y)
    for (int k = 0; k < n; ++k) {
      const float tap = taps[static_cast<std::size_t>(k)], *source = from.row(y + k);
      float* target = out.row(y);
      for (int x = 0; x < out.width; ++x) target[x] += tap * source[x];
    }
  return out;
}

FlipPlane filtered(const FlipPlane& from, const Taps& taps) {
  return filtered_down(filtered_across(from, taps), taps);
}

// What the metric knows of some rows of a picture.
struct Seen {
  std::vector<Color> colors;         // as perceived, after the eye's filter
  std::vector<float> edges, points;  // strengths of the features
};

Seen see(const Image& image, int first_row, int end_row, const FlipFilters& filters) {
  // With the surroundings that filters reach, repeated from the border where the picture ends.
  const int radius = filters.radius, rows = end_row - first_row;
  std::array<FlipPlane, 3> opponent{FlipPlane(image.width + 2 * radius, rows + 2 * radius),
                                    FlipPlane(image.width + 2 * radius, rows + 2 * radius),
                                    FlipPlane(image.width + 2 * radius, rows + 2 * radius)};
  for (int y = 0; y < rows + 2 * radius; ++y)
    for (int x = 0; x < image.width + 2 * radius; ++x) {
      const Color c = to_opponent(image.at(std::clamp(x - radius, 0, image.width - 1),
                                           std::clamp(first_row + y - radius, 0, image.height - 1)));
      for (std::size_t k = 0; k < 3; ++k) opponent[k].row(y)[x] = c[k];
    }

  Seen seen;
  const FlipPlane achromatic = filtered(opponent[0], filters.achromatic);
  const FlipPlane red_green = filtered(opponent[1], filters.red_green);
  const FlipPlane wide = filtered(opponent[2], filters.blue_yellow[0]);
  const FlipPlane narrow = filtered(opponent[2], filters.blue_yellow[1]);
  for (std::size_t i = 0; i < achromatic.values.size(); ++i) {
    Color rgb = to_rgb({achromatic.values[i], red_green.values[i], wide.values[i] + narrow.values[i]});
    for (float& v : rgb) v = std::clamp(v, 0.0f, 1.0f);
    seen.colors.push_back(perceived(rgb));
  }

  const FlipPlane smooth_across = filtered_across(opponent[0], filters.smooth);
  const auto strengths = [&](const Taps& derivative) {
    const FlipPlane along_x = filtered_down(filtered_across(opponent[0], derivative), filters.smooth);
    const FlipPlane along_y = filtered_down(smooth_across, derivative);
    std::vector<float> out;
    // Features are of (Y + 16)/116, which is in [0, 1]; derivatives do not see the 16.
    for (std::size_t i = 0; i < along_x.values.size(); ++i)
      out.push_back(length(along_x.values[i], along_y.values[i]) / 116);
    return out;
  };
  seen.edges = strengths(filters.edge), seen.points = strengths(filters.point);
  return seen;
}

}  // namespace

double flip_error(const Image& image, const Image& reference, double pixels_per_degree) {
  if (image.width != reference.width || image.height != reference.height || image.pixels.empty())
    throw InputError("FLIP needs an image and a reference of one size");
  const FlipFilters filters(pixels_per_degree);
  // Bands of rows, so that memory does not grow with the picture's height; each looks `radius` rows beyond
  // itself, and pays little for that where bands are higher.
  const auto band = static_cast<std::size_t>(std::max(32, filters.radius));
  const double total = parallel_sum(
      static_cast<std::size_t>(image.height), band, 0.0, [&](std::size_t begin, std::size_t end) {
        const Seen a = see(image, static_cast<int>(begin), static_cast<int>(end), filters);
        const Seen b = see(reference, static_cast<int>(begin), static_cast<int>(end), filters);
        double sum = 0;
        for (std::size_t i = 0; i < a.colors.size(); ++i) {
          const float color = color_error(color_distance(a.colors[i], b.colors[i]));
          const float feature =
              std::max(std::abs(a.edges[i] - b.edges[i]), std::abs(a.points[i] - b.points[i]));
          // A difference of features raises that of colors: the exponent is 1 without one.
          sum += std::pow(color, 1 - std::sqrt(std::min(1.0f, feature / std::sqrt(2.0f))));
        }
        return sum;
      });
  return total / static_cast<double>(image.pixels.size());
}

}  // namespace lumirank::image
