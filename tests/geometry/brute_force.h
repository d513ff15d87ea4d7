// Ray against triangles one by one, in double precision: what RayScene is judged by.
#pragma once

#include <array>
#include <cmath>
#include <vector>

#include "geometry/ray_scene.h"

namespace lumirank::geometry {

struct Crossing {
  double t;
  std::uint32_t instance, triangle;
  double u, v;
  double margin;  // least distance of the barycentric coordinates from an edge: a small one may go either way
};

inline std::array<double, 3> transformed(const Transform& m, Vec3f p) {
  std::array<double, 3> out;
  for (int r = 0; r < 3; ++r)
    out[r] = m.m[4 * r] * p.x + m.m[4 * r + 1] * p.y + m.m[4 * r + 2] * p.z + m.m[4 * r + 3];
  return out;
}

// All crossings of the line with triangles, nearly touched ones (margin down to -1e-3) included. Solves
// a + u (b - a) + v (c - a) = o + t d by Cramer's rule.
inline std::vector<Crossing> all_crossings(const RayScene& scene, Vec3f origin, Vec3f direction) {
  using V = std::array<double, 3>;
  auto det = [](const V& a, const V& b, const V& c) {
    return a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0]) +
           a[2] * (b[0] * c[1] - b[1] * c[0]);
  };
  const V d{-direction.x, -direction.y, -direction.z};
  std::vector<Crossing> out;
  for (std::uint32_t i = 0; i < scene.placements().size(); ++i) {
    const Placement& p = scene.placements()[i];
    const TriangleMesh& mesh = scene.mesh(p.mesh);
    for (std::uint32_t k = 0; k < mesh.triangle_count(); ++k) {
      const V a = transformed(p.to_world, mesh.positions[mesh.indices[3 * k]]);
      V e1 = transformed(p.to_world, mesh.positions[mesh.indices[3 * k + 1]]);
      V e2 = transformed(p.to_world, mesh.positions[mesh.indices[3 * k + 2]]), s;
      for (int c = 0; c < 3; ++c) e1[c] -= a[c], e2[c] -= a[c];
      s = {origin.x - a[0], origin.y - a[1], origin.z - a[2]};
      const double whole = det(e1, e2, d);
      if (whole == 0) continue;
      const double u = det(s, e2, d) / whole, v = det(e1, s, d) / whole, t = det(e1, e2, s) / whole;
      const double margin = std::min({u, v, 1 - u - v});
      if (margin > -1e-3) out.push_back({t, i, k, u, v, margin});
    }
  }
  return out;
}

}  // namespace lumirank::geometry
