#include "geometry/tessellate.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <map>
#include <numbers>

#include "base/error.h"

namespace lumirank::geometry {
namespace {

double area(const TriangleMesh& mesh) {
  double sum = 0;
  for (std::size_t k = 0; k < mesh.triangle_count(); ++k) sum += 0.5 * length(mesh.area_vector(k));
  return sum;
}

void expect_sound(const TriangleMesh& mesh) {
  ASSERT_EQ(mesh.normals.size(), mesh.positions.size());
  ASSERT_EQ(mesh.uvs.size(), mesh.positions.size());
  for (const Vec3f& n : mesh.normals) EXPECT_NEAR(length(n), 1, 3e-7);
  for (const Vec2f& uv : mesh.uvs) {
    EXPECT_GE(std::min(uv.x, uv.y), 0);
    EXPECT_LE(std::max(uv.x, uv.y), 1);
  }
  for (std::size_t k = 0; k < mesh.triangle_count(); ++k) {
    EXPECT_GT(length(mesh.area_vector(k)), 0) << "triangle " << k;
    for (int c = 0; c < 3; ++c)
      EXPECT_GT(dot(mesh.area_vector(k), mesh.normals[mesh.indices[3 * k + c]]), 0) << "triangle " << k;
  }
}

// Directed edges between places (not vertices) that no triangle runs through the other way.
std::size_t open_edges(const TriangleMesh& mesh) {
  using Place = std::array<float, 3>;
  std::map<std::pair<Place, Place>, int> count;
  auto place = [&](std::uint32_t i) {
    const Vec3f p = mesh.positions[i] + Vec3f{};  // -0 becomes 0
    return Place{p.x, p.y, p.z};
  };
  for (std::size_t k = 0; k < mesh.indices.size(); k += 3)
    for (int c = 0; c < 3; ++c) ++count[{place(mesh.indices[k + c]), place(mesh.indices[k + (c + 1) % 3])}];
  std::size_t open = 0;
  for (const auto& [edge, n] : count) {
    EXPECT_EQ(n, 1);
    open += count.count({edge.second, edge.first}) == 0;
  }
  return open;
}

TEST(Tessellate, RectangleAndCubeAreExact) {
  const TriangleMesh rectangle = make_rectangle();
  expect_sound(rectangle);
  EXPECT_EQ(area(rectangle), 4);
  EXPECT_EQ(open_edges(rectangle), 4u);
  for (std::size_t k = 0; k < 4; ++k) {  // u = (x + 1)/2, v = (y + 1)/2
    EXPECT_EQ(rectangle.uvs[k].x, (rectangle.positions[k].x + 1) / 2);
    EXPECT_EQ(rectangle.uvs[k].y, (rectangle.positions[k].y + 1) / 2);
  }
  const TriangleMesh cube = make_cube();
  expect_sound(cube);
  EXPECT_EQ(area(cube), 24);
  EXPECT_EQ(open_edges(cube), 0u);
  // The side towards +x, as Mitsuba 3.9.1 says of its own.
  const std::pair<Vec3f, Vec2f> corners[] = {
      {{1, -1, -1}, {0, 1}}, {{1, 1, -1}, {1, 1}}, {{1, 1, 1}, {1, 0}}, {{1, -1, 1}, {0, 0}}};
  for (std::size_t k = 0; k < 4; ++k) {
    EXPECT_EQ(cube.normals[8 + k], (Vec3f{1, 0, 0}));
    EXPECT_EQ(cube.positions[8 + k], corners[k].first);
    EXPECT_EQ(cube.uvs[8 + k], corners[k].second);
  }
}

// The regular n-gon inscribed in the unit circle has the area (n/2) sin(2π/n).
TEST(Tessellate, DiskIsTheInscribedPolygon) {
  for (const int n : {3, 16, 128}) {
    const TriangleMesh disk = make_disk(n);
    expect_sound(disk);
    EXPECT_EQ(open_edges(disk), static_cast<std::size_t>(n));
    EXPECT_NEAR(area(disk), 0.5 * n * std::sin(2 * std::numbers::pi / n), 1e-6 * std::numbers::pi);
    for (std::size_t k = 0; k < disk.positions.size(); ++k)
      EXPECT_NEAR(disk.uvs[k].x, length(disk.positions[k]), 1e-6);  // u is the radius
  }
}

// Rings of plane trapezoids: between the parallels at heights z0, z1 and radii ρ0, ρ1 there are n of them
// with parallel sides 2ρ sin(π/n), whose distance is √((z0 - z1)² + (ρ0 - ρ1)² cos²(π/n)).
double inscribed_sphere_area(int rings) {
  const double pi = std::numbers::pi;
  const int n = 2 * rings;
  double sum = 0;
  for (int i = 0; i < rings; ++i) {
    const double t0 = pi * i / rings, t1 = pi * (i + 1) / rings;
    const double height =
        std::hypot(std::cos(t0) - std::cos(t1), (std::sin(t0) - std::sin(t1)) * std::cos(pi / n));
    sum += n * (std::sin(t0) + std::sin(t1)) * std::sin(pi / n) * height;
  }
  return sum;
}

TEST(Tessellate, SphereIsTheInscribedPolyhedron) {
  const double pi = std::numbers::pi;
  const Vec3f center{1, -2, 3};
  const float radius = 2.5f;
  for (const int rings : {2, 5, 64}) {
    const TriangleMesh sphere = make_sphere(center, radius, rings);
    expect_sound(sphere);
    EXPECT_EQ(open_edges(sphere), 0u);
    const double expected = inscribed_sphere_area(rings) * radius * radius;
    EXPECT_NEAR(area(sphere), expected, 2e-6 * expected);
  }
  // What tessellate.h states for the default.
  EXPECT_NEAR(inscribed_sphere_area(64) / (4 * pi), 1 - 5.02e-4, 1e-6);

  const TriangleMesh sphere = make_sphere(center, radius);
  for (std::size_t k = 0; k < sphere.positions.size(); ++k) {
    const Vec3f n = (sphere.positions[k] - center) / radius;
    EXPECT_NEAR(length(n - sphere.normals[k]), 0, 1e-6);
    EXPECT_NEAR(std::cos(pi * sphere.uvs[k].y), n.z, 1e-6);
    if (std::abs(n.z) < 0.999f) {
      const double rho = std::hypot(n.x, n.y), phi = 2 * pi * sphere.uvs[k].x;
      EXPECT_NEAR(std::cos(phi) * rho, n.x, 2e-6);
      EXPECT_NEAR(std::sin(phi) * rho, n.y, 2e-6);
    }
  }
}

// n plane rectangles of width 2r sin(π/n).
TEST(Tessellate, CylinderIsTheInscribedPrism) {
  const Vec3f p0{1, 2, 3}, p1{-2, 2, 7};
  const double height = 5, radius = 0.75;
  for (const int n : {3, 128}) {
    const TriangleMesh cylinder = make_cylinder(p0, p1, static_cast<float>(radius), n);
    expect_sound(cylinder);
    EXPECT_EQ(open_edges(cylinder), 2u * n);
    const double expected = 2 * n * radius * std::sin(std::numbers::pi / n) * height;
    EXPECT_NEAR(area(cylinder), expected, 2e-6 * expected);
    const Vec3f axis = normalize(p1 - p0);
    for (std::size_t k = 0; k < cylinder.positions.size(); ++k) {
      const Vec3f from_p0 = cylinder.positions[k] - p0;
      EXPECT_NEAR(dot(from_p0, axis), cylinder.uvs[k].y * height, 1e-5);
      EXPECT_NEAR(length(from_p0 - axis * dot(from_p0, axis) - cylinder.normals[k] * 0.75f), 0, 2e-6);
    }
  }
}

TEST(Tessellate, RefusesSizesThatAreNotPositive) {
  EXPECT_THROW(make_sphere({}, 0), InputError);
  EXPECT_THROW(make_sphere({}, -1), InputError);
  EXPECT_THROW(make_sphere({}, kInfinity), InputError);
  EXPECT_THROW(make_cylinder({}, {}, 1), InputError);
  EXPECT_THROW(make_cylinder({}, {0, 0, 1}, -1), InputError);
}

}  // namespace
}  // namespace lumirank::geometry
