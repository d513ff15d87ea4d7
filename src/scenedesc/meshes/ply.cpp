// PLY in its three formats. Of the vertices: x y z, nx ny nz, one pair of texture coordinates, and red green
// blue; of the faces: the list of vertices. Everything else is passed over.
#include <array>
#include <cmath>

#include "base/error.h"
#include "scenedesc/meshes/mesh_parts.h"
#include "scenedesc/meshes/mesh_reader.h"
#include "scenedesc/meshes/ply_body.h"

namespace lumirank::scenedesc {
namespace {

// Where the values of one vertex go: slot k of 11 (position, normal, uv, color), or nowhere.
struct VertexLayout {
  static constexpr int kSlots = 11;
  std::vector<int> slot;  // per property; -1: skipped
  std::array<float, kSlots> scale;
  bool normal = false, uv = false, color = false;
};

// Integer colors span [0, 1].
float color_scale(PlyType type) {
  switch (type) {
    case PlyType::int8:
      return 1.0f / 127;
    case PlyType::uint8:
      return 1.0f / 255;
    case PlyType::int16:
      return 1.0f / 32767;
    case PlyType::uint16:
      return 1.0f / 65535;
    case PlyType::int32:
      return 1.0f / 2147483648.0f;
    case PlyType::uint32:
      return 1.0f / 4294967295.0f;
    default:
      return 1;
  }
}

VertexLayout layout_of(const PlyElement& element, const std::string& filename) {
  VertexLayout layout;
  layout.slot.assign(element.properties.size(), -1);
  layout.scale.fill(1);
  using Names = std::initializer_list<std::string_view>;
  // True if every name of the group is there.
  auto place = [&](int first, std::initializer_list<Names> group) {
    std::vector<int> found;
    for (const Names& names : group) {
      found.push_back(element.find(names, false));
      if (found.back() < 0) return false;
    }
    for (std::size_t k = 0; k < found.size(); ++k) layout.slot[found[k]] = first + static_cast<int>(k);
    return true;
  };
  if (!place(0, {{"x"}, {"y"}, {"z"}}))
    throw InputError({filename, 0}, "the vertices have no x, y and z", "export the file again");
  layout.normal = place(3, {{"nx"}, {"ny"}, {"nz"}});
  layout.uv = place(6, {{"u"}, {"v"}}) || place(6, {{"s"}, {"t"}}) ||
              place(6, {{"texture_u"}, {"texture_v"}}) || place(6, {{"texture_s"}, {"texture_t"}});
  layout.color = place(8, {{"red"}, {"green"}, {"blue"}}) || place(8, {{"r"}, {"g"}, {"b"}}) ||
                 place(8, {{"diffuse_red"}, {"diffuse_green"}, {"diffuse_blue"}});
  for (std::size_t k = 0; k < layout.slot.size(); ++k)
    if (layout.slot[k] >= 8) layout.scale[layout.slot[k]] = color_scale(element.properties[k].type);
  return layout;
}

// What the header claims must fit into the bytes that are there, before any memory is asked for.
void check_count(const PlyElement& element, PlyBody& body) {
  const std::size_t size = element.min_size(body.is_text() ? PlyFormat::ascii : PlyFormat::little_endian);
  body.enter(element, 0);
  if (size > 0 && element.count > (body.bytes_left() + body.is_text()) / size)
    body.fail("the header promises " + std::to_string(element.count) +
              " of these, but the file is too short");
}

void read_vertices(const PlyElement& element, PlyBody& body, const std::string& filename, MeshData& mesh) {
  const VertexLayout layout = layout_of(element, filename);
  if (element.count > 0xffffffffu) body.fail("the mesh has more than 4,294,967,295 vertices");
  const auto n = static_cast<std::size_t>(element.count);
  std::vector<Vec3d> places;
  places.reserve(n);
  if (layout.normal) mesh.normals.reserve(n);
  if (layout.uv) mesh.uvs.reserve(n);
  if (layout.color) mesh.colors.reserve(n);
  std::array<float, VertexLayout::kSlots> a{};
  Vec3d place;
  for (std::size_t k = 0; k < n; ++k) {
    body.enter(element, k);
    for (std::size_t j = 0; j < element.properties.size(); ++j) {
      const int slot = layout.slot[j];
      if (slot < 0)
        body.skip(element.properties[j]);
      else if (slot < 3)
        place[slot] = body.value(element.properties[j].type);
      else
        a[slot] = static_cast<float>(body.value(element.properties[j].type)) * layout.scale[slot];
    }
    if (!is_finite(static_cast<Vec3f>(place))) body.fail("the position is not finite");
    places.push_back(place);
    if (layout.normal) mesh.normals.push_back({a[3], a[4], a[5]});
    if (layout.uv) mesh.uvs.push_back({a[6], a[7]});
    if (layout.color) mesh.colors.push_back({a[8], a[9], a[10]});
  }
  auto [positions, origin] = near_positions(places);
  mesh.positions = std::move(positions), mesh.origin = origin;
}

struct FaceReader {
  PlyBody& body;
  MeshData& mesh;
  std::uint64_t vertices;  // of the file: faces may come before them
  std::size_t small = 0, large = 0;

