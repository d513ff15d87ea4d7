// What pbrt's media shine with by their temperature.
#pragma once

#include <vector>

#include "base/rgb.h"
#include "scenedesc/pbrt/params.h"

namespace lumirank::scenedesc::pbrt {

// From the numbers of a file to kelvins: "temperatureoffset" (or "temperaturecutoff", as it was called) and
// "temperaturescale".
struct TemperatureScale {
  explicit TemperatureScale(Params& p);
  float kelvin(float number) const { return (number - offset) * scale; }

  float offset = 0, scale = 1;
};

// The color of black bodies whose spectrum is 1 where it is largest, for every number up to the largest of a
// grid: as for them there may be millions, from a table.
class Glow {
 public:
  Glow(const TemperatureScale& scale, const std::vector<float>& numbers);

  bool is_dark() const { return table_.empty(); }  // all of them are
  Rgb at(float number) const;

 private:
  TemperatureScale scale_;
  float most_ = 0;  // kelvins
  std::vector<Rgb> table_;
};

}  // namespace lumirank::scenedesc::pbrt
