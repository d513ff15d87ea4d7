// Opens mesh files and applies what the scene says about them.
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <system_error>

#include "base/error.h"
#include "scenedesc/meshes/mesh_parts.h"
#include "scenedesc/readers.h"

namespace lumirank::scenedesc {
namespace {

std::string read_bytes(const std::string& filename) {
  std::error_code status;
  if (!std::filesystem::exists(filename, status))
    throw InputError({filename, 0}, "there is no such file",
                     "check the name; it is relative to the scene's folder");
  if (!std::filesystem::is_regular_file(filename, status))
    throw InputError({filename, 0}, "this is not a file", "name a mesh file");
  struct Close {
    void operator()(std::FILE* f) const { std::fclose(f); }
  };
  const std::unique_ptr<std::FILE, Close> file(std::fopen(filename.c_str(), "rb"));
  if (!file) throw InputError({filename, 0}, "the file cannot be opened", "check its permissions");
  std::string bytes(static_cast<std::size_t>(std::filesystem::file_size(filename)), '\0');
  bytes.resize(std::fread(bytes.data(), 1, bytes.size(), file.get()));
  if (std::ferror(file.get())) throw InputError({filename, 0}, "the file cannot be read", "check the disk");
  return bytes;
}

}  // namespace

MeshData read_mesh(const MeshFileDesc& file) {
  const std::string bytes = read_bytes(file.filename);
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
