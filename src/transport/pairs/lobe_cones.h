// The sharpest lobe of a closure, as far as spherical lights must know it: how wide it is, and slopes of half
// vectors that follow it.
#pragma once

#include <span>
#include <vector>

#include "base/lanes.h"
#include "scatter/closure_pool.h"
#include "scatter/lobe.h"

namespace lumirank::transport {

struct LobeCone {
  float per_solid_angle = 0;           // 1/Ω of the sharpest lobe; 0: all are broad
  float cos_reach = 1, sin_reach = 0;  // of the angle beyond which the lobes are all but black
  float alpha_u = 1, alpha_v = 1;      // of the sharpest lobe; 1 if broad
};
LobeCone lobe_cone(std::span<const scatter::Lobe> lobes);

// Of each recipe of a pool.
std::vector<LobeCone> lobe_cones(const scatter::ClosurePool& pool);

// Of 16 closures, about their mirror directions.
struct LobeCones {
  Lane3 axis;
  Lane per_solid_angle, cos_reach, sin_reach, alpha_u, alpha_v;
};

}  // namespace lumirank::transport
