#include "linalg/points.h"

#include <cmath>

#include "base/parallel.h"
#include "linalg/short_float.h"

namespace lumirank::linalg {

float pack_point(std::span<const float> point, std::int16_t* out) {
  const float max_abs = max_abs_of(point);
  // |v| < 2·scale; units below the least normal number would have no inverse.
  const float unit = std::max(scale_for(max_abs) * 0x1p-14f, 0x1p-126f);
  const float inverse = 1 / unit;
  for (std::size_t d = 0; d < point.size(); ++d) {
    const float scaled = point[d] * inverse;
    // Halves are rounded away from 0; the largest may round up to one too many.
    const int rounded = static_cast<int>(scaled + std::copysign(0.5f, scaled));
    out[d] = static_cast<std::int16_t>(std::min(std::max(rounded, -32767), 32767));
  }
  return unit;
}

double dot(std::span<const float> x, const double* y) {
  constexpr std::size_t kParts = 16;
  double parts[kParts] = {};
  std::size_t d = 0;
  for (; d + kParts <= x.size(); d += kParts)
    for (std::size_t k = 0; k < kParts; ++k) parts[k] += static_cast<double>(x[d + k]) * y[d + k];
  for (std::size_t k = 0; d < x.size(); ++d, ++k) parts[k] += static_cast<double>(x[d]) * y[d];
  for (std::size_t width = kParts / 2; width > 0; width /= 2)
    for (std::size_t k = 0; k < width; ++k) parts[k] += parts[k + width];
  return parts[0];
}

std::vector<double> own_norms(const Points& points) {
  std::vector<double> norms(points.count);
  parallel_for(points.count, 4096, [&](std::size_t begin, std::size_t end) {
    PointReader reader(points);
    std::vector<double> copy(points.dimension);
    for (std::size_t j = begin; j < end; ++j) {
      const auto x = reader[j];
      std::copy(x.begin(), x.end(), copy.begin());
      norms[j] = std::sqrt(dot(x, copy.data()));
    }
  });
  return norms;
}

}  // namespace lumirank::linalg
