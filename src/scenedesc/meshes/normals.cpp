// Making normals. Sums run in the order of the triangles, in double precision.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>
#include <tuple>
#include <utility>

#include "scenedesc/meshes/mesh_parts.h"

namespace lumirank::scenedesc {
namespace {

using Vector = std::array<double, 3>;

Vector operator-(const Vector& a, const Vector& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
double inner(const Vector& a, const Vector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Vector outer(const Vector& a, const Vector& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
Vector widened(Vec3f p) { return {p.x, p.y, p.z}; }
Vector unit(const Vector& a) {
  const double len = std::sqrt(inner(a, a));
  return len > 0 ? Vector{a[0] / len, a[1] / len, a[2] / len} : Vector{0, 0, 0};
}
Vec3f narrowed(const Vector& a) { return {float(a[0]), float(a[1]), float(a[2])}; }

// A triangle's unit normal, scaled for each corner by the angle there.
struct Face {
  Vector normal;
  std::array<double, 3> angle;
};

Face face(const MeshData& mesh, std::size_t triangle) {
  const std::uint32_t* corner = &mesh.indices[3 * triangle];
  const std::array<Vector, 3> p{widened(mesh.positions[corner[0]]), widened(mesh.positions[corner[1]]),
                                widened(mesh.positions[corner[2]])};
  Face f{unit(outer(p[1] - p[0], p[2] - p[0])), {}};
  for (int c = 0; c < 3; ++c) {
    const Vector a = p[(c + 1) % 3] - p[c], b = p[(c + 2) % 3] - p[c];
    const Vector n = outer(a, b);
    f.angle[c] = std::atan2(std::sqrt(inner(n, n)), inner(a, b));
  }
  return f;
}

void add(Vector& sum, const Vector& n, double weight) {
  for (int i = 0; i < 3; ++i) sum[i] += weight * n[i];
}

// Where faces cancel each other, any direction is as good; unused vertices get it too.
Vec3f finished(const Vector& sum) {
  const Vector n = unit(sum);
  return inner(n, n) > 0 ? narrowed(n) : Vec3f{0, 0, 1};
}

// For each vertex the first vertex (in a sorted order) at exactly the same place.
std::vector<std::uint32_t> weld(const std::vector<Vec3f>& positions) {
  std::vector<std::uint32_t> order(positions.size()), place(positions.size());
  std::iota(order.begin(), order.end(), 0u);
  auto key = [&](std::uint32_t k) {
    const Vec3f p = positions[k];
    return std::array<float, 3>{p.x, p.y, p.z};
  };
  std::sort(order.begin(), order.end(),
            [&](std::uint32_t a, std::uint32_t b) { return std::pair(key(a), a) < std::pair(key(b), b); });
  for (std::size_t k = 0; k < order.size(); ++k)
    place[order[k]] = k > 0 && key(order[k]) == key(order[k - 1]) ? place[order[k - 1]] : order[k];
  return place;
}

struct UnionFind {
  std::vector<std::uint32_t> parent;
  explicit UnionFind(std::size_t n) : parent(n) { std::iota(parent.begin(), parent.end(), 0u); }
  std::uint32_t find(std::uint32_t k) {
    while (parent[k] != k) k = parent[k] = parent[parent[k]];
    return k;
  }
  // The smaller number stands for both.
  void join(std::uint32_t a, std::uint32_t b) {
    a = find(a), b = find(b);
    parent[std::max(a, b)] = std::min(a, b);
  }
};

// Corners (3·triangle + c) that share a normal: those at the two ends of every edge that is flat enough.
UnionFind joined_corners(const MeshData& mesh, const std::vector<Face>& faces, double min_cosine) {
  struct Edge {
    std::uint32_t lo, hi, at_lo, at_hi;  // places, and the corners of the triangle there
  };
  const std::vector<std::uint32_t> place = weld(mesh.positions);
  std::vector<Edge> edges;
  edges.reserve(mesh.indices.size());
  for (std::uint32_t k = 0; k < mesh.indices.size(); ++k) {
    const std::uint32_t next = k % 3 == 2 ? k - 2 : k + 1;
    Edge e{place[mesh.indices[k]], place[mesh.indices[next]], k, next};
    if (e.lo > e.hi) std::swap(e.lo, e.hi), std::swap(e.at_lo, e.at_hi);
    edges.push_back(e);
  }
  std::sort(edges.begin(), edges.end(), [](const Edge& a, const Edge& b) {
    return std::tie(a.lo, a.hi, a.at_lo) < std::tie(b.lo, b.hi, b.at_lo);
  });
  UnionFind groups(mesh.indices.size());
  for (std::size_t k = 1; k < edges.size(); ++k) {
    const Edge &a = edges[k - 1], &b = edges[k];
    if (a.lo != b.lo || a.hi != b.hi) continue;
    if (inner(faces[a.at_lo / 3].normal, faces[b.at_lo / 3].normal) < min_cosine) continue;
    groups.join(a.at_lo, b.at_lo);
    groups.join(a.at_hi, b.at_hi);
  }
  return groups;
}

}  // namespace

void make_smooth_normals(MeshData& mesh) {
  std::vector<Vector> sum(mesh.positions.size(), Vector{0, 0, 0});
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
    const Face f = face(mesh, t);
    for (int c = 0; c < 3; ++c) add(sum[mesh.indices[3 * t + c]], f.normal, f.angle[c]);
  }
  mesh.normals.resize(sum.size());
  for (std::size_t k = 0; k < sum.size(); ++k) mesh.normals[k] = finished(sum[k]);
}

void make_creased_normals(MeshData& mesh, float max_angle) {
  std::vector<Face> faces;
  faces.reserve(mesh.triangle_count());
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) faces.push_back(face(mesh, t));
  UnionFind groups = joined_corners(mesh, faces, std::cos(max_angle * std::numbers::pi / 180));
  std::vector<Vector> sum(mesh.indices.size(), Vector{0, 0, 0});
  for (std::uint32_t k = 0; k < mesh.indices.size(); ++k)
    add(sum[groups.find(k)], faces[k / 3].normal, faces[k / 3].angle[k % 3]);

  // A vertex of the result for each pair (old vertex, group of corners).
  std::vector<std::uint32_t> order(mesh.indices.size());
  std::iota(order.begin(), order.end(), 0u);
  auto key = [&](std::uint32_t k) { return std::pair(mesh.indices[k], groups.find(k)); };
  std::sort(order.begin(), order.end(),
            [&](std::uint32_t a, std::uint32_t b) { return std::pair(key(a), a) < std::pair(key(b), b); });
  MeshData out;
  out.indices.resize(mesh.indices.size());
  out.left_out = std::move(mesh.left_out);
  out.mended = std::move(mesh.mended);
  out.origin = mesh.origin;
  for (std::size_t k = 0; k < order.size(); ++k) {
    const std::uint32_t corner = order[k], old = mesh.indices[corner];
    if (k == 0 || key(corner) != key(order[k - 1])) {
      out.positions.push_back(mesh.positions[old]);
      out.normals.push_back(finished(sum[groups.find(corner)]));
      if (!mesh.uvs.empty()) out.uvs.push_back(mesh.uvs[old]);
      if (!mesh.colors.empty()) out.colors.push_back(mesh.colors[old]);
    }
    out.indices[corner] = static_cast<std::uint32_t>(out.positions.size() - 1);
  }
  mesh = std::move(out);
}

}  // namespace lumirank::scenedesc
