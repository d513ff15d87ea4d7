// Lenses of pbrt's realistic camera, as the thin lens that shows the same view.
#pragma once

#include <string>

#include "base/error.h"

namespace lumirank::scenedesc::pbrt {

// First order optics: what is near the axis. Lengths in the file's units (mm); places along the axis, from
// the first surface towards the film.
struct Lens {
  double focal_length = 0;
  double front_principal = 0, rear_principal = 0;
  double entrance_pupil = 0, entrance_radius = 0;  // the stop as seen from the scene
  double exit_pupil = 0, exit_radius = 0;          // and from the film

  // From the rear principal plane to the film that has in focus what is so far from it. 0: there is no such
  // place.
  double image_distance(double film_to_object) const;
};

// `text`: for each surface from the scene to the film its radius of curvature (0: the stop, or a plane), the
// way to the next one, the index of what is between them (0: air) and its diameter. The stop is opened to
// `aperture_diameter` at most. InputError, at `where`, if that is no lens that throws an image.
Lens parse_lens(const std::string& text, const std::string& filename, double aperture_diameter,
                const SourceLocation& where);

}  // namespace lumirank::scenedesc::pbrt
