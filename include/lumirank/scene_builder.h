// A scene made in memory instead of read from a file.
//
//   SceneBuilder builder;
//   const int gray = builder.add_material({.base_color = Rgb(0.5f)});
//   builder.add_mesh(floor, gray);
//   builder.add_point_light({0, 2, 0}, Rgb(10));
//   builder.set_camera({.origin = {0, 1, 4}, .target = {0, 1, 0}});
//   Scene scene = builder.build();
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "lumirank/export.h"
#include "lumirank/lumirank.h"
#include "lumirank/values.h"

namespace lumirank {

// Right-handed; any unit of length, the same for all of a scene.
struct Mesh {
  std::vector<Vec3f> positions;
  std::vector<std::array<std::uint32_t, 3>> triangles;  // corners, counter-clockwise from the front
  std::vector<Vec3f> normals;                           // empty (flat) or one per position
  std::vector<Vec2f> uvs;                               // empty or one per position
};

// The principled BSDF (Burley 2012, 2015), as in Mitsuba 3.
struct Material {
  Rgb base_color{0.5f};
  float roughness = 1;     // 0 … 1
  float metallic = 0;      // 0 … 1
  float transmission = 0;  // 0 … 1: of light that is not reflected, what goes through
  float index_of_refraction = 1.5f;
  float clearcoat = 0;    // 0 … 1
  bool two_sided = true;  // alike from behind; not with transmission
};

struct PerspectiveCamera {
  Vec3f origin{0, 0, 1}, target{0, 0, 0}, up{0, 1, 0};
  float horizontal_field = 40;  // degrees
  int width = 640, height = 480;
};

// Each call checks what it is given and throws InputError that names it.
class LUMIRANK_API SceneBuilder {
 public:
  SceneBuilder();
  ~SceneBuilder();
  SceneBuilder(SceneBuilder&&) noexcept;
  SceneBuilder& operator=(SceneBuilder&&) noexcept;

  // The number by which meshes name it.
  int add_material(const Material& material);
  // `emitted`: radiance of its front side, for lamps. `name`: for messages and for layers by light.
  void add_mesh(Mesh mesh, int material, Rgb emitted = Rgb(0.0f), const std::string& name = {});
  // `intensity` in all directions, power per solid angle.
  void add_point_light(Vec3f position, Rgb intensity, const std::string& name = {});
  // Light travels along `direction`; `irradiance` on a surface that faces it.
  void add_directional_light(Vec3f direction, Rgb irradiance, const std::string& name = {});
  // The same radiance from all around; at most one environment.
  void set_environment(Rgb radiance, const std::string& name = {});
  // The same from a picture (latitude-longitude, +y up: .exr, .hdr), whose radiance is multiplied with
  // `scale`.
  void set_environment(const std::string& image_file, float scale = 1, const std::string& name = {});
  void set_camera(const PerspectiveCamera& camera);

  // The scene so far; the builder may be used on. Throws InputError without a camera.
  Scene build() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace lumirank
