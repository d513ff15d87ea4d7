// A coating by brute force: particles wander between a dielectric interface and the surface under it, both of
// which scatter as their own materials do. What scatter/coating.cpp approximates by a sum of lobes.
#pragma once

#include <vector>

#include "base/rgb.h"
#include "base/vec.h"
#include "scatter/material.h"

namespace lumirank::scatter {

// Energy that leaves, by direction: kRings equal steps of cos², kSectors of azimuth from that of wo.
struct Exits {
  static constexpr int kRings = 8, kSectors = 8;
  std::vector<double> share = std::vector<double>(kRings * kSectors, 0.0);
  double total = 0;

  static std::size_t cell(Vec3f wi, Vec3f wo);
};

// `set`: materials 0 the base, 1 the CoatingMaterial over it. Albedos are those of the red channel.
Exits walk(const MaterialSet& set, Vec3f wo, int particles, std::uint64_t seed);
// The same of the closure.
Exits exits_of_lobes(const MaterialSet& set, Vec3f wo, int particles, std::uint64_t seed);

// Half the sum of |a - b| over the cells: the share of energy that goes elsewhere.
double misplaced(const Exits& a, const Exits& b);

}  // namespace lumirank::scatter
