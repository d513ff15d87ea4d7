// Triangles and rays at random.
#pragma once

#include "base/random.h"
#include "geometry/ray_scene.h"

namespace lumirank::geometry {

inline Vec3f random_point(Rng& rng) {
  const float x = rng.next_float(), y = rng.next_float();
  return Vec3f{x, y, rng.next_float()} * 2.0f - Vec3f{1, 1, 1};
}

inline TriangleMesh random_mesh(std::uint64_t seed, int triangles, float size) {
  Rng rng(seed, Stage::test);
  TriangleMesh mesh;
  for (int k = 0; k < triangles; ++k) {
    const Vec3f center = random_point(rng);
    for (int c = 0; c < 3; ++c) {
      mesh.indices.push_back(static_cast<std::uint32_t>(mesh.positions.size()));
      mesh.positions.push_back(center + random_point(rng) * size);
    }
  }
  return mesh;
}

inline RayScene::PassageCallbacks constant_callbacks(float opacity, Rgb transmittance) {
  return {[=](const Hit&) { return opacity; }, [=](const Hit&, Vec3f) { return transmittance; }};
}

inline ShadowPacket random_packet(Rng& rng) {
  ShadowPacket p;
  for (int k = 0; k < 16; ++k) {
    const Vec3f o = random_point(rng) * 1.5f, d = random_point(rng) * 1.5f - o;
    p.ox[k] = o.x, p.oy[k] = o.y, p.oz[k] = o.z;
    p.dx[k] = d.x, p.dy[k] = d.y, p.dz[k] = d.z;
    p.t_far[k] = k % 4 == 0 ? kInfinity : (k % 4 == 1 ? 0.5f : 1.0f);
    p.from[k] = static_cast<std::uint32_t>(rng.next_bits()), p.to[k] = static_cast<std::uint32_t>(k);
    p.valid[k] = rng.next_float() < 0.9f ? -1 : 0;
  }
  return p;
}

}  // namespace lumirank::geometry
