#include "world/equal_area.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/parallel.h"

namespace lumirank::world {

namespace {
constexpr int kParts = 6;  // each texel is the mean over kParts² of its points
}  // namespace

Vec2f sphere_to_square(Vec3f d) {
  const float x = std::abs(d.x), y = std::abs(d.y), z = std::abs(d.z);
  const float r = std::sqrt(std::max(1 - z, 0.0f));
  float phi = x == 0 && y == 0 ? 0 : std::atan2(y, x) * (2 / kPi);
  float v = phi * r, u = r - v;
  if (d.z < 0) {
    std::swap(u, v);
    u = 1 - u, v = 1 - v;
  }
  return {0.5f * (std::copysign(u, d.x) + 1), 0.5f * (std::copysign(v, d.y) + 1)};
}

image::Image to_latitude_longitude(const image::Image& square) {
  const int n = square.width;
  image::Image out(2 * n, n);
  std::vector<double> weights(static_cast<std::size_t>(n));  // of the rows: their solid angles
  parallel_for(static_cast<std::size_t>(n), 4, [&](std::size_t begin, std::size_t end) {
    for (std::size_t row = begin; row < end; ++row) {
      weights[row] =
          std::cos(kPiD * static_cast<double>(row) / n) - std::cos(kPiD * static_cast<double>(row + 1) / n);
      for (int column = 0; column < 2 * n; ++column) {
        Rgb sum;
        for (int i = 0; i < kParts * kParts; ++i) {
          const double u = (column + (i % kParts + 0.5) / kParts) / (2.0 * n);
          const double v = (static_cast<double>(row) + (i / kParts + 0.5) / kParts) / n;
          const double s = std::sin(v * kPiD);
          const Vec2f at = sphere_to_square({static_cast<float>(s * std::cos(2 * kPiD * u)),
                                             static_cast<float>(s * std::sin(2 * kPiD * u)),
                                             static_cast<float>(std::cos(v * kPiD))});
          const int px = std::clamp(static_cast<int>(at.x * static_cast<float>(n)), 0, n - 1);
          const int py = std::clamp(static_cast<int>(at.y * static_cast<float>(n)), 0, n - 1);
          sum += square.pixels[static_cast<std::size_t>(py) * static_cast<std::size_t>(n) +
                               static_cast<std::size_t>(px)];
        }
        out.pixels[row * 2 * static_cast<std::size_t>(n) + static_cast<std::size_t>(column)] =
            sum / (kParts * kParts);
      }
    }
  });
  // Small suns are hit by more or fewer of the points than they should be.
  for (int k = 0; k < 3; ++k) {
    double want = 0, have = 0;
    for (const Rgb& c : square.pixels) want += c[k];
    for (std::size_t i = 0; i < out.pixels.size(); ++i)
      have += out.pixels[i][k] * weights[i / (2 * static_cast<std::size_t>(n))];
    want /= static_cast<double>(n) * n, have /= 4.0 * n;
    if (!(want > 0 && have > 0)) continue;
    for (Rgb& c : out.pixels) c[k] *= static_cast<float>(want / have);
  }
  return out;
}

double illuminance_of_pole(const image::Image& map) {
  double sum = 0;
  const double step = kPiD / map.height;
  for (int row = 0; row < map.height; ++row) {
    const double top = std::min(row * step, kPiD / 2), bottom = std::min((row + 1) * step, kPiD / 2);
    // ∫ cosθ sinθ dθ over the part of the row above the horizon.
    const double weight = 0.5 * (std::sin(bottom) * std::sin(bottom) - std::sin(top) * std::sin(top));
    for (int column = 0; column < map.width; ++column)
      sum +=
          weight * luminance(map.pixels[static_cast<std::size_t>(row) * static_cast<std::size_t>(map.width) +
                                        static_cast<std::size_t>(column)]);
  }
  return sum * 2 * kPiD / map.width;
}

}  // namespace lumirank::world
