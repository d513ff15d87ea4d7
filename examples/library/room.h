// A room made in memory, for the examples: gray walls, a lamp under the ceiling, a blue lamp in a corner.
#pragma once

#include "lumirank/scene_builder.h"

inline lumirank::Mesh quad(lumirank::Vec3f center, lumirank::Vec3f u, lumirank::Vec3f v) {
  return {.positions = {center - u - v, center + u - v, center + u + v, center - u + v},
          .triangles = {{0, 1, 2}, {0, 2, 3}},
          .normals = {},
          .uvs = {}};
}

inline lumirank::SceneBuilder room() {
  lumirank::SceneBuilder builder;
  const int wall = builder.add_material({.base_color = {0.7f, 0.7f, 0.65f}});
  const int metal =
      builder.add_material({.base_color = {0.9f, 0.7f, 0.3f}, .roughness = 0.4f, .metallic = 1});
  builder.add_mesh(quad({0, 0, 0}, {2, 0, 0}, {0, 0, -2}), wall, {}, "floor");
  builder.add_mesh(quad({0, 3, 0}, {2, 0, 0}, {0, 0, 2}), wall, {}, "ceiling");
  builder.add_mesh(quad({0, 1.5f, -2}, {2, 0, 0}, {0, 1.5f, 0}), wall, {}, "back");
  builder.add_mesh(quad({-2, 1.5f, 0}, {0, 0, -2}, {0, 1.5f, 0}), wall, {}, "left");
  builder.add_mesh(quad({2, 1.5f, 0}, {0, 0, 2}, {0, 1.5f, 0}), wall, {}, "right");
  builder.add_mesh(quad({0.5f, 0.6f, -0.5f}, {0.5f, 0, 0.2f}, {0, 0.6f, 0}), metal, {}, "screen");
  builder.add_mesh(quad({0, 2.95f, 0}, {0.4f, 0, 0}, {0, 0, 0.4f}), wall, {8, 7, 6}, "lamp");
  builder.add_point_light({-1.5f, 0.5f, -1.5f}, {0.3f, 0.6f, 2}, "blue");
  builder.set_camera({.origin = {0, 1.5f, 5}, .target = {0, 1.4f, 0}, .width = 64, .height = 48});
  return builder;
}
