#include "scenedesc/pbrt/glow.h"

#include <algorithm>
#include <cmath>

#include "base/spectrum.h"

namespace lumirank::scenedesc::pbrt {
namespace {

// pbrt takes what is colder for dark.
constexpr float kDark = 100;
// Steps of a few kelvins below 10,000.
constexpr int kSteps = 4096;

Rgb peak_color(float kelvin) {
  // Wien's law: the wavelength of the largest radiance.
  const double peak_nm = 2.897771955e6 / static_cast<double>(kelvin);
  const Rgb out =
      blackbody_to_rgb(kelvin) * static_cast<float>(1 / planck(peak_nm, static_cast<double>(kelvin)));
  return {std::max(out.r, 0.0f), std::max(out.g, 0.0f), std::max(out.b, 0.0f)};
}

}  // namespace

TemperatureScale::TemperatureScale(Params& p)
    : offset(p.number("temperatureoffset", p.number("temperaturecutoff", 0))),
      scale(p.number("temperaturescale", 1)) {}

Glow::Glow(const TemperatureScale& scale, const std::vector<float>& numbers) : scale_(scale) {
  for (const float number : numbers) most_ = std::max(most_, scale_.kelvin(number));
  if (!(most_ > kDark) || !std::isfinite(most_)) return;
  table_.resize(kSteps + 1);
  for (int k = 0; k <= kSteps; ++k)
    table_[static_cast<std::size_t>(k)] =
        peak_color(kDark + (most_ - kDark) * static_cast<float>(k) / static_cast<float>(kSteps));
}

Rgb Glow::at(float number) const {
  const float kelvin = scale_.kelvin(number);
  if (!(kelvin > kDark) || is_dark()) return Rgb(0);
  const float place = std::min((kelvin - kDark) / (most_ - kDark), 1.0f) * static_cast<float>(kSteps);
  const auto k = std::min(static_cast<std::size_t>(place), static_cast<std::size_t>(kSteps - 1));
  return lerp(table_[k], table_[k + 1], place - static_cast<float>(k));
}

}  // namespace lumirank::scenedesc::pbrt
