#include "geometry/tessellate.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "base/error.h"
#include "base/frame.h"

namespace lumirank::geometry {
namespace {

void add_quad(TriangleMesh& mesh, std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
  mesh.indices.insert(mesh.indices.end(), {a, b, c, a, c, d});
}

struct UnitVector2 {
  double x, y;
};

// segments + 1 points of the unit circle. The last is the first, bit for bit, so that closed shapes have no
// slit.
std::vector<UnitVector2> circle(int segments) {
  std::vector<UnitVector2> points(static_cast<std::size_t>(segments) + 1);
  for (int j = 0; j < segments; ++j) {
    const double phi = 2 * std::numbers::pi * j / segments;
    points[j] = {std::cos(phi), std::sin(phi)};
  }
  points[segments] = points[0];
  return points;
}

Vec3f to_vec3f(double x, double y, double z) {
  return {static_cast<float>(x), static_cast<float>(y), static_cast<float>(z)};
}

float fraction(double part, int whole) { return static_cast<float>(part / whole); }

void require(bool good, const char* what) {
  if (!good) throw InputError(what, "give the shape a positive, finite size");
}

}  // namespace

TriangleMesh make_rectangle() {
  TriangleMesh mesh;
  mesh.positions = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
  mesh.normals.assign(4, {0, 0, 1});
  mesh.uvs = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  add_quad(mesh, 0, 1, 2, 3);
  return mesh;
}

// Where textures lie on the sides is as in Mitsuba: from its first corner on, each side's corners have the uv
// (0, 1), (1, 1), (1, 0), (0, 0).
TriangleMesh make_cube() {
  constexpr float kCorners[6][4][3] = {{{1, -1, -1}, {1, -1, 1}, {-1, -1, 1}, {-1, -1, -1}},
                                       {{1, 1, -1}, {-1, 1, -1}, {-1, 1, 1}, {1, 1, 1}},
                                       {{1, -1, -1}, {1, 1, -1}, {1, 1, 1}, {1, -1, 1}},
                                       {{1, -1, 1}, {1, 1, 1}, {-1, 1, 1}, {-1, -1, 1}},
                                       {{-1, -1, 1}, {-1, 1, 1}, {-1, 1, -1}, {-1, -1, -1}},
                                       {{1, 1, -1}, {1, -1, -1}, {-1, -1, -1}, {-1, 1, -1}}};
  TriangleMesh mesh;
  for (const auto& side : kCorners) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    Vec3f middle;
    for (const auto& corner : side) {
      mesh.positions.push_back({corner[0], corner[1], corner[2]});
      middle += mesh.positions.back() / 4;
    }
    mesh.normals.insert(mesh.normals.end(), 4, middle);
    mesh.uvs.insert(mesh.uvs.end(), {{0, 1}, {1, 1}, {1, 0}, {0, 0}});
    add_quad(mesh, first, first + 1, first + 2, first + 3);
  }
  return mesh;
}

TriangleMesh make_disk(int segments) {
  require(segments >= 3, "a disk needs at least 3 segments");
  TriangleMesh mesh;
  const std::vector<UnitVector2> rim = circle(segments);
  for (int j = 0; j <= segments; ++j) {
    mesh.positions.push_back(to_vec3f(rim[j].x, rim[j].y, 0));
    mesh.uvs.push_back({1, fraction(j, segments)});
  }
  // The center once per segment: its angle, and so its v, is that of the segment.
  for (int j = 0; j < segments; ++j) {
    mesh.positions.push_back({0, 0, 0});
    mesh.uvs.push_back({0, fraction(j + 0.5, segments)});
    const auto k = static_cast<std::uint32_t>(j);
    mesh.indices.insert(mesh.indices.end(), {static_cast<std::uint32_t>(segments) + 1 + k, k, k + 1});
  }
  mesh.normals.assign(mesh.positions.size(), {0, 0, 1});
  return mesh;
}

TriangleMesh make_sphere(Vec3f center, float radius, int rings) {
  require(is_finite(center) && std::isfinite(radius) && radius > 0, "a sphere's radius is not positive");
  require(rings >= 2, "a sphere needs at least 2 rings");
  const int segments = 2 * rings;
  const std::vector<UnitVector2> meridians = circle(segments);
  TriangleMesh mesh;
  // Row i of segments + 1 vertices at θ = π i / rings; at the poles the last vertex of the row is not used,
  // and the others stand for the middle of their segment.
  for (int i = 0; i <= rings; ++i) {
    const bool pole = i == 0 || i == rings;
    const double theta = std::numbers::pi * i / rings;
    const double rho = pole ? 0 : std::sin(theta), z = i == 0 ? 1 : (i == rings ? -1 : std::cos(theta));
    for (int j = 0; j <= segments; ++j) {
      const Vec3f n = to_vec3f(rho * meridians[j].x, rho * meridians[j].y, z);
      mesh.positions.push_back(center + n * radius);
      mesh.normals.push_back(n);
      mesh.uvs.push_back(
          {fraction(pole ? std::min(j + 0.5, segments - 0.5) : j, segments), fraction(i, rings)});
    }
  }
  const auto row = static_cast<std::uint32_t>(segments) + 1;
  for (int i = 0; i < rings; ++i) {
    for (int j = 0; j < segments; ++j) {
      const std::uint32_t a = i * row + j, b = a + row;
      if (i == 0)
        mesh.indices.insert(mesh.indices.end(), {a, b, b + 1});
      else if (i == rings - 1)
        mesh.indices.insert(mesh.indices.end(), {a, b, a + 1});
      else
        add_quad(mesh, a, b, b + 1, a + 1);
    }
  }
  return mesh;
}

TriangleMesh make_cylinder(Vec3f p0, Vec3f p1, float radius, int segments) {
  const Vec3f axis = p1 - p0;
  require(is_finite(p0) && is_finite(p1) && length(axis) > 0, "a cylinder's end points coincide");
  require(std::isfinite(radius) && radius > 0, "a cylinder's radius is not positive");
  require(segments >= 3, "a cylinder needs at least 3 segments");
  const Frame frame = Frame::from_normal(normalize(axis));
  const std::vector<UnitVector2> rim = circle(segments);
  TriangleMesh mesh;
  for (int j = 0; j <= segments; ++j) {
    const Vec3f n = frame.to_world(to_vec3f(rim[j].x, rim[j].y, 0));
    mesh.positions.insert(mesh.positions.end(), {p0 + n * radius, p1 + n * radius});
    mesh.normals.insert(mesh.normals.end(), {n, n});
    mesh.uvs.insert(mesh.uvs.end(), {{fraction(j, segments), 0}, {fraction(j, segments), 1}});
  }
  for (std::uint32_t a = 0; a < 2 * static_cast<std::uint32_t>(segments); a += 2)
    add_quad(mesh, a, a + 2, a + 3, a + 1);
  return mesh;
}

}  // namespace lumirank::geometry
