#include "world/panes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <numeric>
#include <vector>

namespace lumirank::world {
namespace {

// Of the area that the two faces must have, and by how much one may be larger than the other.
constexpr float kFaces = 0.75f, kUnlike = 1.1f;
constexpr float kParallel = 0.9998f;  // cosine
constexpr float kThin = 0.1f;         // times the root of a face's area
// More triangles are no window.
constexpr std::size_t kMaxTriangles = 1 << 16;

using Triangles = std::vector<std::uint32_t>;

// Numbers of triangles, by the parts that hang together at corners of the same place.
std::vector<Triangles> parts_of(const geometry::TriangleMesh& mesh) {
  std::map<std::array<float, 3>, std::uint32_t> places;
  std::vector<std::uint32_t> place(mesh.positions.size());
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    const Vec3f p = mesh.positions[v];
    place[v] = places.try_emplace({p.x, p.y, p.z}, static_cast<std::uint32_t>(places.size())).first->second;
  }
  std::vector<std::uint32_t> root(places.size());
  std::iota(root.begin(), root.end(), 0u);
  const auto find = [&](std::uint32_t k) {
    while (root[k] != k) k = root[k] = root[root[k]];
    return k;
  };
  const auto corner = [&](std::size_t t, std::size_t c) { return find(place[mesh.indices[3 * t + c]]); };
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t)
    for (std::size_t c = 1; c < 3; ++c) root[corner(t, c)] = corner(t, 0);
  std::map<std::uint32_t, Triangles> parts;
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t)
    parts[corner(t, 0)].push_back(static_cast<std::uint32_t>(t));
  std::vector<Triangles> result;
  result.reserve(parts.size());
  for (auto& [at, triangles] : parts) result.push_back(std::move(triangles));
  return result;
}

struct PlacedMesh {
  const geometry::TriangleMesh& mesh;
  const Transform& to_world;

  Vec3f corner(std::uint32_t t, std::size_t c) const {
    return to_world.point(mesh.positions[mesh.indices[3 * t + c]]);
  }
  Vec3f area_vector(std::uint32_t t) const {
    return cross(corner(t, 1) - corner(t, 0), corner(t, 2) - corner(t, 0)) * 0.5f;
  }
};

bool is_plate(const PlacedMesh& mesh, const Triangles& triangles) {
  Vec3f largest{0, 0, 0};
  float all = 0;
  for (const std::uint32_t t : triangles) {
    const Vec3f a = mesh.area_vector(t);
    if (length_squared(a) > length_squared(largest)) largest = a;
    all += length(a);
  }
  if (!(all > 0)) return false;
  const Vec3f n = normalize(largest);
  float up = 0, down = 0, low = kInfinity, high = -kInfinity;
  for (const std::uint32_t t : triangles) {
    const Vec3f a = mesh.area_vector(t);
    if (dot(a, n) > kParallel * length(a)) up += length(a);
    if (dot(a, n) < -kParallel * length(a)) down += length(a);
    for (std::size_t c = 0; c < 3; ++c) {
      const float along = dot(mesh.corner(t, c) - mesh.corner(triangles[0], 0), n);
      low = std::min(low, along), high = std::max(high, along);
    }
  }
  const float smaller = std::min(up, down);
  return up + down >= kFaces * all && std::max(up, down) <= kUnlike * smaller && high > low &&
         high - low <= kThin * std::sqrt(smaller);
}

}  // namespace

bool is_made_of_panes(const geometry::TriangleMesh& mesh, const Transform& to_world) {
  const std::size_t count = mesh.triangle_count();
  if (count == 0 || count > kMaxTriangles) return false;
  const PlacedMesh placed{mesh, to_world};
  const std::vector<Triangles> parts = parts_of(mesh);
  if (std::all_of(parts.begin(), parts.end(), [&](const Triangles& t) { return is_plate(placed, t); }))
    return true;
  Triangles all(count);
  std::iota(all.begin(), all.end(), 0u);
  return is_plate(placed, all);
}

}  // namespace lumirank::world
