// Scenes made in code.
#pragma once

#include <utility>
#include <vector>

#include "scenedesc/schema/scene_desc.h"
#include "world/world.h"

namespace lumirank::test {

namespace sd = scenedesc;

inline sd::SceneDesc empty_scene() {
  sd::SceneDesc desc;
  desc.source_file = "made in code";
  desc.sensors.emplace_back();
  return desc;
}

// Adds a shape and returns its index.
template <typename Kind>
int add_shape(sd::SceneDesc& desc, Kind kind, const Transform& to_world = {}, int line = 0) {
  sd::ShapeDesc shape;
  shape.kind = std::move(kind);
  shape.to_world = to_world;
  shape.where = {"scene.xml", line};
  desc.shapes.push_back(std::move(shape));
  return static_cast<int>(desc.shapes.size()) - 1;
}

template <typename Kind>
int add_bsdf(sd::SceneDesc& desc, Kind kind, int line = 0) {
  sd::BsdfDesc b;
  b.id = "bsdf" + std::to_string(desc.bsdfs.size());
  b.kind = std::move(kind);
  b.where = {"scene.xml", line};
  desc.bsdfs.push_back(std::move(b));
  return static_cast<int>(desc.bsdfs.size()) - 1;
}

template <typename Kind>
int add_texture(sd::SceneDesc& desc, Kind kind, int line = 0) {
  sd::TextureDesc t;
  t.id = "texture" + std::to_string(desc.textures.size());
  t.kind = std::move(kind);
  t.where = {"scene.xml", line};
  desc.textures.push_back(std::move(t));
  return static_cast<int>(desc.textures.size()) - 1;
}

template <typename Kind>
int add_emitter(sd::SceneDesc& desc, Kind kind, const std::string& id = {}, int line = 0) {
  sd::EmitterDesc e;
  e.id = id;
  e.kind = std::move(kind);
  e.where = {"scene.xml", line};
  desc.emitters.push_back(std::move(e));
  return static_cast<int>(desc.emitters.size()) - 1;
}

inline void shine(sd::SceneDesc& desc, int shape, sd::ColorInput radiance, const std::string& id = {}) {
  auto& s = desc.shapes[static_cast<std::size_t>(shape)];
  s.emitter = sd::AreaEmitterDesc{radiance, id, s.where};
}

inline world::World build(const sd::SceneDesc& desc, std::vector<sd::Warning>* warnings = nullptr,
                          bool strict = false) {
  std::vector<sd::Warning> own;
  return world::World::build(desc, {strict}, warnings ? *warnings : own);
}

inline geometry::Ray ray(Vec3f origin, Vec3f direction) { return {origin, direction, 0, kInfinity}; }

}  // namespace lumirank::test
