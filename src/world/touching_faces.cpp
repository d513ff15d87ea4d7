#include "world/touching_faces.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <set>

#include "base/bounds.h"
#include "base/parallel.h"
#include "world/surface.h"
#include "world/world.h"

namespace lumirank::world {
namespace {

using geometry::Placement;
using geometry::TriangleMesh;

// In steps by which rays leave a surface: how far apart faces touch, before and behind the other one; and how
// far behind it they are in the end, where rays end there and where they go on.
constexpr float kBefore = 1.5f, kBehind = 0.25f, kSunk = 0.5f, kSunkIntoGlass = 3;
constexpr float kParallel = 0.99f;  // cosine
// Of all area: that of a closed mesh's faces points in all directions alike; and its volume, over its area
// and size, is more than a sheet of two faces has by rounding.
constexpr float kOpen = 1e-3f, kVolume = 1e-5f;
// Closed meshes of so few triangles are compared face by face, others as boxes.
constexpr std::size_t kFewTriangles = 64;
// Triangles of either kind that are looked at, at most: meshes beyond these are left out.
constexpr std::size_t kMaxLookedAt = std::size_t{1} << 20;

struct Face {
  std::array<Vec3f, 3> corners;
  Vec3f outward;  // unit
  std::uint32_t placement, triangle;
};

float step_at(Vec3f place, Vec3f n) { return length(World::offset_origin(place, n, n) - place); }

// Its middle and three places near its corners.
std::array<Vec3f, 4> places_on(const Face& face) {
  constexpr float kNear = 0.9f, kFar = 0.05f;
  const auto& [a, b, c] = face.corners;
  return {(a + b + c) * (1.0f / 3), a * kNear + (b + c) * kFar, b * kNear + (c + a) * kFar,
          c * kNear + (a + b) * kFar};
}

Bounds3f around(std::span<const Face> faces) {
  Bounds3f box;
  for (const Face& face : faces)
    for (const Vec3f corner : face.corners) box.extend(corner);
  if (box.empty()) return box;
  const Vec3f far = max(max(box.lo, -box.lo), max(box.hi, -box.hi));
  const float size = std::max({far.x, far.y, far.z});
  const float room = 2 * kBefore * step_at({size, size, size}, {1, 0, 0});
  box.lo = box.lo - Vec3f{room, room, room}, box.hi = box.hi + Vec3f{room, room, room};
  return box;
}

bool overlap(const Bounds3f& a, const Bounds3f& b) {
  return a.lo.x <= b.hi.x && b.lo.x <= a.hi.x && a.lo.y <= b.hi.y && b.lo.y <= a.hi.y && a.lo.z <= b.hi.z &&
         b.lo.z <= a.hi.z;
}

std::vector<Face> faces_of(const TriangleMesh& mesh, const Placement& placed, std::uint32_t number) {
  std::vector<Face> faces;
  faces.reserve(mesh.triangle_count());
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
    Face face{.corners = {}, .outward = {}, .placement = number, .triangle = static_cast<std::uint32_t>(t)};
    for (std::size_t c = 0; c < 3; ++c)
      face.corners[c] = placed.to_world.point(mesh.positions[mesh.indices[3 * t + c]]);
    const Vec3f area = cross(face.corners[1] - face.corners[0], face.corners[2] - face.corners[0]);
    if (!(length_squared(area) > 0)) continue;
    face.outward = normalize(area);
    faces.push_back(face);
  }
  return faces;
}

// Empty unless the mesh encloses a volume; its normals look outward then.
std::vector<Face> closed_faces_of(const TriangleMesh& mesh, const Placement& placed, std::uint32_t number) {
  std::vector<Face> faces = faces_of(mesh, placed, number);
  const Bounds3f box = around(faces);
  Vec3d sum{0, 0, 0};
  double area = 0, volume = 0;
  for (const auto& [corners, outward, placement, triangle] : faces) {
    const Vec3f twice = cross(corners[1] - corners[0], corners[2] - corners[0]);
    sum = sum + Vec3d{twice.x, twice.y, twice.z};
    area += length(twice);
    volume += dot(twice, corners[0] - box.center());
  }
  const double open = std::sqrt(sum.x * sum.x + sum.y * sum.y + sum.z * sum.z);
  if (!(area > 0) || open > kOpen * area || std::abs(volume) < kVolume * area * box.radius()) return {};
  if (volume < 0)
    for (Face& face : faces) face.outward = -face.outward;
  return faces;
}

// Their normals look to where they shine. Meshes that shine stand in the world as they are.
std::vector<Face> shining_faces_of(const TriangleMesh& mesh, const Placement& placed, std::uint32_t number) {
  std::vector<Face> faces = faces_of(mesh, placed, number);
  for (Face& face : faces) face.outward = outside_normal(mesh, face.triangle);
  return faces;
}

TriangleMesh mesh_of(std::span<const Face> faces) {
  TriangleMesh mesh;
  mesh.positions.reserve(3 * faces.size());
  for (const Face& face : faces)
    for (const Vec3f corner : face.corners) {
      mesh.indices.push_back(static_cast<std::uint32_t>(mesh.positions.size()));
      mesh.positions.push_back(corner);
    }
  return mesh;
}

class TouchingFaces {
 public:
  TouchingFaces(std::vector<TriangleMesh>& meshes, std::span<const Placement> placements,
                std::span<const Part> parts, bool lamps)
      : meshes_(meshes), placements_(placements), parts_(parts), sizes_(placements.size(), 0.0f) {
    const auto moves = [&](Part part) { return lamps ? part == Part::lamp : is_entered(part); };
    const auto stays = [&](Part part) { return part == Part::opaque || (!lamps && part == Part::lamp); };
    for (std::uint32_t i = 0; i < placements.size(); ++i)
      if (moves(parts[i])) add_moving(i);
    if (moving_.empty()) return;
    for (std::uint32_t i = 0; i < placements.size(); ++i)
      if (stays(parts[i])) add_opaque(i);
  }

