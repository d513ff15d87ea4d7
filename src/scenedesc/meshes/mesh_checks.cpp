#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "scenedesc/meshes/mesh_parts.h"
#include "scenedesc/meshes/mesh_reader.h"

namespace lumirank::scenedesc {
namespace {

Vec3d difference(Vec3f a, Vec3f b) { return Vec3d(a) - Vec3d(b); }
double squared(Vec3d a) { return a.x * a.x + a.y * a.y + a.z * a.z; }
Vec3d crossed(Vec3d a, Vec3d b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

// No area, up to what rounding of the corners to float could feign.
bool is_degenerate(const MeshData& mesh, const std::uint32_t* corner) {
  if (corner[0] == corner[1] || corner[1] == corner[2] || corner[2] == corner[0]) return true;
  const Vec3f a = mesh.positions[corner[0]], b = mesh.positions[corner[1]], c = mesh.positions[corner[2]];
  const Vec3d ab = difference(b, a), ac = difference(c, a), bc = difference(c, b);
  const double longest = std::max({squared(ab), squared(ac), squared(bc)});
  return squared(crossed(ab, ac)) <= 1e-20 * longest * longest;
}

std::string counted(std::size_t count, const char* one, const char* many) {
  return std::to_string(count) + ' ' + (count == 1 ? one : many);
}

// Notes how many of the vertices `bad` are corners of a triangle: the others cannot be seen.
void note(MeshData& mesh, const std::vector<std::uint32_t>& bad, const char* one, const char* many,
          const char* instead) {
  if (bad.empty()) return;
  std::vector<bool> used(mesh.positions.size());
  for (const std::uint32_t k : mesh.indices) used[k] = true;
  const auto count = std::count_if(bad.begin(), bad.end(), [&](std::uint32_t k) { return used[k]; });
  if (count > 0) mesh.mended.push_back({counted(static_cast<std::size_t>(count), one, many), instead});
}

void drop_degenerate(MeshData& mesh) {
  std::size_t kept = 0;
  for (std::size_t k = 0; k < mesh.indices.size(); k += 3) {
    if (is_degenerate(mesh, &mesh.indices[k])) continue;
    if (kept != k) std::copy_n(mesh.indices.begin() + k, 3, mesh.indices.begin() + kept);
    kept += 3;
  }
  const std::size_t dropped = (mesh.indices.size() - kept) / 3;
  mesh.indices.resize(kept);
  if (dropped > 0) mesh.left_out.push_back(counted(dropped, "degenerate triangle", "degenerate triangles"));
}

void mend_normals(MeshData& mesh) {
  std::vector<std::uint32_t> missing;
  for (std::uint32_t k = 0; k < mesh.normals.size(); ++k) {
    const Vec3f n = mesh.normals[k];
    // In double: neither tiny nor huge normals lose their direction.
    const double len = std::sqrt(squared(difference(n, {})));
    if (len > 0 && std::isfinite(len)) {
      mesh.normals[k] = {float(n.x / len), float(n.y / len), float(n.z / len)};
    } else {
      missing.push_back(k);
    }
  }
  if (missing.empty()) return;
  MeshData faces;
  faces.positions = mesh.positions;
  faces.indices = mesh.indices;
  make_smooth_normals(faces);
  for (const std::uint32_t k : missing) mesh.normals[k] = faces.normals[k];
  note(mesh, missing, "missing normal", "missing normals", "the direction of the faces around");
}

MeshData mend(MeshData mesh, const SourceLocation& where) {
  for (std::size_t k = 0; k < mesh.positions.size(); ++k)
    if (!is_finite(mesh.positions[k]))
      throw InputError(where, "vertex " + std::to_string(k) + " is not finite", "repair the mesh");
  drop_degenerate(mesh);
  if (mesh.indices.empty()) return mesh;
  std::vector<std::uint32_t> bad;
  for (std::uint32_t k = 0; k < mesh.uvs.size(); ++k)
    if (Vec2f& uv = mesh.uvs[k]; !std::isfinite(uv.x) || !std::isfinite(uv.y)) uv = {}, bad.push_back(k);
  note(mesh, bad, "texture coordinate that is not finite", "texture coordinates that are not finite", "0");
  bad.clear();
  for (std::uint32_t k = 0; k < mesh.colors.size(); ++k)
    if (Rgb& c = mesh.colors[k]; !is_finite(c)) c = Rgb(0), bad.push_back(k);
  note(mesh, bad, "vertex color that is not finite", "vertex colors that are not finite", "black");
  mend_normals(mesh);
  return mesh;
}

}  // namespace

MeshData check_mesh(MeshData mesh, const SourceLocation& where) {
  const std::size_t vertices = mesh.positions.size();
  const auto check_list = [&](std::size_t size, const char* what) {
    if (size != 0 && size != vertices)
      throw InputError(
          where,
          "the mesh has " + std::to_string(vertices) + " vertices and " + std::to_string(size) + " " + what,
          "give one for each vertex");
  };
  check_list(mesh.normals.size(), "normals");
  check_list(mesh.uvs.size(), "texture coordinates");
  check_list(mesh.colors.size(), "vertex colors");
  if (mesh.indices.size() % 3 != 0)
    throw InputError(where, "the mesh has " + std::to_string(mesh.indices.size()) + " indices",
                     "three make a triangle");
  for (const std::uint32_t k : mesh.indices)
    if (k >= vertices)
      throw InputError(
          where, "the mesh refers to vertex " + std::to_string(k) + " and has " + std::to_string(vertices),
          "indices start at 0");
  return mend(std::move(mesh), where);
}

MeshData checked(MeshData mesh, const std::string& filename) { return mend(std::move(mesh), {filename, 0}); }

}  // namespace lumirank::scenedesc
