// Triangle meshes for shapes: every file is read once, however many shapes name it, and analytic shapes are
// tessellated.
#pragma once

#include <map>
#include <string>
#include <tuple>
#include <vector>

#include "geometry/mesh.h"
#include "scenedesc/schema/mesh.h"
#include "scenedesc/schema/scene_desc.h"
#include "world/notes.h"

namespace lumirank::world {

class MeshStore {
 public:
  // Names the mesh of a shape that has one of its own (not a group or an instance). Equal meshes get equal
  // numbers.
  int use(const scenedesc::ShapeDesc& shape);
  // Reads and tessellates everything named so far, in parallel; the first failure in order of use is thrown,
  // with the shape that needs it. Spheres that shine get fewer triangles the more of them there are, and
  // their area is kept.
  void load(Notes& notes);

  std::size_t size() const { return sources_.size(); }
  // Without a triangle or segment, after load(), which has warned of it: its shapes are to be left out.
  bool is_empty(int index) const { return sources_[static_cast<std::size_t>(index)].empty; }
  std::size_t left_out() const;      // how many are empty
  std::string why_left_out() const;  // of the first of these, for a message; "" if there is none
  const geometry::TriangleMesh& mesh(int index) const { return meshes_[static_cast<std::size_t>(index)]; }
  // What its positions are relative to.
  const Vec3d& origin(int index) const { return origins_[static_cast<std::size_t>(index)]; }
  geometry::TriangleMesh take(int index) { return std::move(meshes_[static_cast<std::size_t>(index)]); }

 private:
  // Kind of shape, its file and options, its numbers, whether it shines, the mesh that the reader holds:
  // equal keys are the same mesh.
  using Key = std::tuple<std::size_t, std::string, std::vector<double>, bool, const void*>;
  struct Source {
    const scenedesc::ShapeDesc* shape;  // the first that names it
    bool shines;
    std::vector<std::string> left_out;
    std::vector<scenedesc::MeshData::Mended> mended;
    std::size_t uses = 0, lamps = 0;  // how often it is placed, and how many of these shine
    bool empty = false;
  };
  geometry::TriangleMesh make(Source& source, Vec3d& origin) const;
  static std::string why_empty(const Source& source);
  void warn_of_empty(const Source& source, Notes& notes) const;

  std::map<Key, int> index_;
  std::vector<Source> sources_;
  std::vector<geometry::TriangleMesh> meshes_;
  std::vector<Vec3d> origins_;
  std::size_t shining_spheres_ = 0;
};

}  // namespace lumirank::world
