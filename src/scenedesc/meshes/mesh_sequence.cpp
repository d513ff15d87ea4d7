#include "scenedesc/meshes/mesh_sequence.h"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <string_view>

#include "base/error.h"
#include "base/hash_text.h"
#include "base/random.h"
#include "scenedesc/meshes/mesh_reader.h"
#include "scenedesc/meshes/ply_body.h"
#include "scenedesc/schema/files.h"

namespace lumirank::scenedesc {

namespace {

// As the file states them: reading may mend a mesh, one frame of a sequence otherwise than another.
struct Topology {
  std::uint64_t vertices = 0, faces = 0;
  std::uint64_t corners = 0;  // a hash of what the faces say of their vertices; 0: not looked at
  bool operator==(const Topology&) const = default;
};

// The line that begins at `begin`, without its end.
std::string_view line_from(std::string_view bytes, std::size_t begin) {
  return bytes.substr(begin, std::min(bytes.find('\n', begin), bytes.size()) - begin);
}

Topology topology_of_ply(const std::string& bytes, const std::string& filename) {
  Topology topology;
  const PlyHeader header = parse_ply_header(bytes, filename);
  PlyBody body(bytes, header, filename);
  const auto add = [&](double value) {
    topology.corners = mix64(topology.corners ^ std::bit_cast<std::uint64_t>(value));
  };
  for (const PlyElement& element : header.elements) {
    const bool faces = element.name == "face";
    if (element.name == "vertex") topology.vertices = element.count;
    if (faces) topology.faces = element.count;
    if (element.properties.empty()) continue;
    const int list = faces ? element.find({"vertex_indices", "vertex_index"}, true) : -1;
    for (std::uint64_t k = 0; k < element.count; ++k) {
      body.enter(element, k);
      for (const PlyProperty& p : element.properties) {
        if (list < 0 || &p != &element.properties[static_cast<std::size_t>(list)]) {
          body.skip(p);
          continue;
        }
        const std::size_t corners = body.list_length(p);
        add(static_cast<double>(corners));
        for (std::size_t c = 0; c < corners; ++c) add(body.value(p.type));
      }
    }
  }
  return topology;
}

Topology topology_of_obj(std::string_view bytes) {
  Topology topology;
  topology.corners = kHashOfNothing;
  for (std::size_t at = 0; at < bytes.size();) {
    const std::string_view line = line_from(bytes, at);
    at += line.size() + 1;
    const std::size_t begin = std::min(line.find_first_not_of(" \t"), line.size());
    if (begin + 1 >= line.size() || (line[begin + 1] != ' ' && line[begin + 1] != '\t')) continue;
    topology.vertices += line[begin] == 'v';
    if (line[begin] != 'f') continue;
    ++topology.faces;
    topology.corners = hash_text(line, topology.corners);
  }
  return topology;
}

Topology topology_of(const MeshFileDesc& file, const std::string& bytes, const std::string& filename) {
  switch (file.format) {
    case MeshFormat::obj:
      return topology_of_obj(bytes);
    case MeshFormat::ply:
      return topology_of_ply(bytes, filename);
    case MeshFormat::serialized:
      break;
  }
  const MeshData mesh = parse_serialized(bytes, filename, file.shape_index);
  return {mesh.positions.size(), mesh.indices.size() / 3, 0};
}

std::string as_text(const Topology& topology) {
  return std::to_string(topology.vertices) + " vertices and " + std::to_string(topology.faces) + " faces";
}

}  // namespace

void check_sequence(const MeshFileDesc& file, const std::string& bytes) {
  if (file.sequence.empty() || file.sequence.front() == file.filename) return;
  const std::string& start = file.sequence.front();
  const Topology first = topology_of(file, read_file(start, {start, 0}), start),
                 now = topology_of(file, bytes, file.filename);
  if (first == now) return;
  const bool alike = first.vertices == now.vertices && first.faces == now.faces;
  throw InputError({file.filename, 0},
                   alike
                       ? "the mesh has other faces than the first of its sequence, " + start + ": as many (" +
                             std::to_string(now.faces) + "), but between other vertices, or in another order"
                       : "the mesh has " + as_text(now) + ", but the first of its sequence, " + start +
                             ", has " + as_text(first),
                   "write all files of the sequence from one mesh that deforms");
}

}  // namespace lumirank::scenedesc
