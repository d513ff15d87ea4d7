// Shapes of a scene description, and what makes a shape a light.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "base/error.h"
#include "base/transform.h"
#include "base/vec.h"
#include "scenedesc/schema/media.h"
#include "scenedesc/schema/mesh.h"
#include "scenedesc/schema/textures.h"

namespace lumirank::scenedesc {

enum class MeshFormat { obj, ply, serialized };

struct MeshFileDesc {
  MeshFormat format = MeshFormat::obj;
  std::string filename;
  int shape_index = 0;        // serialized only
  bool face_normals = false;  // ignore the file's normals
  // v → 1 - v of what the mesh file states, in place of the stated value. Mitsuba, 0.6 and 3.x alike: true by
  // default for OBJ (whose v runs up), false for PLY and serialized; the bitmap's own flip (see
  // BitmapTextureDesc) comes on top.
  bool flip_tex_coords = false;
  std::optional<float> max_smooth_angle;  // degrees; normals are made anew
  bool smooth_without_normals = true;     // false: a file without normals has face normals (pbrt)
  // Of a numbered sequence (frame_files.h) all files, the first one first: all must have the same faces.
  std::vector<std::string> sequence = {};
};
// A mesh that the reader already holds: checked (see check_mesh) and never changed again. Shapes that share
// it share its geometry. Null: its file does not exist, and that was allowed (--allow-missing); like a mesh
// without a triangle it is left out, and counted, when the world is built.
struct InlineMeshDesc {
  std::shared_ptr<const MeshData> mesh;
  std::string name;  // for messages and listings
};
struct RectangleDesc {};  // [-1,1]² in z = 0, normal +z
struct CubeDesc {};       // [-1,1]³
struct SphereDesc {
  Vec3d center;
  float radius = 1;
};
struct DiskDesc {};  // unit disk in z = 0, normal +z
struct CylinderDesc {
  Vec3d p0{0, 0, 0}, p1{0, 0, 1};
  float radius = 1;
};
// Fibers: many curves with a radius at each of their points. Cubic ones have uniform knots: a b-spline of n
// points has n - 3 pieces and does not reach its outer points; a bezier curve of 3k + 1 points has k pieces.
struct CurvesDesc {
  enum class Basis { bspline, bezier, linear };
  Basis basis = Basis::bspline;
  // Read from a file, and then empty here; or stated by the scene itself.
  std::string filename;
  float file_radius = 0;  // of files that state none (the "hair" shape of Mitsuba 0.6); 0: the file has radii
  std::vector<Vec3f> points;
  std::vector<float> radii;          // one per point
  std::vector<std::uint32_t> first;  // the first point of each curve, and the number of points at the end
  Vec3d origin = {};                 // of the points, as in MeshData
};
struct ShapeGroupDesc {
  std::vector<int> shapes;  // indices into SceneDesc::shapes
};
struct InstanceDesc {
  int group = kNone;  // index of a shape whose kind is ShapeGroupDesc
};

struct AreaEmitterDesc {
  ColorInput radiance{Rgb(1)};
  std::string id;  // for --aov light:NAME; the shape's id if the emitter has none
  SourceLocation where;
  bool seen = true;  // false: what the shape sends arrives, but no ray meets it
};

struct ShapeDesc {
  std::string id;
  SourceLocation where;
  Transform to_world;
  bool flip_normals = false;
  int bsdf = kNone;  // kNone: the default diffuse BSDF
  MediumInterfaceDesc media;
  std::optional<AreaEmitterDesc> emitter;
  bool in_group = false;  // a member of a shape group: not in the world by itself
  std::variant<MeshFileDesc, RectangleDesc, CubeDesc, SphereDesc, DiskDesc, CylinderDesc, CurvesDesc,
               ShapeGroupDesc, InstanceDesc, InlineMeshDesc>
      kind;
};

}  // namespace lumirank::scenedesc
