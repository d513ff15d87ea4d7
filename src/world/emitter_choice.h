// Choice of the emitter that a particle, a sample or a light path starts from.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "world/world.h"

namespace lumirank::world {

// Emitters by power, with two floors. Infinitely far light is measured over the disc that covers the whole
// scene, of which an interior sees little through its windows; so neither the far nor the near emitters get
// less than a quarter of all samples. And a tenth is spread evenly, so that a faint lamp in its own room is
// not left without.
class EmitterChoice {
 public:
  explicit EmitterChoice(const World& world);

  bool empty() const { return cdf_.empty(); }  // nothing shines
  std::size_t size() const { return emitters_.size(); }
  // The k-th emitter that shines, and its probability.
  int emitter(std::size_t k) const { return emitters_[k]; }
  double probability(std::size_t k) const { return cdf_[k + 1] - cdf_[k]; }

  struct Drawn {
    int emitter;
    double probability;
    float remapped;  // u, stretched again over [0, 1) within the emitter
  };
  Drawn draw(double u) const;

 private:
  std::vector<int> emitters_;
  std::vector<double> cdf_;
};

}  // namespace lumirank::world
