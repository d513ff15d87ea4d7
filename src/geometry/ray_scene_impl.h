// Implementation of RayScene: two Embree scenes over the same meshes, one of what can block and one of what
// only attenuates, so that shadow rays never visit glass and no build option of Embree (ray masks) is needed.
#pragma once

#include <atomic>
#include <deque>
#include <map>
#include <memory>
#include <string>
#include <utility>
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

// Shared by all scenes that share anything.
struct TracingDevice {
  std::atomic<long long> bytes{0};
  std::string first_error;  // of Embree, if any
  embree::Device handle;
};

// A committed scene of Embree and what it points to, which is released after it.
struct TracedPart {
  std::shared_ptr<TracingDevice> device;
  std::vector<SharedMesh> meshes;
  std::deque<TracedFibers> fibers;
  std::vector<std::shared_ptr<const TracedPart>> instanced;
  embree::Scene scene;

  void add_mesh(const SharedMesh& mesh, const Transform* baked, Blocking blocking, unsigned id);
  void add_instance(const std::shared_ptr<const TracedPart>& part, const Transform& to_world, unsigned id);
  void commit();
};
[[noreturn]] void out_of_memory();
using SharedPart = std::shared_ptr<const TracedPart>;

// One mesh in world space in a scene of its own, whose structure can follow the vertices.
struct RefittedPart {
  std::shared_ptr<TracedPart> part;
  RTCGeometry geometry = nullptr;  // the part's
  int refits = 0;                  // since it was built
};

struct RayScene::Impl {
  std::vector<SharedMesh> meshes;
  std::vector<Placement> placements;
  PassageCallbacks callbacks;

  std::shared_ptr<TracingDevice> device;
  long long own_bytes = 0;
  // Scenes of the meshes that are instanced.
  std::map<std::pair<std::uint32_t, Blocking>, SharedPart> parts;
  std::vector<bool> flat;            // by placement: traced in world space
  SharedPart blocking, attenuating;  // attenuating is null if no placement attenuates
  // What is shared with other moments because it does not move: placements that are in it, and the scenes,
  // which are instances of `blocking` and `attenuating` by the number after the last placement.
  struct Still {
    std::vector<bool> holds;  // empty: there is none
    SharedPart blocking, attenuating;
  };
  Still still;
  std::map<std::size_t, RefittedPart> refitted;  // by placement; instances of the scenes above
  Bounds3f bounds;
  // Embree leaves out what a ray meets of fibers within two radii of its origin. So rays are handed to it
  // from so much farther behind: over twice the radius of the widest fiber, in world space. 0: there are
  // none.
  float run_up = 0;

  void build(std::size_t flatten_limit, const Sharing& sharing);
  bool has_instances() const { return !parts.empty() || !still.holds.empty() || !refitted.empty(); }
  // The placement that a hit is on, by Embree's numbers.
  std::uint32_t placement_of(unsigned instance, unsigned geometry) const {
    return instance != RTC_INVALID_GEOMETRY_ID && instance < placements.size() ? instance : geometry;
  }

 private:
  void check() const;
  void choose_flat(std::size_t flatten_limit);
  // Placements that are what they are in `before`; all false if the two do not correspond.
  std::vector<bool> same_as(const Impl* before) const;
  void share_still(const Impl* before, const std::vector<bool>& same, std::size_t share_limit);
  // refit.cpp
  void refit(const Impl& before, const std::vector<bool>& same, std::size_t least);
  RefittedPart new_refitted(std::size_t placement) const;
  std::shared_ptr<TracedPart> new_part() const;
  void add_flat(TracedPart& to, std::size_t placement) const;
  SharedPart instanced_part(std::uint32_t mesh, Blocking blocking_kind, const Impl* before);
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
// Sets the filters that a triangle mesh needs.
void set_filters(RTCGeometry geometry, Blocking blocking);
// Lets a hit on a cut-out count with the probability of its opacity.
void filter_cutout(const RTCFilterFunctionNArguments* arguments);
// Notes a hit on an attenuating surface and lets the ray go on.
void filter_attenuating(const RTCFilterFunctionNArguments* arguments);

}  // namespace lumirank::geometry
