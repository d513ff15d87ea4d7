// Ray queries over meshes and instances. The one file behind it (ray_scene.cpp) wraps Embree 3 or 4.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "base/bounds.h"
#include "base/rgb.h"
#include "base/transform.h"
#include "base/vec.h"
#include "geometry/mesh.h"

namespace lumirank::geometry {

struct Ray {
  Vec3f origin, direction;  // direction need not be unit length; t is measured in its length
  float t_min = 0, t_max = kInfinity;
};

struct Hit {
  float t = 0;
  std::uint32_t instance = 0;  // index into the instances of the scene
  std::uint32_t mesh = 0;
  std::uint32_t triangle = 0;
  Vec2f barycentric;           // weights of the second and third corner
};

// What a shadow ray does at a mesh.
enum class Blocking : std::uint8_t {
  opaque,  // always blocks: no callback
  cutout,  // blocks with a probability that the callback gives (binary, decided by a hash of the ray's key)
  smooth,  // never blocks; attenuates by a colour that the callback gives
};

// One placement of a mesh in the world. Meshes placed once with the identity cost nothing extra.
struct Placement {
  std::uint32_t mesh = 0;
  Transform to_world;
  Blocking blocking = Blocking::opaque;
  std::uint32_t material = 0, emitter = 0xffffffffu;  // carried for the owner; geometry does not read them
};

// 16 shadow segments from `origin` towards `origin + direction`, open at both ends (t in (epsilon, 1 - epsilon)). Structure of arrays.
struct alignas(64) ShadowPacket {
  float ox[16], oy[16], oz[16], dx[16], dy[16], dz[16], t_far[16];
  std::uint64_t key[16];   // decides cut-outs; the same for the same (receiver, light)
  int valid[16];           // -1: trace; 0: leave out
};

class RayScene {
 public:
  // For a segment passing `hit` with direction w: the chance that a cut-out blocks, or (smooth) the transmittance.
  struct PassageCallbacks {
    std::function<float(const Hit&)> opacity;
    std::function<Rgb(const Hit&, Vec3f w)> transmittance;
  };

  // Throws InputError when there is no triangle at all.
  RayScene(std::vector<TriangleMesh> meshes, std::vector<Placement> placements, PassageCallbacks callbacks);
  ~RayScene();
  RayScene(RayScene&&) noexcept;

  const std::vector<TriangleMesh>& meshes() const;
  const std::vector<Placement>& placements() const;  // Hit::instance indexes it
  Bounds3f bounds() const;
  bool has_smooth() const;  // some placement attenuates

  std::optional<Hit> intersect(const Ray& ray) const;
  // True if something blocks; cut-outs are decided by `key`.
  bool occluded(const Ray& ray, std::uint64_t key) const;
  // Product of the smooth placements' transmittances along the ray (1 if none); ignores everything else.
  Rgb transmittance(const Ray& ray) const;

  // Bit k of the result: segment k is unblocked. Coherent packets, the widest form that measures fastest.
  std::uint16_t visible16(const ShadowPacket& packet) const;
  // Transmittance of the smooth placements for 16 segments; only worth calling if has_smooth().
  void transmittance16(const ShadowPacket& packet, Rgb out[16]) const;

  std::size_t memory_bytes() const;  // of the acceleration structure

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace lumirank::geometry
