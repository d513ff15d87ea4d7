// The scene, built and immutable: geometry, materials and emitters, ready for queries from any thread.
// Everything is in units of the world (units()), mostly the file's.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/bounds.h"
#include "base/sinks.h"
#include "emitters/emitter.h"
#include "geometry/ray_scene.h"
#include "media/medium.h"
#include "scatter/material.h"
#include "scenedesc/schema/scene_desc.h"
#include "world/camera.h"
#include "world/units.h"

namespace lumirank::world {

class World;

struct BuildOptions {
  bool strict = false;  // warnings become errors
  // Instead of its own: those of another moment of the same scene, so that places can be compared.
  std::optional<Units> units = {};
  // The same scene at another moment: what has not changed since is shared with it.
  const World* before = nullptr;
  // Participating media are there. Without them the scene is in empty space, which is warned about; but media
  // that may be the color of glass (colored_glass.h) are taken in by rays, see left_by_glass().
  bool media = true;
  // `before` is traced no more: see geometry::RayScene::Sharing.
  bool refit = false;
  // Light passes panes (panes.h) without being bent, by shadow rays as well.
  bool straight_panes = false;
};

struct WorldInfo {
  std::size_t meshes = 0, instances = 0, triangles = 0, unique_triangles = 0;
  std::size_t meshes_left_out = 0;  // without a triangle, or without their file; not among `meshes`
  std::size_t segments = 0;         // of fibers
  std::size_t textures = 0, materials = 0, media = 0, emitters = 0;
  // With BuildOptions::straight_panes: shapes that light passes straight, and others of smooth glass.
  std::size_t panes = 0, bending_glass = 0;
  // Triangles that were moved into what they touch, or out of it (touching_faces.h).
  std::size_t touching_faces = 0;
  // Meshes, textures and acceleration structure, without what is shared with BuildOptions::before.
  std::size_t memory_bytes = 0;
};

// A surface hit with everything that shading needs.
struct SurfaceHit {
  geometry::Hit hit;
  scatter::SurfacePoint point;
  int material = 0;
  int emitter = -1;  // index into emitters(), -1: does not shine
};

class LightSampler;

class World {
 public:
  // Opens meshes and textures. Appends to `warnings` what had to be replaced or mended.
  static World build(const scenedesc::SceneDesc& desc, const BuildOptions& options,
                     std::vector<scenedesc::Warning>& warnings, const Sinks& sinks = {});
  World(World&&) noexcept;
  ~World();

  const geometry::RayScene& rays() const;
  const scatter::MaterialSet& materials() const;
  const std::vector<emitters::Emitter>& emitters() const;
  // Participating media; empty space is none of them and has the number -1.
  const std::vector<media::Medium>& media() const;
  // Of light that goes `length` through a medium, medium_beyond()'s, where media are the color of glass; else
  // 1.
  Rgb left_by_glass(int medium, float length) const;
  // Whether a placement's surface has a medium on a side.
  bool divides_media(std::uint32_t placement) const;
  // The medium that a ray is in which leaves the hit into `direction`, having come through `current`.
  int medium_beyond(const SurfaceHit& hit, Vec3f direction, int current) const;
  // The emitter that fills the background, or -1. At most one EnvironmentEmitter exists (sky and map are
  // merged or warned about).
  int environment() const;
  const Bounds3f& bounds() const;
  // By placement: the same number for the same shape (by its id, and among those of one id by their order)
  // when the scene is built at another moment.
  const std::vector<std::uint64_t>& placement_ids() const;
  const Units& units() const;
  const WorldInfo& info() const;

  std::optional<SurfaceHit> intersect(const geometry::Ray& ray) const;
  // The same for rays of the eye: in scenes that hide their emitters it looks through all that shines, and
  // where nothing is hit it sees no background.
  std::optional<SurfaceHit> intersect_from_eye(geometry::Ray ray) const;
  bool hides_emitters() const;
  // The surface point for a known placement, triangle and barycentric coordinates. The direction matters to
  // fibers only: they are seen all around.
  SurfaceHit surface(const geometry::Hit& hit, Vec3f ray_direction) const;
  // Radiance leaving an emitting hit towards wo (0 on the dark side), texture included.
  Rgb emitted(const SurfaceHit& at, Vec3f wo) const;
  // Radiance on the bright side of a point of an area emitter, texture included.
  Rgb emitted(int emitter, std::uint32_t triangle, Vec2f barycentric) const;
  // Radiance that arrives along a ray that leaves the scene (environment; delta directional light contributes
  // nothing).
  Rgb background(Vec3f direction) const;
  // Radiance of the discs of suns (directional emitters with a half angle) in a direction. Suns are sampled
  // as delta lights, so this counts only where a ray leaves the scene after nothing but specular events from
  // the eye.
  Rgb sun_disc(Vec3f direction) const;
  // Direct samples of an area emitter read the texture here; for other emitters as in
  // emitters::sample_direct.
  emitters::DirectSample sample_direct(int emitter, Vec3f point, float u1, Vec2f u2) const;
  emitters::Emission sample_emission(int emitter, float u1, Vec2f u_position, Vec2f u_direction) const;
  // Made at first use, for it takes a tenth of a second where many triangles shine; thread-safe. The world
  // may not be moved afterwards.
  const LightSampler& light_sampler() const;

  // Where a ray from `p` should start so that it does not meet its own surface: offset along ng to the side
  // of `direction`. Where ng is zero (Closure::is_fiber()) along `direction`, of any length.
  static Vec3f offset_origin(Vec3f p, Vec3f ng, Vec3f direction);

 private:
  struct Impl;
  class Builder;
  explicit World(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace lumirank::world
