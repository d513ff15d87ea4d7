// Ray queries over meshes and instances, by Embree 3 or 4 (embree.h knows which).
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
  std::uint32_t triangle = 0;  // or segment of fibers
  // Weights of the second and third corner. Fibers: how far along the segment, and (intersect() only) how far
  // across, from -1 to 1 over the width: the position is axis + y · radius · normalize(along × -direction).
  Vec2f barycentric;
};

// What a shadow ray does at a mesh.
enum class Blocking : std::uint8_t {
  opaque,  // always blocks: no callback
  cutout,  // blocks with a probability that the callback gives (binary, decided by a hash of the ray's key)
  attenuating,  // never blocks; attenuates by a color that the callback gives
};

// One placement of a mesh in the world. Meshes placed once with the identity cost nothing extra.
struct Placement {
  std::uint32_t mesh = 0;
  Transform to_world;
  Blocking blocking = Blocking::opaque;
  std::uint32_t material = 0, emitter = 0xffffffffu;  // carried for the owner; geometry does not read them
};

// A shadow segment is open at both ends by this part of its direction's length. Callers still start it off
// the surface (along the geometric normal): this only keeps rounding at the far end from counting the light's
// own surface.
inline constexpr float kShadowEpsilon = 1e-4f;

// 16 shadow segments from o towards o + t_far·d, open at both ends: t in (ε, (1 - ε)·t_far), ε =
// kShadowEpsilon. For a segment to a light, d is the whole way and t_far is 1. Towards a direction, t_far is
// huge or infinite, and d should have the length over which ε makes sense (unit length, or a part of the
// scene's size). Structure of arrays.
struct alignas(64) ShadowPacket {
  float ox[16], oy[16], oz[16], dx[16], dy[16], dz[16], t_far[16];
  // Decide cut-outs: the same for the same (receiver, light). Apart and unhashed, because few rays need them.
  std::uint32_t from[16], to[16];
  std::uint64_t seed;

  std::uint64_t key(unsigned k) const { return seed ^ (static_cast<std::uint64_t>(from[k]) << 32 | to[k]); }
  int valid[16];  // -1: trace; 0: leave out
  // The segments share an end or a direction, and find their way faster together than one by one.
  bool alike = true;

  Ray ray(int k) const {
    return {{ox[k], oy[k], oz[k]}, {dx[k], dy[k], dz[k]}, kShadowEpsilon, t_far[k] * (1 - kShadowEpsilon)};
  }
};

class RayScene {
 public:
  // For a segment passing `hit` with direction w (as in the query: any length): the chance that a cut-out
  // blocks, or (attenuating) the transmittance. Called from any thread, through Embree: they must not throw.
  struct PassageCallbacks {
    std::function<float(const Hit&)> opacity;
    std::function<Rgb(const Hit&, Vec3f w)> transmittance;
  };

  // Copies of one mesh are traced in world space if they have at most this many triangles in all: overlapping
  // instances cost more time than flat triangles, which cost memory.
  static constexpr std::size_t kFlattenLimit = std::size_t{1} << 18;

  // Meshes placed once, or often but small, are traced in world space; the others as instances. Throws
  // InputError when there is no triangle at all or a transform is not affine.
  RayScene(std::vector<TriangleMesh> meshes, std::vector<Placement> placements, PassageCallbacks callbacks,
           std::size_t flatten_limit = kFlattenLimit);
  // What may be shared with a scene of another moment (nullptr: nothing). If all placements have the same
  // meshes (the same objects) by the same transforms, that is everything; else what has not moved, if that
  // has at least `least` primitives: fewer are built again sooner than an instance of them is traced.
  // `refit`: `before` is traced no more; meshes of which only vertices have moved, of as many primitives,
  // take their structures from it and refit them: faster to build, slower to trace.
  struct Sharing {
    const RayScene* before = nullptr;
    std::size_t least = kFlattenLimit;
    bool refit = false;
  };
  RayScene(std::vector<SharedMesh> meshes, std::vector<Placement> placements, PassageCallbacks callbacks,
           const Sharing& sharing, std::size_t flatten_limit = kFlattenLimit);
  ~RayScene();
  RayScene(RayScene&&) noexcept;
  RayScene& operator=(RayScene&&) noexcept;

  const TriangleMesh& mesh(std::size_t k) const;
  const std::vector<SharedMesh>& meshes() const;
  const std::vector<Placement>& placements() const;  // Hit::instance indexes it
  Bounds3f bounds() const;
  bool has_attenuating() const;  // some placement attenuates

  // Rays that are not finite (or beyond 1.8e18) or have t_min < 0 or t_min > t_max hit nothing and are
  // occluded. The closest hit with t in [t_min, t_max], whatever the placement's blocking.
  std::optional<Hit> intersect(const Ray& ray) const;
  // True if something blocks in [t_min, t_max] (no ε is added); cut-outs are decided by `key`.
  bool occluded(const Ray& ray, std::uint64_t key) const;
  // Where the ray crosses attenuating placements, in the order of t, each crossing once; ignores everything
  // else.
  void crossings(const Ray& ray, std::vector<Hit>& out) const;
  // Product of the attenuating placements' transmittances along the ray (1 if none).
  Rgb transmittance(const Ray& ray) const;

  // Bit k of the result: segment k is traced (valid) and unblocked. Neighboring segments should be alike.
  std::uint16_t visible16(const ShadowPacket& packet) const;
  // The same of the attenuating placements alone: traced and crosses none.
  std::uint16_t clear16(const ShadowPacket& packet) const;
  // Transmittance of the attenuating placements for 16 segments; only worth calling if has_attenuating().
  void transmittance16(const ShadowPacket& packet, Rgb out[16]) const;

  std::size_t memory_bytes() const;  // of the acceleration structure, without what it has from `before`

  struct Impl;

 private:
  std::unique_ptr<Impl> impl_;
};

}  // namespace lumirank::geometry
