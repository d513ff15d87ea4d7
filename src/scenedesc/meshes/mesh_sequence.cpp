#include "scenedesc/meshes/mesh_sequence.h"

#include <algorithm>
#include <cstdint>

#include "base/error.h"
#include "scenedesc/meshes/mesh_reader.h"
#include "scenedesc/meshes/ply_header.h"
#include "scenedesc/schema/files.h"

namespace lumirank::scenedesc {

namespace {

// As the file states them: reading may mend a mesh, one frame of a sequence otherwise than another.
struct MeshCounts {
  std::uint64_t vertices = 0, faces = 0;
  bool operator==(const MeshCounts&) const = default;
};

MeshCounts counts_of_ply(const std::string& bytes, const std::string& filename) {
  MeshCounts counts;
  for (const PlyElement& element : parse_ply_header(bytes, filename).elements)
    if (element.name == "vertex")
      counts.vertices = element.count;
    else if (element.name == "face")
      counts.faces = element.count;
  return counts;
}

MeshCounts counts_of_obj(const std::string& bytes) {
  MeshCounts counts;
  for (std::size_t line = 0; line < bytes.size();) {
    const std::size_t begin = std::min(bytes.find_first_not_of(" \t", line), bytes.size());
    if (begin + 1 < bytes.size() && (bytes[begin + 1] == ' ' || bytes[begin + 1] == '\t')) {
      counts.vertices += bytes[begin] == 'v';
      counts.faces += bytes[begin] == 'f';
    }
    const std::size_t end = bytes.find('\n', line);
    line = end == std::string::npos ? bytes.size() : end + 1;
  }
  return counts;
}

MeshCounts counts_of(const MeshFileDesc& file, const std::string& bytes, const std::string& filename) {
  switch (file.format) {
    case MeshFormat::obj:
      return counts_of_obj(bytes);
    case MeshFormat::ply:
      return counts_of_ply(bytes, filename);
    case MeshFormat::serialized:
      break;
  }
  const MeshData mesh = parse_serialized(bytes, filename, file.shape_index);
  return {mesh.positions.size(), mesh.indices.size() / 3};
}

std::string as_text(const MeshCounts& counts) {
  return std::to_string(counts.vertices) + " vertices and " + std::to_string(counts.faces) + " faces";
}

}  // namespace

void check_sequence(const MeshFileDesc& file, const std::string& bytes) {
  const std::string& start = file.sequence_start;
  if (start.empty() || start == file.filename) return;
  const MeshCounts first = counts_of(file, read_file(start, {start, 0}), start),
                   now = counts_of(file, bytes, file.filename);
  if (first == now) return;
  throw InputError({file.filename, 0},
                   "the mesh has " + as_text(now) + ", but the first of its sequence, " + start + ", has " +
                       as_text(first),
                   "write all files of the sequence from one mesh that deforms");
}

}  // namespace lumirank::scenedesc
