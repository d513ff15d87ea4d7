// Tables behind interface.h: rough dielectric interfaces, integrated numerically once per distribution.
#pragma once

#include <vector>

#include "scatter/interface.h"

namespace lumirank::scatter {

// As InterfaceCoefficients::left and diffuse_left, of a perfect mirror's microfacets; the terms are those of
// an interface of kMaskedEta.
struct MaskedCoefficients {
  float left[6] = {};
  float diffuse_left = 0;
};
inline constexpr float kMaskedEta = 1.5f;

class InterfaceTable {
 public:
  explicit InterfaceTable(NormalDistribution distribution);
  // Bilinear in √alpha and log(eta); alpha is held within [0, 1], eta within [1/3, 3].
  InterfaceCoefficients lookup(float alpha, float eta) const;
  // Linear in √alpha.
  MaskedCoefficients masked(float alpha) const;

 private:
  static constexpr int kAlphas = 17, kEtas = 25;
  static constexpr double kLogRange = 1.0986122886681098;  // ln 3
  std::vector<InterfaceCoefficients> cells_;               // alpha-major
  std::vector<MaskedCoefficients> masked_;                 // one for each alpha
};

// Built at first use.
const InterfaceTable& interface_table(NormalDistribution distribution);

// Directional transmittance and reflectance at one cosine: means over visible normals of (1 -
// F)·G1(refracted) and F·G1(reflected), by a fixed rule of `side`² points. For the table and the tests.
struct InterfaceMeans {
  double transmittance = 0, reflectance = 0;
};
InterfaceMeans interface_means(NormalDistribution distribution, float alpha, float eta, float cos_theta,
                               int side);

}  // namespace lumirank::scatter
