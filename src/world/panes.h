// Panes: sheets of smooth glass, thin against their size, flat or bent as the walls of vessels and globes
// are. Light that passes them comes out in nearly the direction in which it went in, a little beside; letting
// it go straight on instead costs next to nothing of what is lit, and shadow rays can pass. The eye goes on
// seeing the glass as it is, with its rim.
#pragma once

#include "base/transform.h"
#include "geometry/mesh.h"

namespace lumirank::world {

// Whether all parts of the mesh that hang together, or all of it taken as one (two faces without a rim), are
// plates: two parallel faces that look apart, of about the same size, with nearly all of the area, and apart
// by at most a tenth of the root of that size; or walls of which the same holds place by place, so that a ray
// leaves them by a face that is nearly parallel to the one that it came in by, also where it goes aslant.
bool is_made_of_panes(const geometry::TriangleMesh& mesh, const Transform& to_world);

}  // namespace lumirank::world