  std::size_t move() {
    if (moving_.empty()) return 0;
    moves_.assign(moving_.size(), 0);
    if (!opaque_.empty()) ask_moving(), ask_opaque();
    if (first_.size() > 1 && is_entered(parts_[moving_[0].placement])) ask_each_other();
    std::size_t moved = 0;
    std::map<std::uint32_t, std::vector<std::size_t>> by_placement;
    for (std::size_t f = 0; f < moving_.size(); ++f)
      if (moves_[f] > 0) by_placement[moving_[f].placement].push_back(f), ++moved;
    // What one placement of a mesh asks for is done for all.
    std::set<std::uint32_t> done;
    for (const auto& [placement, faces] : by_placement)
      if (done.insert(placements_[placement].mesh).second) move(placements_[placement], faces);
    return moved;
  }

 private:
  static bool is_entered(Part part) { return part == Part::clear || part == Part::medium; }

  void add_moving(std::uint32_t i) {
    const TriangleMesh& mesh = meshes_[placements_[i].mesh];
    if (may_move_ + mesh.triangle_count() > kMaxLookedAt) return;
    may_move_ += mesh.triangle_count();
    const std::vector<Face> faces = parts_[i] == Part::lamp ? shining_faces_of(mesh, placements_[i], i)
                                                            : closed_faces_of(mesh, placements_[i], i);
    if (faces.empty()) return;
    first_.push_back(moving_.size());
    sizes_[i] = around(faces).radius();
    moving_.insert(moving_.end(), faces.begin(), faces.end());
    if (faces.size() > kFewTriangles) return boxes_.push_back(around(faces));
    for (const Face& face : faces) boxes_.push_back(around({&face, 1}));
  }

  void add_opaque(std::uint32_t i) {
    const TriangleMesh& mesh = meshes_[placements_[i].mesh];
    if (looked_at_ + mesh.triangle_count() > kMaxLookedAt) return;
    const Bounds3f own = mesh.bounds();
    Bounds3f whole;
    for (int k = 0; k < 8; ++k)
      whole.extend(placements_[i].to_world.point(
          {k & 1 ? own.hi.x : own.lo.x, k & 2 ? own.hi.y : own.lo.y, k & 4 ? own.hi.z : own.lo.z}));
    std::vector<Bounds3f> near;
    for (const Bounds3f& box : boxes_)
      if (overlap(box, whole)) near.push_back(box);
    if (near.empty()) return;
    looked_at_ += mesh.triangle_count();
    for (const Face& face : faces_of(mesh, placements_[i], i)) {
      Bounds3f of_face;
      for (const Vec3f corner : face.corners) of_face.extend(corner);
      if (std::any_of(near.begin(), near.end(), [&](const Bounds3f& box) { return overlap(box, of_face); }))
        opaque_.push_back(face);
    }
  }

  // How far a face must go to be behind what is `ahead` of it; 0: that does not touch it.
  static float way(float ahead, float step, float sunk) {
    return ahead > -kBehind * step && ahead < kBefore * step ? ahead + sunk * step : 0.0f;
  }

  void ask_moving() {
    const geometry::RayScene rays({mesh_of(opaque_)}, {{}}, {});
    parallel_for(moving_.size(), 64, [&](std::size_t begin, std::size_t end) {
      for (std::size_t f = begin; f < end; ++f)
        for (const Vec3f place : places_on(moving_[f])) {
          const Vec3f n = moving_[f].outward;
          const float step = step_at(place, n);
          const auto hit = rays.intersect({place + n * (kBefore * step), -n, 0, (kBefore + kBehind) * step});
          if (hit && std::abs(dot(opaque_[hit->triangle].outward, n)) > kParallel)
            moves_[f] = std::max(moves_[f], way(kBefore * step - hit->t, step, kSunk));
        }
    });
  }

