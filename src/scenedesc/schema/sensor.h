// Cameras of a scene description with their film and its filter.
#pragma once

#include <string>

#include "base/error.h"
#include "base/transform.h"
#include "base/vec.h"

namespace lumirank::scenedesc {

enum class FilterKind { box, tent, gaussian, mitchell, catmullrom, lanczos };

struct FilterDesc {
  FilterKind kind = FilterKind::box;
  float radius = 0;  // in pixels; 0: the kind's default (box 0.5, tent 1, gaussian 4σ, mitchell/catmullrom 2,
                     // lanczos = lobes)
  float stddev = 0.5f;
  float b = 1.0f / 3, c = 1.0f / 3;
  int lobes = 3;
};
struct FilmDesc {
  int width = 768, height = 576;
  int crop_x = 0, crop_y = 0, crop_width = 0, crop_height = 0;  // crop_width 0: no crop
  FilterDesc filter;
};
enum class SensorKind { perspective, thinlens, orthographic };
// all: the whole picture, whatever its proportions.
enum class FieldAxis { x, y, smaller, larger, diagonal, all };
struct SensorDesc {
  std::string id;
  SourceLocation where;
  SensorKind kind = SensorKind::perspective;
  Transform to_world;                  // camera looks along +z, +y up, +x left
  float fov_x = 39.6f;                 // degrees, across the width of the image (readers convert other axes)
  FieldAxis kept_axis = FieldAxis::x;  // along which the field stays if the film gets other proportions
  float aperture_radius = 0;           // thinlens
  float focus_distance = 1;
  float near_clip = 1e-2f, far_clip = 1e4f;
  Vec2f principal_point_offset;  // in fractions of the film
  int medium = -1;               // around the camera, an index into SceneDesc::media; -1: empty space
  FilmDesc film;
  int samples_per_pixel = 0;  // 0: not stated
};

}  // namespace lumirank::scenedesc