  std::uint32_t index(PlyType type) {
    const double value = body.value(type);
    if (!(value >= 0 && value < static_cast<double>(vertices)) || value != std::floor(value))
      body.fail("no vertex " + std::to_string(static_cast<long long>(std::isfinite(value) ? value : -1)) +
                ": there are " + std::to_string(vertices));
    return static_cast<std::uint32_t>(value);
  }

  void polygon(const PlyProperty& property) {
    const std::size_t n = body.list_length(property);
    std::uint32_t first = 0, previous = 0;
    for (std::size_t k = 0; k < n; ++k) {
      const std::uint32_t corner = index(property.type);
      if (k == 0) first = corner;
      if (k >= 2) mesh.indices.insert(mesh.indices.end(), {first, previous, corner});
      previous = corner;
    }
    small += n < 3;
    large += n > 4;
  }
};

void read_faces(const PlyElement& element, PlyBody& body, std::uint64_t vertices, MeshData& mesh) {
  const int list = element.find({"vertex_indices", "vertex_index"}, true);
  if (list < 0) body.fail("the faces have no list 'vertex_indices'");
  FaceReader reader{body, mesh, vertices};
  mesh.indices.reserve(3 * static_cast<std::size_t>(element.count));
  for (std::uint64_t k = 0; k < element.count; ++k) {
    body.enter(element, k);
    for (std::size_t j = 0; j < element.properties.size(); ++j) {
      if (static_cast<int>(j) == list)
        reader.polygon(element.properties[j]);
      else
        body.skip(element.properties[j]);
    }
  }
  if (reader.small > 0)
    mesh.left_out.push_back(std::to_string(reader.small) + (reader.small == 1 ? " face" : " faces") +
                            " with fewer than 3 corners");
  if (reader.large > 0)
    mesh.mended.push_back({std::to_string(reader.large) + " polygons of more than 4 corners",
                           "fans of triangles (wrong where they are not convex)"});
}

void skip_element(const PlyElement& element, PlyBody& body) {
  // Nothing to skip, however many there are said to be.
  if (element.properties.empty()) return;
  for (std::uint64_t k = 0; k < element.count; ++k) {
    body.enter(element, k);
    for (const PlyProperty& p : element.properties) body.skip(p);
  }
}

}  // namespace

MeshData parse_ply(const std::string& bytes, const std::string& filename) {
  const PlyHeader header = parse_ply_header(bytes, filename);
  PlyBody body(bytes, header, filename);
  std::uint64_t vertices = 0;
  for (const PlyElement& e : header.elements)
    if (e.name == "vertex") vertices = e.count;
  MeshData mesh;
  bool seen_vertices = false, seen_faces = false;
  for (const PlyElement& e : header.elements) {
    check_count(e, body);
    bool& seen = e.name == "vertex" ? seen_vertices : seen_faces;
    if (e.name != "vertex" && e.name != "face") {
      skip_element(e, body);
      continue;
    }
    if (seen) body.fail("the element appears twice");
    seen = true;
    if (e.name == "vertex")
      read_vertices(e, body, filename, mesh);
    else
      read_faces(e, body, vertices, mesh);
  }
  if (mesh.positions.size() != vertices) throw InternalError("PLY vertices were miscounted");
  return checked(std::move(mesh), filename);
}

}  // namespace lumirank::scenedesc
