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
    magnitude[static_cast<std::size_t>(k)] = std::abs(f);
    integral += f, absolute += std::abs(f);
  }
  table_ = Distribution1D(magnitude);
  scale_ = absolute / integral;
}

FilterSampler::Axis FilterSampler::axis(float u) const {
  const auto s = table_.sample(u);
  const float sign = std::copysign(1.0f, filter_.eval(bin_center(filter_, static_cast<int>(s.index))));
  const float t = (static_cast<float>(s.index) + s.remapped) / kBins;
  return {filter_.radius * (2 * t - 1), sign * static_cast<float>(scale_)};
}

FilterSampler::Sample FilterSampler::sample(Vec2f u) const {
  if (filter_.kind == FilterKind::box)
    return {{filter_.radius * (2 * u.x - 1), filter_.radius * (2 * u.y - 1)}, 1};
  const Axis x = axis(u.x), y = axis(u.y);
  return {{x.offset, y.offset}, x.weight * y.weight};
}

}  // namespace lumirank::film
