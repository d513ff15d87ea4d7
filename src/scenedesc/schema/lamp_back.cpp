#include "scenedesc/schema/lamp_back.h"

#include <algorithm>
#include <array>
#include <bit>
#include <memory>
#include <utility>
#include <vector>

namespace lumirank::scenedesc {
namespace {

MeshData moved(const MeshData& mesh, float distance) {
  MeshData out = mesh;
  std::vector<Vec3f> normals = mesh.normals;
  if (normals.empty()) {
    normals.resize(mesh.positions.size());
    for (std::size_t t = 0; t + 2 < mesh.indices.size(); t += 3) {
      const auto* k = &mesh.indices[t];
      const Vec3f a = mesh.positions[k[0]];
      const Vec3f n = cross(mesh.positions[k[1]] - a, mesh.positions[k[2]] - a);
      for (int i = 0; i < 3; ++i) normals[k[i]] += n;
    }
  }
  for (std::size_t i = 0; i < normals.size(); ++i)
    if (const float len = length(normals[i]); len > 0) out.positions[i] += normals[i] * (distance / len);
  return out;
}

// The first corner at the same place, for each.
std::vector<std::uint32_t> welded(const MeshData& mesh) {
  const std::size_t n = mesh.positions.size();
  const auto key = [&](std::uint32_t k) {
    const Vec3f p = mesh.positions[k] + Vec3f{};  // -0 is 0
    return std::array{p.x, p.y, p.z};
  };
  std::vector<std::uint32_t> order(n), first(n);
  for (std::size_t k = 0; k < n; ++k) order[k] = static_cast<std::uint32_t>(k);
  std::sort(order.begin(), order.end(), [&](auto a, auto b) { return key(a) < key(b); });
  for (std::size_t k = 0; k < n; ++k)
    first[order[k]] = k > 0 && key(order[k]) == key(order[k - 1]) ? first[order[k - 1]] : order[k];
  return first;
}

}  // namespace

ShapeDesc back_of(const ShapeDesc& front) {
  constexpr float kGap = 1e-4f;
  ShapeDesc out = front;
  out.flip_normals = !front.flip_normals;
  std::swap(out.media.inside, out.media.outside);
  const float side = front.flip_normals ? 1 : -1;
  if (auto* sphere = std::get_if<SphereDesc>(&out.kind)) {
    sphere->radius *= 1 + side * kGap;
    return out;
  }
  const auto& held = std::get<InlineMeshDesc>(front.kind);
  Vec3f low(held.mesh->positions[0]), high = low;
  for (const Vec3f& p : held.mesh->positions) low = min(low, p), high = max(high, p);
  const Vec3f far = max(max(low, -low), max(high, -high));
  out.kind = InlineMeshDesc{std::make_shared<const MeshData>(
                                moved(*held.mesh, side * kGap * (length(high - low) + 0.1f * length(far)))),
                            held.name + " (back)"};
  return out;
}

bool is_closed_outwards(const MeshData& mesh) {
  const std::vector<std::uint32_t> corner = welded(mesh);
  // Every edge is walked once in each direction; degenerate triangles bound nothing.
  std::vector<std::pair<std::uint32_t, std::uint32_t>> edges;
  double volume = 0;
  for (std::size_t t = 0; t + 2 < mesh.indices.size(); t += 3) {
    const std::uint32_t c[3] = {corner[mesh.indices[t]], corner[mesh.indices[t + 1]],
                                corner[mesh.indices[t + 2]]};
    if (c[0] == c[1] || c[1] == c[2] || c[2] == c[0]) continue;
    for (int k = 0; k < 3; ++k) edges.emplace_back(c[k], c[(k + 1) % 3]);
    volume += dot(mesh.positions[c[0]], cross(mesh.positions[c[1]], mesh.positions[c[2]]));
  }
  if (edges.empty() || !(volume > 0)) return false;
  std::sort(edges.begin(), edges.end());
  if (std::adjacent_find(edges.begin(), edges.end()) != edges.end()) return false;
  return std::all_of(edges.begin(), edges.end(), [&](const auto& edge) {
    return std::binary_search(edges.begin(), edges.end(), std::pair{edge.second, edge.first});
  });
}

}  // namespace lumirank::scenedesc
