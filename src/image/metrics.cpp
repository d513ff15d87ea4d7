#include "image/metrics.h"

#include <cmath>
#include <limits>

#include "base/error.h"
#include "base/parallel.h"
#include "image/flip.h"
#include "image/on_screen.h"

namespace lumirank::image {
namespace {

constexpr std::size_t kGrain = 1 << 14;

std::size_t count_bad(const Image& image) {
  return parallel_sum(image.pixels.size(), kGrain, std::size_t{0}, [&](std::size_t b, std::size_t e) {
    std::size_t bad = 0;
    for (std::size_t i = b; i < e; ++i) bad += !is_finite(image.pixels[i]);
    return bad;
  });
}

void require_comparable(const Image& image, const Image& reference) {
  const auto size = [](const Image& i) { return std::to_string(i.width) + " x " + std::to_string(i.height); };
  if (image.width != reference.width || image.height != reference.height)
    throw InputError("the image has " + size(image) + " pixels and the reference " + size(reference),
                     "compare images of one size");
  if (image.pixels.empty()) throw InputError("the images have no pixels");
  const std::size_t bad_image = count_bad(image), bad_reference = count_bad(reference);
  if (bad_image + bad_reference > 0)
    throw InputError("NaN or infinite pixels: " + std::to_string(bad_image) + " in the image, " +
                     std::to_string(bad_reference) + " in the reference");
}

struct Sums {
  double absolute = 0, difference = 0, squared = 0, reference = 0, reference_squared = 0;
  friend Sums operator+(const Sums& a, const Sums& b) {
    return {a.absolute + b.absolute, a.difference + b.difference, a.squared + b.squared,
            a.reference + b.reference, a.reference_squared + b.reference_squared};
  }
};

// A black reference leaves a relative error of 0 for a black image and no bound for any other.
double ratio(double numerator, double denominator) {
  if (denominator != 0) return numerator / denominator;
  return numerator == 0 ? 0 : std::copysign(std::numeric_limits<double>::infinity(), numerator);
}

}  // namespace

PictureError compare(const Image& image, const Image& reference) {
  require_comparable(image, reference);
  const std::size_t pixels = image.pixels.size();
  const double values = 3.0 * static_cast<double>(pixels);
  const Sums sums = parallel_sum(pixels, kGrain, Sums{}, [&](std::size_t b, std::size_t e) {
    Sums s;
    for (std::size_t i = b; i < e; ++i)
      for (int c = 0; c < 3; ++c) {
        const double r = reference.pixels[i][c], d = image.pixels[i][c] - r;
        s.absolute += std::abs(d), s.difference += d, s.squared += d * d;
        s.reference += r, s.reference_squared += r * r;
      }
    return s;
  });
  const double mean = sums.reference / values, floor = 1e-4 * mean * mean;
  const double relmse = parallel_sum(pixels, kGrain, 0.0, [&](std::size_t b, std::size_t e) {
    double s = 0;
    for (std::size_t i = b; i < e; ++i)
      for (int c = 0; c < 3; ++c) {
        const double r = reference.pixels[i][c], d = image.pixels[i][c] - r;
        s += ratio(d * d, r * r + floor);
      }
    return s;
  });
  PictureError m;
  m.relative_l1 = ratio(sums.absolute, sums.reference);
  m.relative_l2 = ratio(std::sqrt(sums.squared), std::sqrt(sums.reference_squared));
  m.rmse = std::sqrt(sums.squared / values);
  m.relmse = relmse / values;
  m.bias = ratio(sums.difference, sums.reference);
  const double exposure = exposure_for(reference);
  m.flip = flip_error(on_screen(image, exposure), on_screen(reference, exposure));
  return m;
}

}  // namespace lumirank::image
