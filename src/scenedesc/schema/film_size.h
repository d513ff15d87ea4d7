// Fields of view and the proportions of the film.
#pragma once

#include "scenedesc/schema/scene_desc.h"

namespace lumirank::scenedesc {

// As Mitsuba's "fov_axis" says it.
const char* name_of(FieldAxis axis);

// Degrees across the width of a film of width × height pixels, of a field that is `fov` degrees along the
// axis.
float horizontal_fov(double fov, FieldAxis axis, int width, int height);

// The sensor with another resolution: where the proportions change, the field along its `kept_axis` stays.
void set_film_size(SensorDesc& sensor, int width, int height);

}  // namespace lumirank::scenedesc
