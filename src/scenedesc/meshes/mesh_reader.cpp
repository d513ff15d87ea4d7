// Opens mesh files and applies what the scene says about them.
#include "scenedesc/meshes/mesh_reader.h"
#include "base/error.h"
#include "scenedesc/meshes/mesh_parts.h"
#include "scenedesc/meshes/mesh_sequence.h"
#include "scenedesc/schema/files.h"

namespace lumirank::scenedesc {

MeshData read_mesh(const MeshFileDesc& file) {
  const std::string bytes = read_file(file.filename, {file.filename, 0});
  check_sequence(file, bytes);
  bool flat = false;  // the file itself asks for face normals
  MeshData mesh;
  switch (file.format) {
    case MeshFormat::obj:
      mesh = parse_obj(bytes, file.filename);
      break;
    case MeshFormat::ply:
      mesh = parse_ply(bytes, file.filename);
      break;
    case MeshFormat::serialized:
      mesh = parse_serialized(bytes, file.filename, file.shape_index, flat);
      break;
  }
  if (file.flip_tex_coords)
    for (Vec2f& uv : mesh.uvs) uv.y = 1 - uv.y;
  if (file.face_normals || flat) {
    mesh.normals.clear();
  } else if (file.max_smooth_angle) {
    if (!(*file.max_smooth_angle >= 0))
      throw InputError({file.filename, 0}, "the largest smooth angle is negative",
                       "give an angle from 0 to 180 degrees");
    make_creased_normals(mesh, *file.max_smooth_angle);
  } else if (mesh.normals.empty() && file.smooth_without_normals) {
    // As in Mitsuba: without normals of its own a mesh is smooth unless it is said to be flat.
    make_smooth_normals(mesh);
  }
  return mesh;
}

}  // namespace lumirank::scenedesc
