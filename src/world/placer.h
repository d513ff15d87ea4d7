// Shapes, groups and instances → placements of meshes in the world.
#pragma once

#include <vector>

#include "base/transform.h"
#include "geometry/ray_scene.h"
#include "scenedesc/schema/scene_desc.h"
#include "world/mesh_store.h"
#include "world/notes.h"
#include "world/units.h"

namespace lumirank::world {

// A shape at a place.
struct Placed {
  int source = 0;  // mesh of the store
  Transform to_world;
  bool flip_normals = false;
  const scenedesc::ShapeDesc* shape = nullptr;
  bool shines = false;                             // its emitter counts
  const scenedesc::ShapeDesc* instance = nullptr;  // that places `shape`; none if it stands by itself
};

// One per shape and per member of an instance's group, in the order of the scene.
std::vector<Placed> place_shapes(const scenedesc::SceneDesc& desc, MeshStore& store, Notes& notes);

// The units for everything placed. The meshes must have been loaded.
Units units_for(const std::vector<Placed>& placed, const MeshStore& store);

// What the ray scene is made of. Meshes that are placed once or shine are moved into world space for good;
// the others are shared by their placements (whether the tracer then flattens copies is its own affair).
struct Geometry {
  std::vector<geometry::TriangleMesh> meshes;
  std::vector<geometry::Placement> placements;  // as `placed`, without its materials and emitters
  std::vector<Placed> placed;  // what is left of them: those without any area are warned about
  std::vector<bool> flip;      // per placement: the outside is against the corners' order
  std::size_t unique_triangles = 0, triangles = 0;
  std::size_t segments = 0;  // of fibers
};
Geometry assemble(std::vector<Placed> placed, MeshStore& store, const Units& units, Notes& notes);

}  // namespace lumirank::world
