#include "film/filter_sampler.h"

#include <cmath>

namespace lumirank::film {
namespace {
constexpr int kBins = 1024;
float bin_center(const Filter& filter, int k) {
  return filter.radius * (2 * (static_cast<float>(k) + 0.5f) / kBins - 1);
}
}  // namespace

FilterSampler::FilterSampler(const Filter& filter) : filter_(filter) {
  std::vector<float> magnitude(kBins);
  double integral = 0, absolute = 0;
  for (int k = 0; k < kBins; ++k) {
    const float f = filter.eval(bin_center(filter, k));
    negative_.push_back(std::signbit(f));
    magnitude[static_cast<std::size_t>(k)] = std::abs(f);
    integral += f, absolute += std::abs(f);
  }
  table_ = Distribution1D(magnitude, 1);
  scale_ = absolute / integral;
  integral_ = integral * 2 * static_cast<double>(filter.radius) / kBins;
}

FilterSampler::Axis FilterSampler::axis(float u) const {
  const auto s = table_.sample(u);
  const float sign = negative_[s.index] ? -1.0f : 1.0f;
  const float t = (static_cast<float>(s.index) + s.remapped) / kBins;
  return {filter_.radius * (2 * t - 1), sign * static_cast<float>(scale_)};
}

FilterSampler::Sample FilterSampler::sample(Vec2f u) const {
  if (filter_.kind == FilterKind::box)
    return {{filter_.radius * (2 * u.x - 1), filter_.radius * (2 * u.y - 1)}, 1};
  const Axis x = axis(u.x), y = axis(u.y);
  return {{x.offset, y.offset}, x.weight * y.weight};
}

FilterSampler::AxisPixel FilterSampler::axis_pixel(float film, float u) const {
  const int own = static_cast<int>(std::floor(film));
  if (filter_.kind == FilterKind::box && filter_.radius == 0.5f) return {own, 1};
  const auto value = [&](int pixel) { return filter_.eval(film - (static_cast<float>(pixel) + 0.5f)); };
  const int reach = filter_.reach();
  float sum = 0;
  for (int p = own - reach; p <= own + reach; ++p) sum += std::abs(value(p));
  float left = u * sum;
  AxisPixel drawn{own, 0};
  for (int p = own - reach; p <= own + reach; ++p) {
    const float v = value(p);
    if (v == 0) continue;
    drawn = {p, std::copysign(sum, v) / static_cast<float>(integral_)};
    left -= std::abs(v);
    if (left < 0) break;
  }
  return drawn;
}

FilterSampler::Pixel FilterSampler::pixel(Vec2f film, Vec2f u) const {
  const AxisPixel x = axis_pixel(film.x, u.x), y = axis_pixel(film.y, u.y);
  return {{x.at, y.at}, x.weight * y.weight};
}

}  // namespace lumirank::film
