// A place on a flight through a medium at which it is made to collide, for who asks what the place would
// send somewhere else: no flight is in vain, however thin the medium.
//
// Places are drawn as those of a flight's first collision, given that there is one, with one channel of the
// medium chosen for each and the density over all three. Where a medium is a grid the density takes the
// middle of its bounds for its extinction, cell by cell. (Lux, Koblinger, "Monte Carlo Particle Transport
// Methods: Neutron and Photon Calculations", 1991, on forced collisions.)
#pragma once

#include "base/equiangular.h"
#include "media/medium.h"

namespace lumirank::media {

// From `origin` along unit `direction` to t_max, which may be infinite. pdf 0: nothing to collide with.
RayPlace force_collision(const Medium& medium, Vec3f origin, Vec3f direction, float t_max, float u_channel,
                         float u);

}  // namespace lumirank::media
