// A view: a sensor with the resolution, window and depth that were asked for.
#pragma once

#include <string>

#include "film/filter.h"
#include "scenedesc/schema/scene_desc.h"

namespace lumirank::world {

// What may be asked for instead of what the scene says; zeros and empty: as the scene says.
struct ViewChoice {
  std::string camera;
  int width = 0, height = 0;   // pixels
  int crop[4] = {0, 0, 0, 0};  // x, y, width, height; width 0: none
  int max_depth = 0;           // Mitsuba's count; -1: unlimited
};

struct View {
  scenedesc::SensorDesc sensor;
  int max_depth = -1;
  int crop_x = 0, crop_y = 0, width = 0, height = 0;  // the window of the film that is rendered
};

// Throws InputError for an unknown camera or a crop outside the film.
View make_view(const scenedesc::SceneDesc& desc, const ViewChoice& choice);
// The whole film of a view, whatever its crop, with about so many pixels.
scenedesc::SensorDesc whole_film(const View& view, double pixels);

film::Filter make_filter(const scenedesc::FilterDesc& desc);

}  // namespace lumirank::world
