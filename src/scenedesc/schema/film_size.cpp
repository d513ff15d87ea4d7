#include "scenedesc/schema/film_size.h"

#include <algorithm>
#include <cmath>

namespace lumirank::scenedesc {
namespace {

// What the axis measures of a film.
double measure(FieldAxis axis, double width, double height) {
  switch (axis) {
    case FieldAxis::y:
      return height;
    case FieldAxis::smaller:
      return std::min(width, height);
    case FieldAxis::larger:
      return std::max(width, height);
    case FieldAxis::diagonal:
      return std::hypot(width, height);
    default:
      return width;
  }
}

}  // namespace

const char* name_of(FieldAxis axis) {
  switch (axis) {
    case FieldAxis::x:
      return "x";
    case FieldAxis::y:
      return "y";
    case FieldAxis::smaller:
      return "smaller";
    case FieldAxis::larger:
      return "larger";
    case FieldAxis::diagonal:
      return "diagonal";
    case FieldAxis::all:
      break;
  }
  return "all";
}

float horizontal_fov(double fov, FieldAxis axis, int width, int height) {
  if (measure(axis, width, height) == width) return static_cast<float>(fov);
  const double half = std::tan(fov * kPiD / 360) * width / measure(axis, width, height);
  return static_cast<float>(std::atan(half) * 360 / kPiD);
}

void set_film_size(SensorDesc& s, int width, int height) {
  const double old_width = s.film.width, old_height = s.film.height;
  s.film.width = width, s.film.height = height;
  // How much more the width shows than before.
  const double wider = s.kept_axis == FieldAxis::all
                           ? std::max(1.0, width / old_width * old_height / height)
                           : width / old_width * measure(s.kept_axis, old_width, old_height) /
                                 measure(s.kept_axis, width, height);
  if (std::abs(wider - 1) < 1e-12) return;
  if (s.kind == SensorKind::orthographic)
    s.to_world = s.to_world * Transform::scale(wider, wider, 1);
  else
    s.fov_x = static_cast<float>(std::atan(std::tan(s.fov_x * kPiD / 360) * wider) * 360 / kPiD);
}

}  // namespace lumirank::scenedesc
