// Two meshes, from -1 to 1: a block, and a sheet at z = 0 that looks upwards.
#pragma once

#include "geometry/mesh.h"

namespace lumirank::test {

inline geometry::TriangleMesh block() {
  geometry::TriangleMesh mesh;
  for (int k = 0; k < 8; ++k)
    mesh.positions.push_back({k & 1 ? 1.0f : -1.0f, k & 2 ? 1.0f : -1.0f, k & 4 ? 1.0f : -1.0f});
  mesh.indices = {0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6, 0, 1, 5, 0, 5, 4,
                  2, 6, 7, 2, 7, 3, 0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5};
  return mesh;
}

inline geometry::TriangleMesh sheet() {
  geometry::TriangleMesh mesh;
  mesh.positions = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
  mesh.indices = {0, 1, 2, 0, 2, 3};
  return mesh;
}

}  // namespace lumirank::test