  void ask_opaque() {
    const geometry::RayScene rays({mesh_of(moving_)}, {{}}, {});
    struct Touch {
      std::uint32_t face = 0;
      float way = 0;
    };
    std::vector<std::array<Touch, 4>> touches(opaque_.size());
    parallel_for(opaque_.size(), 64, [&](std::size_t begin, std::size_t end) {
      for (std::size_t f = begin; f < end; ++f) {
        const Vec3f n = opaque_[f].outward;
        const auto places = places_on(opaque_[f]);
        for (std::size_t k = 0; k < places.size(); ++k) {
          const float step = step_at(places[k], n), reach = kBefore * step;
          const auto hit = rays.intersect({places[k] + n * reach, -n, 0, 2 * reach});
          if (!hit) continue;
          const float cosine = dot(moving_[hit->triangle].outward, n);
          if (std::abs(cosine) > kParallel)
            touches[f][k] = {hit->triangle, way(cosine > 0 ? hit->t - reach : reach - hit->t, step, kSunk)};
        }
      }
    });
    for (const auto& of_face : touches)
      for (const Touch& touch : of_face) moves_[touch.face] = std::max(moves_[touch.face], touch.way);
  }

  // Of two closed meshes that touch.
  bool goes_into(std::uint32_t one, std::uint32_t other) const {
    if (parts_[one] == Part::medium || parts_[other] == Part::medium)
      return parts_[one] != parts_[other] && parts_[one] == Part::medium;
    return sizes_[one] < sizes_[other] || (sizes_[one] == sizes_[other] && one < other);
  }

  void ask_each_other() {
    // Each apart, and so that rays are told of every crossing.
    std::vector<TriangleMesh> meshes;
    std::vector<Placement> placements(first_.size());
    for (std::size_t k = 0; k < first_.size(); ++k) {
      const std::size_t end = k + 1 < first_.size() ? first_[k + 1] : moving_.size();
      meshes.push_back(mesh_of(std::span(moving_).subspan(first_[k], end - first_[k])));
      placements[k].mesh = static_cast<std::uint32_t>(k);
      placements[k].blocking = geometry::Blocking::attenuating;
    }
    const geometry::RayScene rays(std::move(meshes), std::move(placements), {});
    parallel_for(moving_.size(), 64, [&](std::size_t begin, std::size_t end) {
      std::vector<geometry::Hit> hits;
      for (std::size_t f = begin; f < end; ++f)
        for (const Vec3f place : places_on(moving_[f])) {
          const Vec3f n = moving_[f].outward;
          const float step = step_at(place, n);
          hits.clear();
          rays.crossings({place + n * (kBefore * step), -n, 0, (kBefore + kBehind) * step}, hits);
          for (const geometry::Hit& hit : hits) {
            const Face& other = moving_[first_[hit.instance] + hit.triangle];
            if (other.placement != moving_[f].placement && dot(other.outward, n) < -kParallel &&
                goes_into(moving_[f].placement, other.placement))
              moves_[f] = std::max(moves_[f], way(kBefore * step - hit.t, step, kSunkIntoGlass));
          }
        }
    });
  }

  // Corners at the same place go together, each as far as the faces that meet there ask.
  void move(const Placement& placed, const std::vector<std::size_t>& faces) {
    TriangleMesh& mesh = meshes_[placed.mesh];
    const auto key = [&](std::uint32_t vertex) {
      const Vec3f p = mesh.positions[vertex];
      return std::array<float, 3>{p.x, p.y, p.z};
    };
    std::map<std::array<float, 3>, Vec3f> ways;
    // Several times, since what a later face asks takes from an earlier one's at a sharp edge.
    constexpr int kRounds = 16;
    for (int round = 0; round < kRounds; ++round)
      for (const std::size_t f : faces)
        for (std::size_t c = 0; c < 3; ++c) {
          Vec3f& way =
              ways.try_emplace(key(mesh.indices[3 * moving_[f].triangle + c]), Vec3f{0, 0, 0}).first->second;
          const Vec3f n = moving_[f].outward;
          way += n * std::max(0.0f, moves_[f] - dot(way, n));
        }
    const auto inverse = placed.to_world.inverse();
    if (!inverse) return;
    for (std::uint32_t v = 0; v < mesh.positions.size(); ++v)
      if (const auto way = ways.find(key(v)); way != ways.end())
        mesh.positions[v] += inverse->vector(way->second);
  }

  std::vector<TriangleMesh>& meshes_;
  std::span<const Placement> placements_;
  std::span<const Part> parts_;
  std::vector<float> sizes_;  // of placements that may move
  std::vector<Face> moving_, opaque_;
  std::vector<Bounds3f> boxes_;
  std::vector<float> moves_;                  // of the moving ones
  std::size_t may_move_ = 0, looked_at_ = 0;  // triangles
  std::vector<std::size_t> first_;            // of the moving ones of each placement that has some
};

}  // namespace

std::size_t part_touching_faces(std::vector<TriangleMesh>& meshes, std::span<const Placement> placements,
                                std::span<const Part> parts) {
  // Lamps first, since glass goes behind them.
  const std::size_t lamps = TouchingFaces(meshes, placements, parts, true).move();
  return lamps + TouchingFaces(meshes, placements, parts, false).move();
}

}  // namespace lumirank::world
