#include "scenedesc/pbrt/grids.h"

#include <algorithm>
#include <cmath>

namespace lumirank::scenedesc::pbrt {

namespace {

constexpr float kTwoPi = 2 * kPi;

int segments(float phi_max) { return std::max(1, static_cast<int>(std::ceil(128 * phi_max / kTwoPi))); }

}  // namespace

void append_grid(MeshData& mesh, int columns, int rows, const std::function<GridPoint(float, float)>& at) {
  const auto base = static_cast<std::uint32_t>(mesh.positions.size());
  for (int j = 0; j <= rows; ++j)
    for (int i = 0; i <= columns; ++i) {
      const GridPoint p = at(static_cast<float>(i) / static_cast<float>(columns),
                             static_cast<float>(j) / static_cast<float>(rows));
      mesh.positions.push_back(p.position);
      mesh.normals.push_back(p.normal);
      mesh.uvs.push_back(p.uv);
    }
  const auto vertex = [&](int i, int j) { return base + static_cast<std::uint32_t>(j * (columns + 1) + i); };
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < columns; ++i) {
      const std::uint32_t a = vertex(i, j), b = vertex(i + 1, j), c = vertex(i + 1, j + 1),
                          d = vertex(i, j + 1);
      mesh.indices.insert(mesh.indices.end(), {a, b, c, a, c, d});
    }
}

MeshData part_of_sphere(float radius, float z_min, float z_max, float phi_max) {
  const float low = std::acos(std::clamp(z_min / radius, -1.0f, 1.0f));
  const float high = std::acos(std::clamp(z_max / radius, -1.0f, 1.0f));
  MeshData mesh;
  append_grid(
      mesh, segments(phi_max), std::max(1, static_cast<int>(std::ceil(64 * (low - high) / kPi))),
      [&](float u, float v) {
        const float phi = u * phi_max, theta = low + v * (high - low);
        const Vec3f n{std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
        return GridPoint{n * radius, n, {u, v}};
      });
  return mesh;
}

MeshData part_of_cylinder(float radius, float z_min, float z_max, float phi_max) {
  MeshData mesh;
  append_grid(mesh, segments(phi_max), 1, [&](float u, float v) {
    const Vec3f n{std::cos(u * phi_max), std::sin(u * phi_max), 0};
    return GridPoint{{radius * n.x, radius * n.y, z_min + v * (z_max - z_min)}, n, {u, v}};
  });
  return mesh;
}

MeshData turned_about_z(const std::function<Vec3f(float)>& line, int rows, float phi_max) {
  MeshData mesh;
  append_grid(mesh, segments(phi_max), rows, [&](float u, float v) {
    const float c = std::cos(u * phi_max), s = std::sin(u * phi_max);
    const auto turned = [&](Vec3f p) { return Vec3f{p.x * c - p.y * s, p.x * s + p.y * c, p.z}; };
    // Along the line by a difference that stays on it; across it, around z. At the axis, as beside it.
    constexpr float kStep = 1e-3f;
    const float low = std::max(0.0f, v - kStep), high = std::min(1.0f, v + kStep);
    const Vec3f along = turned(line(high) - line(low));
    const Vec3f beside = turned(line(v < 0.5f ? high : low));
    const Vec3f n = cross(Vec3f{-beside.y, beside.x, 0}, along);
    return GridPoint{turned(line(v)), length(n) > 0 ? normalize(n) : Vec3f{0, 0, 1}, {u, v}};
  });
  return mesh;
}

MeshData part_of_disk(float height, float radius, float inner_radius, float phi_max) {
  MeshData mesh;
  append_grid(mesh, segments(phi_max), inner_radius > 0 ? 1 : 8, [&](float u, float v) {
    const float r = radius + v * (inner_radius - radius);
    return GridPoint{{r * std::cos(u * phi_max), r * std::sin(u * phi_max), height}, {0, 0, 1}, {u, v}};
  });
  return mesh;
}

}  // namespace lumirank::scenedesc::pbrt
