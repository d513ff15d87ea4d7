// Guide to where particles start, when it is known where their light is wanted. In an interior lit through
// its windows nearly all particles of the sky end on the outer walls, where nobody sees them. The unit
// hypercube of the numbers that decide a particle's start (emitter, position, direction) is cut into boxes,
// each drawn in proportion to what pilot paths from it brought to the receivers; every path is divided by its
// density, so the result is unbiased whatever the guide says.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "base/random.h"

namespace lumirank::transport {

// Emitter, position (2), direction (2).
inline constexpr int kStartDimensions = 5;

class EmissionGuide {
 public:
  EmissionGuide();  // uniform

  struct Start {
    double emitter;  // in [0, 1)
    float rest[kStartDimensions - 1];
    double density;
  };
  // `u` in [0, 1), stratified over paths, chooses the box and the emitter in it; `index` the point of an
  // evenly spread sequence for the rest.
  Start draw(double u, std::uint64_t index, std::uint64_t seed, Stage stage) const;

  struct Observation {
    std::array<float, kStartDimensions> at;
    float value = 0;  // importance of the path, over the density with which it was drawn
    float density = 1;
  };
  // How the observations came about: drawn with the densities that they tell, or spread like importance
  // itself (then their densities are not used, and boxes are drawn by the importance that they hold).
  enum class Spread : std::uint8_t { by_density, by_importance };
  // Boxes are halved where much of the importance is found, along the axis whose halves differ most.
  static EmissionGuide fit(std::span<const Observation> observations, Spread spread = Spread::by_density);

  std::size_t boxes() const { return boxes_.size(); }

 private:
  struct Box {
    std::array<float, kStartDimensions> lo, size;  // powers of two: exact
    double volume() const;
  };
  struct Node;
  std::vector<Box> boxes_;
  std::vector<double> cdf_;  // of the boxes, and 1 at the end
};

}  // namespace lumirank::transport
