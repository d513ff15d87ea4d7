// Emitters, prepared: what shines, in world space. Sampling returns values and densities; no random state
// inside.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "base/bounds.h"
#include "base/distribution.h"
#include "base/frame.h"
#include "base/rgb.h"
#include "base/vec.h"
#include "emitters/intensity_profile.h"

namespace lumirank::emitters {

// One-sided diffuse emission from triangles in world space (radiance may be textured: one value per triangle
// then is its mean, the exact value is looked up by the world).
struct AreaEmitter {
  struct Triangle {
    Vec3f p0, e1, e2;  // corner and edges
    Vec3f normal;      // unit, the emitting side
    float area = 0;
    Rgb mean_radiance;
    std::uint32_t mesh_triangle = 0;
    Vec3f at(Vec2f barycentric) const { return p0 + e1 * barycentric.x + e2 * barycentric.y; }
  };
  std::uint32_t placement = 0;  // of the ray scene
  std::vector<Triangle> triangles;
  Distribution1D by_power;  // area × luminance of mean radiance
  float total_area = 0;
  bool seen = true;  // false: no ray meets it
};
struct PointEmitter {
  Vec3f position;
  Rgb intensity;
};
struct SpotEmitter {
  Vec3f position;
  Frame frame;  // n: the axis
  Rgb intensity;
  float cos_cutoff = 0, cos_beam = 1;  // Mitsuba's linear fall-off in angle between the two
  float cutoff = 0, beam = 0;          // radians
  Rgb intensity_towards(Vec3f direction) const;
};
struct ProfileEmitter {  // a point whose intensity follows a table or a picture
  Vec3f position;
  Frame frame;  // the profile's axes in the world; may mirror
  Rgb scale;    // W/sr where the profile is 1
  std::shared_ptr<const IntensityProfile> profile;
  Rgb intensity_towards(Vec3f direction) const {
    return scale * profile->intensity(frame.to_local(direction));
  }
};
struct DirectionalEmitter {
  Vec3f direction;           // in which the light travels
  Rgb irradiance;            // on a surface facing it
  float cos_half_angle = 1;  // < 1: a sun disc of that half angle, irradiance spread evenly over it
  Rgb radiance_from(Vec3f towards) const;  // of the disc
};
// Radiance from all directions: a constant or a latitude-longitude image (an environment map or a sky model).
struct EnvironmentEmitter {
  int width = 0, height = 0;  // 1×1: constant
  std::vector<Rgb> radiance;  // row 0 at the local +y pole
  Frame to_world;             // s, t, n: the local x, y, z axes in the world
  Distribution1D rows;        // by luminance × sinθ
  std::vector<Distribution1D> columns;
  std::vector<double> edges;        // cosines of the polar angles between rows, from 1 to -1
  std::vector<float> solid_angles;  // of a texel, by rows

  Rgb eval(Vec3f direction) const;  // radiance that arrives from `direction` (unit, away from the scene)
  struct Sample {
    Vec3f direction;
    Rgb radiance;
    float pdf;
  };
  Sample sample(Vec2f u) const;  // pdf in solid angle
  // The same in steps: what it reads of a large map lies anywhere in memory, and each step asks for what the
  // next one reads.
  struct Texel {
    Distribution1D::Sample row, column;
  };
  Distribution1D::Sample fetch_row(Vec2f u) const;
  void fetch_column(Vec2f u, const Distribution1D::Sample& row) const;
  Texel fetch_texel(Vec2f u, const Distribution1D::Sample& row) const;
  Sample sample_in(const Texel& texel) const;
  float pdf(Vec3f direction) const;
  struct Seen {
    Rgb radiance;
    float pdf = 0;
  };
  Seen look(Vec3f direction) const;  // eval() and pdf(), for little more than either
  // And these in two steps, as above: the position is on the map, in texels.
  Vec2f fetch_position(Vec3f direction) const;
  Rgb eval_at(Vec2f position) const;
  float pdf_at(Vec2f position) const;

 private:
  Vec2f position_of(Vec3f direction) const;
  void fetch_around(std::size_t row, std::size_t column) const;
};

struct Emitter {
  std::string name;         // its id in the scene, made unique
  std::uint16_t group = 0;  // emitters that share an id share a group
  std::variant<AreaEmitter, PointEmitter, SpotEmitter, ProfileEmitter, DirectionalEmitter, EnvironmentEmitter>
      kind;
};

// Emitted power in watts, given the sphere that bounds the scene (infinitely far emitters fill its disc).
Rgb power(const Emitter& emitter, float scene_radius);

// Direct illumination of a point, for a path tracer. `distance` is infinite for directional and environment
// light; delta: no BSDF sample can hit it.
struct DirectSample {
  Vec3f direction;  // unit, from the point to the light
  float distance = 0;
  Rgb radiance;   // Le, or for delta emitters the irradiance-like value I/d² or E
  float pdf = 0;  // solid angle; 1 for delta emitters
  bool delta = false;
  Vec3f normal;                // at the light (area)
  std::uint32_t triangle = 0;  // area: index into AreaEmitter::triangles
  Vec2f barycentric;
};
// Of the environment, from whatever point.
DirectSample direct_of(const EnvironmentEmitter::Sample& drawn);
// pdf 0: nothing can arrive. u1 chooses the triangle.
DirectSample sample_direct(const Emitter& emitter, Vec3f point, float u1, Vec2f u2);
// Density of sample_direct for an area emitter's triangle seen from `point` along `direction` at `distance`.
float pdf_direct_area(const AreaEmitter& emitter, const AreaEmitter::Triangle& triangle, Vec3f direction,
                      float distance);

// A particle leaving an emitter: weight is flux over density (W per path when divided by the number of
// paths).
struct Emission {
  Vec3f origin, direction;
  Rgb weight;
  Vec3f normal;  // at the emitter (area)
  std::uint32_t triangle = 0;
  Vec2f barycentric;
};
Emission sample_emission(const Emitter& emitter, const Bounds3f& scene, float u1, Vec2f u_position,
                         Vec2f u_direction);

}  // namespace lumirank::emitters
