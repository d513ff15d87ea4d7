// The only file that knows which Embree is installed: 3 and 4 differ in how a query's context and flags are
// passed.
#pragma once

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#include <memory>
#include <type_traits>

namespace lumirank::geometry::embree {

#if RTC_VERSION_MAJOR >= 4
using Context = RTCRayQueryContext;

inline void initialize(Context& context) { rtcInitRayQueryContext(&context); }

inline void intersect1(RTCScene scene, Context& context, RTCRayHit& ray) {
  RTCIntersectArguments arguments;
  rtcInitIntersectArguments(&arguments);
  arguments.context = &context;
  rtcIntersect1(scene, &ray, &arguments);
}

inline void occluded1(RTCScene scene, Context& context, RTCRay& ray) {
  RTCOccludedArguments arguments;
  rtcInitOccludedArguments(&arguments);
  arguments.context = &context;
  rtcOccluded1(scene, &ray, &arguments);
}

// `coherent` packets are faster, but must not meet instances: inside of them Embree 3.13's coherent traversal
// can loop for ever (seen with a filter that accepts hits).
inline void occluded16(const int* valid, RTCScene scene, Context& context, RTCRay16& rays, bool coherent) {
  RTCOccludedArguments arguments;
  rtcInitOccludedArguments(&arguments);
  arguments.flags = coherent ? RTC_RAY_QUERY_FLAG_COHERENT : RTC_RAY_QUERY_FLAG_INCOHERENT;
  arguments.context = &context;
  rtcOccluded16(valid, scene, &rays, &arguments);
}
#else
using Context = RTCIntersectContext;

inline void initialize(Context& context) { rtcInitIntersectContext(&context); }

inline void intersect1(RTCScene scene, Context& context, RTCRayHit& ray) {
  rtcIntersect1(scene, &context, &ray);
}

inline void occluded1(RTCScene scene, Context& context, RTCRay& ray) { rtcOccluded1(scene, &context, &ray); }

inline void occluded16(const int* valid, RTCScene scene, Context& context, RTCRay16& rays, bool coherent) {
  context.flags = coherent ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
  rtcOccluded16(valid, scene, &context, &rays);
}
#endif

struct Release {
  void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
  void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
  void operator()(RTCGeometry geometry) const { rtcReleaseGeometry(geometry); }
};
template <typename Handle>
using Owned = std::unique_ptr<std::remove_pointer_t<Handle>, Release>;

using Device = Owned<RTCDevice>;
using Scene = Owned<RTCScene>;
using Geometry = Owned<RTCGeometry>;

}  // namespace lumirank::geometry::embree
