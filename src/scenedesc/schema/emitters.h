// Lights of a scene description other than shining shapes.
#pragma once

#include <optional>
#include <string>
#include <variant>

#include "base/error.h"
#include "base/rgb.h"
#include "base/transform.h"
#include "base/vec.h"
#include "scenedesc/schema/sensor.h"
#include "scenedesc/schema/textures.h"

namespace lumirank::scenedesc {

struct PointLightDesc {
  Vec3d position;
  Rgb intensity{1};  // W/sr
};
struct SpotLightDesc {  // at the origin of to_world, along its +z
  Transform to_world;
  Rgb intensity{1};
  float cutoff_angle = 20;              // degrees: no light beyond
  float beam_width = 20 * 3.0f / 4.0f;  // degrees: full intensity within
  // Between the two, of the share s of the way from the cut-off (0) to the beam (1).
  enum class Edge {
    angle,           // s of the angle (Mitsuba)
    smooth_cosine,   // 3s² - 2s³, s of the angle's cosine (pbrt)
    squared_cosine,  // s², s of the angle's cosine (glTF)
    fourth_power     // s⁴, s of the angle's cosine (pbrt-v3)
  };
  Edge edge = Edge::angle;
};
// A point light whose intensity depends on the direction as a file says; the file is opened by the world.
struct ProfileLightDesc {
  enum class Kind {
    // Photometric data (IES LM-63). At the origin of to_world; its +z is the luminaire's nadir
    // (vertical angle 0), so that it is aimed like a spot light; +x is horizontal angle 0, -y horizontal
    // angle 90 (type C; counter-clockwise seen from above an upright luminaire).
    ies,
    // A square picture in the equal-area octahedral map of the directions of the local frame (as in pbrt-v4);
    // the mean of its channels.
    image
  };
  Kind kind = Kind::ies;
  Transform to_world;  // may mirror; scales mean nothing
  // ies: factor of the file's candela, which count as white divided by SceneDesc::lumens_per_unit;
  // image: W/sr where the picture is 1.
  Rgb intensity{1};
  std::string filename;
  // image, on top of `intensity`: the picture is scaled so that at an intensity of 1 the light emits this
  // (the integral of its values over the sphere).
  std::optional<float> power = std::nullopt;
  float tilt_angle = 0;  // ies: degrees away from the position in which it was measured, for its TILT factors
};
// A point light that throws a picture: at the origin of to_world, along its +z.
struct ProjectionLightDesc {
  enum class Picture {
    intensity,   // of the light
    irradiance,  // of the plane at distance 1, times π (as Mitsuba's projector has it)
  };
  Transform to_world;
  Rgb intensity{1};  // W/sr, or W/m² at distance 1, where the picture is 1
  ColorInput picture{Rgb(1)};
  Picture means = Picture::intensity;
  // The frame's field, in degrees, along this axis of the picture; pixels are square, and so is what has
  // none.
  float fov = 45;
  FieldAxis axis = FieldAxis::x;
  bool square = false;  // the frame, whatever the picture is
  // From -1 to 1 along the frame's +x and +y to uv.
  UvTransform to_uv{{0.5f, 0, 0.5f, 0, 0.5f, 0.5f}};
  // If positive, the light is cut off as a spot's (SpotLightDesc::Edge::angle).
  float cutoff_angle = 0, beam_width = 0;
  // On top of `intensity`: the picture is scaled so that at an intensity of 1 the light emits this.
  std::optional<float> power = std::nullopt;
};
struct DirectionalLightDesc {
  Vec3f direction{0, 0, 1};  // in which the light travels
  Rgb irradiance{1};
};
struct ConstantEnvironmentDesc {
  Rgb radiance{1};
};
enum class EnvironmentProjection {
  latitude_longitude,  // +y up, as in Mitsuba
  equal_area           // pbrt-v4: octahedral (Clarberg 2008) with +z up; such pictures are square
};
struct EnvironmentMapDesc {
  std::string filename;
  float scale = 1;
  Transform to_world;
  EnvironmentProjection projection = EnvironmentProjection::latitude_longitude;
  // Equal-area maps only, on top of `scale`: what pbrt-v4 computes as the illuminance of the local +z (half
  // of the true one) is made this.
  std::optional<float> illuminance = std::nullopt;
  Rgb tint{1};  // on top of all that
};
// Of Mitsuba 3 and of 0.6; the sky is Hosek and Wilkie's in both.
enum class SunModel { hosek_wilkie, preetham };
struct SunSkyDesc {  // the models "sun", "sky" and "sunsky"
  bool sun = true, sky = true;
  SunModel sun_model = SunModel::hosek_wilkie;
  float turbidity = 3;
  Vec3f sun_direction{0, 1, 0};  // towards the sun, in the local frame of to_world (+y up)
  float sun_scale = 1, sky_scale = 1;
  float sun_radius_scale = 1;
  Rgb albedo{0.2f};
  Transform to_world;
};
struct EmitterDesc {
  std::string id;
  SourceLocation where;
  std::variant<PointLightDesc, SpotLightDesc, ProfileLightDesc, ProjectionLightDesc, DirectionalLightDesc,
               ConstantEnvironmentDesc, EnvironmentMapDesc, SunSkyDesc>
      kind;
};

}  // namespace lumirank::scenedesc
