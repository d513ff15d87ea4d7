#include "scenedesc/meshes/loop_subdivision.h"

#include <algorithm>
#include <array>

#include "scenedesc/meshes/mesh_parts.h"

namespace lumirank::scenedesc {
namespace {

struct MeshEdge {
  std::uint32_t a, b;       // a < b
  std::uint32_t triangles;  // that have it
  Vec3f opposite{};         // sum of their third corners
};

// The edges of a mesh in the order of their vertices, and for each corner the edge that begins there.
struct Edges {
  std::vector<MeshEdge> edges;
  std::vector<std::uint32_t> of_corner;
};

Edges edges_of(const MeshData& mesh) {
  struct Side {
    std::uint32_t a, b, corner;
  };
  std::vector<Side> sides;
  sides.reserve(mesh.indices.size());
  for (std::uint32_t k = 0; k < mesh.indices.size(); ++k) {
    const std::uint32_t first = k / 3 * 3, from = mesh.indices[k], to = mesh.indices[first + (k + 1) % 3];
    sides.push_back({std::min(from, to), std::max(from, to), k});
  }
  std::sort(sides.begin(), sides.end(), [](const Side& x, const Side& y) {
    return std::array{x.a, x.b, x.corner} < std::array{y.a, y.b, y.corner};
  });
  Edges out;
  out.of_corner.resize(mesh.indices.size());
  for (const Side& side : sides) {
    if (out.edges.empty() || out.edges.back().a != side.a || out.edges.back().b != side.b)
      out.edges.push_back({side.a, side.b, 0});
    MeshEdge& edge = out.edges.back();
    ++edge.triangles;
    edge.opposite += mesh.positions[mesh.indices[side.corner / 3 * 3 + (side.corner + 2) % 3]];
    out.of_corner[side.corner] = static_cast<std::uint32_t>(out.edges.size() - 1);
  }
  return out;
}

// What a vertex has around it.
struct Around {
  Vec3f all{}, boundary{};  // sums of its neighbors, and of those along boundaries
  int valence = 0, boundaries = 0;
};

std::vector<Around> around_vertices(const MeshData& mesh, const Edges& edges) {
  std::vector<Around> out(mesh.positions.size());
  for (const MeshEdge& edge : edges.edges) {
    for (const auto& [at, other] : {std::pair{edge.a, edge.b}, std::pair{edge.b, edge.a}}) {
      Around& around = out[at];
      around.all += mesh.positions[other], ++around.valence;
      if (edge.triangles != 2) around.boundary += mesh.positions[other], ++around.boundaries;
    }
  }
  return out;
}

float weight_of_neighbor(int valence) {
  return valence == 3 ? 3.0f / 16 : 3.0f / (8 * static_cast<float>(valence));
}

// Where boundaries meet or end, as at the corner of two sheets, the vertex stays.
bool stays(const Around& around) {
  return around.valence == 0 || (around.boundaries != 0 && around.boundaries != 2);
}

MeshData divided(const MeshData& mesh) {
  const Edges edges = edges_of(mesh);
  const auto around = around_vertices(mesh, edges);
  MeshData out;
  out.origin = mesh.origin;
  const std::size_t old_vertices = mesh.positions.size();
  out.positions.reserve(old_vertices + edges.edges.size());
  for (std::size_t v = 0; v < old_vertices; ++v) {
    const Around& a = around[v];
    const Vec3f p = mesh.positions[v];
    const float w = weight_of_neighbor(std::max(1, a.valence)), n = static_cast<float>(a.valence);
    out.positions.push_back(stays(a)            ? p
                            : a.boundaries == 2 ? p * 0.75f + a.boundary * 0.125f
                                                : p * (1 - n * w) + a.all * w);
  }
  for (const MeshEdge& edge : edges.edges) {
    const Vec3f ends = mesh.positions[edge.a] + mesh.positions[edge.b];
    out.positions.push_back(edge.triangles == 2 ? ends * 0.375f + edge.opposite * 0.125f : ends * 0.5f);
  }
  out.indices.reserve(4 * mesh.indices.size());
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
    const std::uint32_t* corner = &mesh.indices[3 * t];
    std::uint32_t middle[3];
    for (std::size_t k = 0; k < 3; ++k)
      middle[k] = static_cast<std::uint32_t>(old_vertices) + edges.of_corner[3 * t + k];
    for (std::size_t k = 0; k < 3; ++k)
      out.indices.insert(out.indices.end(), {corner[k], middle[k], middle[(k + 2) % 3]});
    out.indices.insert(out.indices.end(), {middle[0], middle[1], middle[2]});
  }
  return out;
}

void move_to_limit(MeshData& mesh) {
  const auto around = around_vertices(mesh, edges_of(mesh));
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    const Around& a = around[v];
    if (stays(a)) continue;
    Vec3f& p = mesh.positions[v];
    if (a.boundaries == 2) {
      p = p * 0.6f + a.boundary * 0.2f;
      continue;
    }
    const float n = static_cast<float>(a.valence);
    const float w = 1 / (n + 3 / (8 * weight_of_neighbor(a.valence)));
    p = p * (1 - n * w) + a.all * w;
  }
}

}  // namespace

MeshData loop_subdivided(const MeshData& control, int levels) {
  MeshData mesh;
  mesh.origin = control.origin;
  mesh.positions = control.positions;
  // An edge from a vertex to itself has no other side.
  for (std::size_t t = 0; t < control.triangle_count(); ++t) {
    const std::uint32_t* c = &control.indices[3 * t];
    if (c[0] != c[1] && c[1] != c[2] && c[2] != c[0]) mesh.indices.insert(mesh.indices.end(), c, c + 3);
  }
  for (int level = 0; level < levels; ++level) mesh = divided(mesh);
  move_to_limit(mesh);
  make_smooth_normals(mesh);
  return mesh;
}

}  // namespace lumirank::scenedesc
