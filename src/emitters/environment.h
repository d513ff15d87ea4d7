// Making environment emitters.
#pragma once

#include "emitters/emitter.h"

namespace lumirank::emitters {

// A latitude-longitude map with its sampling tables. `radiance` is row-major, width × height, row 0 at the
// local +y pole; its values must be finite and not negative (InternalError otherwise).
EnvironmentEmitter make_environment(int width, int height, std::vector<Rgb> radiance, const Frame& to_world);

// ∫ L dω over the sphere, exact for the interpolated map.
Rgb total_radiance(const EnvironmentEmitter& environment);

// Texel coordinates (u in columns, v in rows, texel centers at ½) of a local direction, and back. u = 0 is
// the local direction -z, and u grows towards +x; v = 0 is +y. These are the conventions of Mitsuba 0.6 and
// 3: u = atan2(x, -z)/2π, v = acos(y)/π.
Vec2f map_position(Vec3f local, int width, int height);
Vec3f map_direction(Vec2f position, int width, int height);

}  // namespace lumirank::emitters
