// Roulette over the lights that particles leave: which are kept, and which paths go on in parts, so that
// single lights neither shine out among the others nor are many of them for nothing.
#pragma once

#include "transport/lights/light_importance.h"
#include "transport/lights/light_record.h"

namespace lumirank::transport {

// Russian roulette by expected contribution, as I. Georgiev and P. Slusallek, "Simple and Robust Iterative
// Importance Sampling of Virtual Point Lights" (2010): a light of less use than `level` is kept with the
// probability use / level, and stronger in return. A path that leaves a light of more use is split, so that
// the lights that it leaves next are not as heavy.
class LightRoulette {
 public:
  // `level` 0: all lights are kept, and no path is split. `importance` is not owned.
  LightRoulette(const LightImportance& importance, double level) : importance_(importance), level_(level) {}

  // What the light contributes to receivers, roughly. Levels are in terms of this times the number of paths.
  double use(const LightRecord& light, bool lambertian) const {
    return static_cast<double>(max_component(light.power)) * rough_reflectance(light, lambertian) *
           importance_.at(light.position, light.normal);
  }
  // Probability.
  double keep(double use) const { return use < level_ && use > 0 ? use / level_ : 1.0; }
  int parts(double use) const {
    if (!(level_ > 0) || use <= level_) return 1;
    return use < kMaxParts * level_ ? static_cast<int>(use / level_) + 1 : kMaxParts;
  }

 private:
  static constexpr int kMaxParts = 32;

  const LightImportance& importance_;
  double level_;
};

}  // namespace lumirank::transport
