#include "world/view.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "scenedesc/schema/film_size.h"

namespace lumirank::world {
namespace {

const scenedesc::SensorDesc& find_sensor(const scenedesc::SceneDesc& desc, const std::string& name) {
  if (desc.sensors.empty()) throw InputError({desc.source_file, 0}, "the scene has no sensor", "add one");
  if (name.empty()) return desc.sensors.front();
  std::string known;
  for (const auto& sensor : desc.sensors) {
    if (sensor.id == name) return sensor;
    if (!sensor.id.empty()) known += (known.empty() ? "'" : ", '") + sensor.id + "'";
  }
  throw InputError({desc.source_file, 0}, "there is no camera '" + name + "'",
                   known.empty() ? "none of the scene's cameras has an id; the first is the default"
                                 : "the cameras are " + known);
}

}  // namespace

View make_view(const scenedesc::SceneDesc& desc, const ViewChoice& choice) {
  View view;
  view.sensor = find_sensor(desc, choice.camera);
  auto& film = view.sensor.film;
  if (choice.width > 0) {
    scenedesc::set_film_size(view.sensor, choice.width, choice.height);
    film.crop_width = 0;  // the scene's own window belongs to its own size
  }
  view.max_depth = choice.max_depth != 0 ? choice.max_depth : desc.max_depth;
  view.width = film.width, view.height = film.height;
  if (film.crop_width > 0) {
    view.crop_x = film.crop_x, view.crop_y = film.crop_y;
    view.width = film.crop_width, view.height = film.crop_height;
  }
  if (choice.crop[2] > 0) {
    view.crop_x = choice.crop[0], view.crop_y = choice.crop[1];
    view.width = choice.crop[2], view.height = choice.crop[3];
    if (view.crop_x + view.width > film.width || view.crop_y + view.height > film.height)
      throw InputError("the crop reaches beyond the film of " + std::to_string(film.width) + "x" +
                       std::to_string(film.height) + " pixels");
  }
  return view;
}

scenedesc::SensorDesc whole_film(const View& view, double pixels) {
  scenedesc::SensorDesc sensor = view.sensor;
  auto& film = sensor.film;
  film.crop_width = film.crop_height = film.crop_x = film.crop_y = 0;
  const double scale = std::sqrt(pixels / (static_cast<double>(film.width) * film.height));
  for (int* side : {&film.width, &film.height})
    *side = std::max(1, static_cast<int>(std::lround(*side * scale)));
  return sensor;
}

film::Filter make_filter(const scenedesc::FilterDesc& desc) {
  film::Filter filter;
  filter.kind = static_cast<film::FilterKind>(desc.kind);
  filter.stddev = desc.stddev, filter.b = desc.b, filter.c = desc.c, filter.lobes = desc.lobes;
  filter.radius = desc.radius;
  if (filter.radius <= 0) {
    switch (desc.kind) {
      case scenedesc::FilterKind::box:
        filter.radius = 0.5f;
        break;
      case scenedesc::FilterKind::tent:
        filter.radius = 1;
        break;
      case scenedesc::FilterKind::gaussian:
        filter.radius = 4 * desc.stddev;
        break;
      case scenedesc::FilterKind::mitchell:
      case scenedesc::FilterKind::catmullrom:
        filter.radius = 2;
        break;
      case scenedesc::FilterKind::lanczos:
        filter.radius = static_cast<float>(desc.lobes);
        break;
    }
  }
  return filter;
}

}  // namespace lumirank::world
