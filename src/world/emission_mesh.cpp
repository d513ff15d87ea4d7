#include "world/emission_mesh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "world/surface.h"

namespace lumirank::world {

using geometry::TriangleMesh;

namespace {

// A part of so many texels a side needs no further division.
constexpr float kTexelsOfPart = 8;
// A picture of which no place is so much brighter than its mean needs none either. It is looked up about once
// for each texel, but no more often than this for each triangle that there may be.
constexpr float kUneven = 2;
constexpr double kLookupsOfTriangle = 128;

// Corners of the parts of a triangle by (i, j), i + j ≤ n: i steps of n towards corner 1, j towards corner 2.
struct Weights {
  float b0, b1, b2;
};
Weights weights_of(int i, int j, int n) {
  const auto part = [n](int k) { return static_cast<float>(k) / static_cast<float>(n); };
  return {part(n - i - j), part(i), part(j)};
}
std::size_t place_of(int i, int j, int n) {  // in a list by i, then j
  return static_cast<std::size_t>(i * (n + 1) - i * (i - 1) / 2 + j);
}

// A number for each place that corners may share, whatever their other attributes are.
std::vector<std::uint32_t> ranks_of(const std::vector<Vec3f>& positions) {
  std::map<std::array<float, 3>, std::uint32_t> known;
  std::vector<std::uint32_t> ranks;
  ranks.reserve(positions.size());
  for (const Vec3f& p : positions)
    ranks.push_back(
        known.try_emplace({p.x, p.y, p.z}, static_cast<std::uint32_t>(known.size())).first->second);
  return ranks;
}

// Of three corners, added in the order of their ranks: the triangles on both sides of an edge come to the
// same sums.
template <typename T>
T weighted(const std::vector<T>& of, const std::uint32_t* corners, const std::uint32_t* order,
           const Weights& w) {
  const float by_corner[3] = {w.b0, w.b1, w.b2};
  T sum{};
  for (int k = 0; k < 3; ++k)
    if (by_corner[order[k]] > 0) sum = sum + of[corners[order[k]]] * by_corner[order[k]];
  return sum;
}

bool is_uneven(const TriangleMesh& mesh, int texture, const scatter::TextureSet& textures, float texels,
               double max_lookups) {
  double sum = 0;
  float brightest = 0;
  const std::size_t triangles = mesh.triangle_count();
  const int n = static_cast<int>(std::min(
      std::ceil(texels), static_cast<float>(std::sqrt(2 * max_lookups / static_cast<double>(triangles)))));
  for (std::size_t t = 0; t < triangles; ++t)
    for (int i = 0; i < n; ++i)
      for (int j = 0; i + j < n; ++j) {
        const auto part = [n](int k) { return (static_cast<float>(k) + 1.0f / 3) / static_cast<float>(n); };
        const float here = luminance(textures.lookup(
            texture, interpolate_uv(mesh, static_cast<std::uint32_t>(t), {part(i), part(j)})));
        sum += static_cast<double>(here), brightest = std::max(brightest, here);
      }
  const double all = static_cast<double>(triangles) * n * (n + 1) / 2;
  return static_cast<double>(brightest) * all > static_cast<double>(kUneven) * sum;
}

TriangleMesh divided(const TriangleMesh& mesh, int n) {
  const std::vector<std::uint32_t> ranks = ranks_of(mesh.positions);
  TriangleMesh out;
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
    const std::uint32_t* corners = &mesh.indices[3 * t];
    std::uint32_t order[3] = {0, 1, 2};
    std::sort(order, order + 3,
              [&](std::uint32_t a, std::uint32_t b) { return ranks[corners[a]] < ranks[corners[b]]; });
    const auto first = static_cast<std::uint32_t>(out.positions.size());
    for (int i = 0; i <= n; ++i)
      for (int j = 0; i + j <= n; ++j) {
        const Weights w = weights_of(i, j, n);
        out.positions.push_back(weighted(mesh.positions, corners, order, w));
        out.uvs.push_back(weighted(mesh.uvs, corners, order, w));
        if (!mesh.normals.empty()) {
          const Vec3f normal = weighted(mesh.normals, corners, order, w);
          const float size = length(normal);
          out.normals.push_back(size > 0 ? normal / size : mesh.normals[corners[0]]);
        }
        if (!mesh.colors.empty()) out.colors.push_back(weighted(mesh.colors, corners, order, w));
      }
    const auto at = [&](int i, int j) { return first + static_cast<std::uint32_t>(place_of(i, j, n)); };
    for (int i = 0; i < n; ++i)
      for (int j = 0; i + j < n; ++j) {
        out.indices.insert(out.indices.end(), {at(i, j), at(i + 1, j), at(i, j + 1)});
        if (i + j < n - 1)
          out.indices.insert(out.indices.end(), {at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)});
      }
  }
  return out;
}

}  // namespace

float texels_along(const TriangleMesh& mesh, std::size_t triangle, Vec2f texels) {
  Vec2f uv[3] = {{0, 0}, {1, 0}, {0, 1}};  // as interpolate_uv() has it
  if (!mesh.uvs.empty())
    for (std::size_t k = 0; k < 3; ++k) uv[k] = mesh.uvs[mesh.indices[3 * triangle + k]];
  float longest = 0;
  for (int k = 0; k < 3; ++k) {
    const Vec2f edge = uv[(k + 1) % 3] - uv[k];
    longest = std::max(longest, std::hypot(edge.x * texels.x, edge.y * texels.y));
  }
  return std::isfinite(longest) ? longest : 0;
}

TriangleMesh divided_by_texture(TriangleMesh mesh, int texture, const scatter::TextureSet& textures,
                                std::size_t max_triangles) {
  const std::size_t triangles = mesh.triangle_count();
  if (mesh.uvs.empty() || triangles == 0) return mesh;
  const Vec2f texels = textures.texels(texture);
  float longest = 0;
  for (std::size_t t = 0; t < triangles; ++t) longest = std::max(longest, texels_along(mesh, t, texels));
  const double affordable = std::sqrt(static_cast<double>(max_triangles) / static_cast<double>(triangles));
  const int n =
      static_cast<int>(std::min(affordable, std::ceil(static_cast<double>(longest / kTexelsOfPart))));
  if (n < 2 ||
      !is_uneven(mesh, texture, textures, longest, kLookupsOfTriangle * static_cast<double>(max_triangles)))
    return mesh;
  return divided(mesh, n);
}

}  // namespace lumirank::world
