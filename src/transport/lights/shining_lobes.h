// With which lobes of its surface an indirect virtual light shines on.
#pragma once

#include "scatter/closure.h"

namespace lumirank::transport {

struct ShiningLobes {
  // The diffuse lobes of the surface alone (Hašan et al. 2009, section 2): the traditional approximation.
  // Lights of surfaces without such a lobe are left out.
  bool diffuse_only = false;
  // Lobes with a roughness below this shine as if they had it: what leaves a sharp one is a spot, and no
  // number of lights that anybody has fills a caustic with those.
  float least_roughness = 0;

  // The same where it is asked where lights are and how strong, not how they shine: how wide an anisotropic
  // lobe is made takes longer than its path.
  ShiningLobes unwidened() const { return {diffuse_only, 0}; }
  // Light arrives from `incoming`.
  scatter::Closure of(const scatter::Closure& whole, Vec3f incoming) const {
    if (diffuse_only) return scatter::broad_part(whole, 1);
    return least_roughness > 0 ? scatter::widened(whole, incoming, least_roughness) : whole;
  }
};

}  // namespace lumirank::transport
