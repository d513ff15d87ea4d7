// Subdivision surfaces: the limit of a vertex is the same from every level.
#include "scenedesc/meshes/loop_subdivision.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

namespace lumirank::scenedesc {
namespace {

MeshData octahedron() {
  MeshData mesh;
  mesh.positions = {{1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  for (std::uint32_t k = 0; k < 4; ++k) {
    const std::uint32_t next = (k + 1) % 4;
    mesh.indices.insert(mesh.indices.end(), {k, next, 4, next, k, 5});
  }
  return mesh;
}

// Four neighbors whose sum is 0: β = 3/32, and the vertex goes to 1 - 4/(4 + 4) of where it is.
TEST(LoopSubdivision, VerticesOfAnOctahedronGoToTheirHalves) {
  const MeshData control = octahedron();
  for (int level = 0; level <= 4; ++level) {
    const MeshData fine = loop_subdivided(control, level);
    EXPECT_EQ(fine.triangle_count(), std::size_t{8} << (2 * level));
    EXPECT_EQ(fine.positions.size(), fine.triangle_count() / 2 + 2) << "Euler";
    for (std::size_t v = 0; v < 6; ++v) {
      EXPECT_LT(length(fine.positions[v] - control.positions[v] * 0.5f), 1e-6f) << level;
      EXPECT_LT(length(fine.normals[v] - control.positions[v]), 1e-5f) << level;
    }
    for (std::size_t t = 0; t < fine.triangle_count(); ++t) {
      const Vec3f a = fine.positions[fine.indices[3 * t]], b = fine.positions[fine.indices[3 * t + 1]],
                  c = fine.positions[fine.indices[3 * t + 2]];
      EXPECT_GT(dot(cross(b - a, c - a), a + b + c), 0) << "outwards";
    }
  }
}

// The boundary of a sheet is a cubic B-spline of its own vertices, whatever is inside: its limit is
// (p₋₁ + 4p₀ + p₁)/6 of the control points, which weights of 1/5 reach from the first division.
TEST(LoopSubdivision, BoundariesAreSplines) {
  MeshData sheet;
  for (int y = 0; y < 4; ++y)
    for (int x = 0; x < 4; ++x)
      sheet.positions.push_back({static_cast<float>(x), static_cast<float>(y), x == 2 ? 1.0f : 0.0f});
  for (std::uint32_t y = 0; y < 3; ++y)
    for (std::uint32_t x = 0; x < 3; ++x) {
      const std::uint32_t a = 4 * y + x;
      sheet.indices.insert(sheet.indices.end(), {a, a + 1, a + 5, a, a + 5, a + 4});
    }
  Vec3f before;
  for (int level = 1; level <= 4; ++level) {
    const MeshData fine = loop_subdivided(sheet, level);
    const Vec3f limit = fine.positions[2];  // between (1, 0, 0) and (3, 0, 0)
    EXPECT_NEAR(limit.x, 2, 1e-5f);
    EXPECT_NEAR(limit.y, 0, 1e-6f);
    if (level > 1) {
      EXPECT_LT(length(limit - before), 0.04f / static_cast<float>(1 << (2 * level - 4)));
    }
    before = limit;
  }
  EXPECT_NEAR(before.z, 4.0f / 6, 1e-3f);
}

// In a plane the plane stays, and inside an even grid so do its vertices.
TEST(LoopSubdivision, APlaneStays) {
  MeshData sheet;
  for (int y = 0; y < 5; ++y)
    for (int x = 0; x < 5; ++x) sheet.positions.push_back({static_cast<float>(x), static_cast<float>(y), 3});
  for (std::uint32_t y = 0; y < 4; ++y)
    for (std::uint32_t x = 0; x < 4; ++x) {
      const std::uint32_t a = 5 * y + x;
      sheet.indices.insert(sheet.indices.end(), {a, a + 1, a + 6, a, a + 6, a + 5});
    }
  const MeshData fine = loop_subdivided(sheet, 2);
  for (std::size_t v = 0; v < fine.positions.size(); ++v) {
    EXPECT_NEAR(fine.positions[v].z, 3, 1e-6f);
    EXPECT_NEAR(fine.normals[v].z, 1, 1e-6f);
  }
  EXPECT_LT(length(fine.positions[12] - Vec3f{2, 2, 3}), 1e-6f);
}

// Three sheets that meet in one edge: it is a boundary of each.
TEST(LoopSubdivision, AnEdgeOfThreeTrianglesIsABoundary) {
  MeshData fan;
  fan.positions = {{0, 0, 0}, {0, 0, 1}, {1, 0, 0.5f}, {-1, 1, 0.5f}, {-1, -1, 0.5f}};
  fan.indices = {0, 1, 2, 0, 1, 3, 0, 1, 4};
  const MeshData fine = loop_subdivided(fan, 1);
  EXPECT_EQ(fine.triangle_count(), 12u);
  const auto middle = std::count_if(fine.positions.begin(), fine.positions.end(), [](Vec3f p) {
    return std::abs(p.x) < 1e-6f && std::abs(p.y) < 1e-6f && p.z > 0.4f && p.z < 0.6f;
  });
  EXPECT_EQ(middle, 1);
}

}  // namespace
}  // namespace lumirank::scenedesc
