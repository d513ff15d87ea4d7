// Implementation of RayScene: two Embree scenes over the same meshes, one of what can block and one of what
// only attenuates, so that shadow rays never visit glass and no build option of Embree (ray masks) is needed.
#pragma once

#include <atomic>
#include <deque>
#include <string>
#include <vector>

#include "geometry/embree.h"
#include "geometry/ray_scene.h"

namespace lumirank::geometry {

// What filters know of fibers: where Embree sees their points, which is not where the mesh has them if a
// transform has been applied.
struct TracedFibers {
  const Fibers* fibers;
  const Fibers::Point* points;
};

struct RayScene::Impl {
  std::vector<TriangleMesh> meshes;
  std::vector<Placement> placements;
  PassageCallbacks callbacks;

  std::deque<TracedFibers> traced;  // Embree holds pointers to them

  std::atomic<long long> bytes{0};
  std::string first_error;  // of Embree, if any
  // Declared before the scenes, so released after them.
  embree::Device device;
  std::vector<embree::Scene> parts;     // scenes of the meshes that are instanced
  embree::Scene blocking, attenuating;  // attenuating is null if no placement attenuates
  Bounds3f bounds;
  // Embree leaves out what a ray meets of fibers within two radii of its origin. So rays are handed to it
  // from so much farther behind: over twice the radius of the widest fiber, in world space. 0: there are
  // none.
  float run_up = 0;

  void build(std::size_t flatten_limit);

 private:
  void open_device();
  embree::Scene new_scene();
  void commit(RTCScene scene);
  embree::Geometry triangles_of(const TriangleMesh& mesh, const Transform* baked);
  embree::Geometry fibers_of(const Fibers& fibers, const Transform* baked);
  embree::Geometry geometry_of(const TriangleMesh& mesh, const Transform* baked, Blocking blocking_kind);
  embree::Scene build_part(std::uint32_t mesh, Blocking blocking_kind);
};

// What a filter needs to know about the query that called it. Embree's context comes first: it is all that
// Embree hands to the filter.
struct QueryContext {
  embree::Context embree;
  const RayScene::PassageCallbacks* callbacks = nullptr;
  const RayScene::Impl* scene = nullptr;
  const ShadowPacket* packet = nullptr;  // with the ray's id as the place in it
  std::uint64_t key = 0;                 // of a single ray, if there is no packet
  std::vector<Hit>* crossed = nullptr;   // attenuating hits are noted here; null: any of them ends the ray
};

// Refuses hits on round caps of segments that are no part of the fiber. The geometry's user pointer is its
// TracedFibers (null: triangles). The two below do so too.
void filter_fiber_caps(const RTCFilterFunctionNArguments* arguments);
// Lets a hit on a cut-out count with the probability of its opacity.
void filter_cutout(const RTCFilterFunctionNArguments* arguments);
// Notes a hit on an attenuating surface and lets the ray go on.
void filter_attenuating(const RTCFilterFunctionNArguments* arguments);

}  // namespace lumirank::geometry
