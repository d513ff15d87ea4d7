// Shapes made of curves.
#pragma once

#include "scenedesc/mitsuba/plugin.h"

namespace lumirank::scenedesc::mitsuba {

// <shape type="bsplinecurve|linearcurve"> of Mitsuba 3, <shape type="hair"> of 0.6.
decltype(ShapeDesc::kind) curves(Reader& reader, Plugin& p, const Transform& to_world);

}  // namespace lumirank::scenedesc::mitsuba
