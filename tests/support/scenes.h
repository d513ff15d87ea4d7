// Small scenes made in code: descriptions as a reader would give them, ready to be built.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "base/transform.h"
#include "scenedesc/schema/scene_desc.h"
#include "world/camera.h"
#include "world/world.h"

namespace lumirank::test {

class SceneMaker {
 public:
  scenedesc::SceneDesc desc;
  bool straight_panes = false;  // as world::BuildOptions

  template <typename Kind>
  int bsdf(Kind kind) {
    scenedesc::BsdfDesc b;
    b.id = "bsdf_" + std::to_string(desc.bsdfs.size());
    b.kind = std::move(kind);
    desc.bsdfs.push_back(std::move(b));
    return static_cast<int>(desc.bsdfs.size()) - 1;
  }
  int diffuse(Rgb reflectance) { return bsdf(scenedesc::DiffuseDesc{{reflectance, scenedesc::kNone}}); }
  // Reflects `reflectance` at any angle: index 0, extinction 1 has a Fresnel reflectance of 1.
  int mirror(Rgb reflectance) {
    scenedesc::ConductorDesc d;
    d.specular_reflectance.value = reflectance;
    return bsdf(d);
  }
  int glass(float eta) {
    scenedesc::DielectricDesc d;
    d.eta = eta;
    return bsdf(d);
  }

  template <typename Kind>
  scenedesc::ShapeDesc& shape(Kind kind, const Transform& to_world, int bsdf_index) {
    scenedesc::ShapeDesc s;
    s.id = "shape_" + std::to_string(desc.shapes.size());
    s.to_world = to_world;
    s.bsdf = bsdf_index;
    s.kind = std::move(kind);
    desc.shapes.push_back(std::move(s));
    return desc.shapes.back();
  }
  // The parallelogram center ± u ± v, outside towards u × v.
  scenedesc::ShapeDesc& rectangle(Vec3f center, Vec3f u, Vec3f v, int bsdf_index) {
    const Vec3f n = normalize(cross(u, v));
    Transform t;
    for (int row = 0; row < 3; ++row) {
      const auto at = static_cast<std::size_t>(4 * row);
      t.m[at] = u[row], t.m[at + 1] = v[row], t.m[at + 2] = n[row], t.m[at + 3] = center[row];
    }
    return shape(scenedesc::RectangleDesc{}, t, bsdf_index);
  }
  scenedesc::ShapeDesc& lamp(Vec3f center, Vec3f u, Vec3f v, Rgb radiance, int bsdf_index,
                             std::string id = {}) {
    auto& s = rectangle(center, u, v, bsdf_index);
    scenedesc::AreaEmitterDesc e;
    e.radiance.value = radiance;
    e.id = std::move(id);
    s.emitter = e;
    return s;
  }
  // The six inner walls of the box [-half, half]³.
  void box_inside(float half, int bsdf_index) {
    const Vec3f axes[3] = {{half, 0, 0}, {0, half, 0}, {0, 0, half}};
    for (int k = 0; k < 3; ++k) {
      const Vec3f c = axes[k], u = axes[(k + 1) % 3], v = axes[(k + 2) % 3];
      rectangle(c, v, u, bsdf_index);  // v × u points back to the middle
      rectangle(-c, u, v, bsdf_index);
    }
  }

  template <typename Kind>
  void light(Kind kind, std::string id = {}) {
    scenedesc::EmitterDesc e;
    e.id = std::move(id);
    e.kind = std::move(kind);
    desc.emitters.push_back(std::move(e));
  }
  void point_light(Vec3f position, Rgb intensity) { light(scenedesc::PointLightDesc{position, intensity}); }

  // A camera is added if there is none: a world has at least one.
  world::World build() {
    std::vector<scenedesc::Warning> warnings;
    if (desc.sensors.empty()) desc.sensors.emplace_back();
    world::BuildOptions options;
    options.straight_panes = straight_panes;
    return world::World::build(desc, options, warnings);
  }
};

inline scenedesc::SensorDesc sensor(Vec3f origin, Vec3f target, Vec3f up, float fov, int width, int height) {
  scenedesc::SensorDesc s;
  s.to_world = Transform::look_at(origin, target, up);
  s.fov_x = fov;
  s.film.width = width, s.film.height = height;
  return s;
}
// `half_width` of what is seen, along the film's x.
inline scenedesc::SensorDesc orthographic(Vec3f origin, Vec3f target, Vec3f up, float half_width, int width,
                                          int height) {
  scenedesc::SensorDesc s = sensor(origin, target, up, 90, width, height);
  s.kind = scenedesc::SensorKind::orthographic;
  s.to_world = s.to_world * Transform::scale(half_width, half_width, 1);
  return s;
}

}  // namespace lumirank::test
