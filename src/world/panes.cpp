#include "world/panes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <numeric>
#include <vector>

#include "base/frame.h"
#include "geometry/ray_scene.h"

namespace lumirank::world {
namespace {

// Of the area that the two faces must have, and by how much one may be larger than the other.
constexpr float kFaces = 0.75f, kUnlike = 1.1f;
constexpr float kParallel = 0.9998f;  // cosine
constexpr float kThin = 0.1f;         // times the root of a face's area
// More triangles are no window.
constexpr std::size_t kMaxTriangles = 1 << 17;
// Walls: how parallel (cosine, of some 4 degrees) the faces are between which a ray goes that far from the
// normal (sine), and from how many triangles at most it is asked.
constexpr float kParallelOfWall = 0.9975f, kAslant = 0.5f;
constexpr std::size_t kAskedTriangles = 4096;

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

// Of one mesh in the world, with the normals by which light is bent.
class Walls {
 public:
  Walls(const geometry::TriangleMesh& mesh, const Transform& to_world)
      : rays_({placed(mesh, to_world)}, {{}}, {}), mesh_(rays_.mesh(0)) {}

  // Whether most of all its faces are those of thin walls.
  bool are_all() const {
    const std::size_t count = mesh_.triangle_count(), step = (count + kAskedTriangles - 1) / kAskedTriangles;
    float all = 0, thin = 0, whole = 0;
    for (std::size_t t = 0; t < count; ++t) whole += length(mesh_.area_vector(t));
    const float most = kThin * std::sqrt(0.5f * whole);  // the two faces share the area
    for (std::size_t t = 0; t < count; t += step) {
      const float area = length(mesh_.area_vector(t));
      all += area;
      if (area > 0) thin += area * part_that_is_thin(static_cast<std::uint32_t>(t), most);
    }
    return all > 0 && thin >= kFaces * all;
  }

 private:
  static geometry::TriangleMesh placed(geometry::TriangleMesh mesh, const Transform& to_world) {
    const Transform inverse = to_world.inverse().value_or(Transform{});
    for (Vec3f& p : mesh.positions) p = to_world.point(p);
    for (Vec3f& n : mesh.normals) n = Transform::normal(inverse, n);
    // Faces look outward by the order of their corners, which a mirror turns round.
    if (to_world.determinant3() < 0)
      for (std::size_t t = 0; t < mesh.triangle_count(); ++t)
        std::swap(mesh.indices[3 * t + 1], mesh.indices[3 * t + 2]);
    return mesh;
  }

  Vec3f normal(std::uint32_t t, Vec2f at) const {
    if (!mesh_.normals.empty()) {
      const auto of = [&](std::size_t c) { return mesh_.normals[mesh_.indices[3 * t + c]]; };
      const Vec3f smooth = of(0) * (1 - at.x - at.y) + of(1) * at.x + of(2) * at.y;
      if (length_squared(smooth) > 0) return normalize(smooth);
    }
    return normalize(mesh_.area_vector(t));
  }

  // Of its middle and three places near its corners.
  float part_that_is_thin(std::uint32_t t, float most) const {
    constexpr float kThird = 1.0f / 3, kNear = 0.9f, kFar = 0.05f;
    int thin = 0;
    for (const Vec2f at : {Vec2f{kThird, kThird}, Vec2f{kFar, kFar}, Vec2f{kNear, kFar}, Vec2f{kFar, kNear}})
      thin += is_thin_at(t, at, most) ? 1 : 0;
    return 0.25f * static_cast<float>(thin);
  }

  bool is_thin_at(std::uint32_t t, Vec2f at, float most) const {
    const Vec3f n = normal(t, at);
    const auto corner = [&](std::size_t c) { return mesh_.positions[mesh_.indices[3 * t + c]]; };
    const Vec3f place = corner(0) * (1 - at.x - at.y) + corner(1) * at.x + corner(2) * at.y;
    const Frame frame = Frame::from_normal(n);
    const float along = std::sqrt(1 - kAslant * kAslant);
    for (const Vec3f beside : {frame.s, -frame.s, frame.t, -frame.t}) {
      const geometry::Ray ray{place, beside * kAslant - n * along, 1e-3f * most, 2 * most};
      const auto hit = rays_.intersect(ray);
      if (!hit || along * hit->t > most || dot(normal(hit->triangle, hit->barycentric), n) > -kParallelOfWall)
        return false;
    }
    return true;
  }

  geometry::RayScene rays_;
  const geometry::TriangleMesh& mesh_;
};

geometry::TriangleMesh part_of(const geometry::TriangleMesh& mesh, const Triangles& triangles) {
  geometry::TriangleMesh part;
  part.positions = mesh.positions, part.normals = mesh.normals;
  for (const std::uint32_t t : triangles)
    part.indices.insert(part.indices.end(), mesh.indices.begin() + 3 * t, mesh.indices.begin() + 3 * t + 3);
  return part;
}

}  // namespace

bool is_made_of_panes(const geometry::TriangleMesh& mesh, const Transform& to_world) {
  const std::size_t count = mesh.triangle_count();
  if (count == 0 || count > kMaxTriangles) return false;
  const PlacedMesh placed{mesh, to_world};
  const std::vector<Triangles> parts = parts_of(mesh);
  const auto is_thin = [&](const Triangles& t) {
    return is_plate(placed, t) || Walls(parts.size() == 1 ? mesh : part_of(mesh, t), to_world).are_all();
  };
  if (std::all_of(parts.begin(), parts.end(), is_thin)) return true;
  Triangles all(count);
  std::iota(all.begin(), all.end(), 0u);
  return is_plate(placed, all) || (parts.size() > 1 && Walls(mesh, to_world).are_all());
}

}  // namespace lumirank::world
