// Fibers: chains of thin straight segments with a radius at each point. What curves of any kind are traced
// as.
//
// A fiber is a ribbon that turns its face to every ray (Embree's flat curves): as wide as the round thread, a
// third of the cost, and without an inside in which a ray could be caught. It is cut off straight at both
// ends of a curve, so that all around it shows 2∫r·sinθ dl, θ the angle between fiber and view, and is
// rounded on the outer side of its bends.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/bounds.h"
#include "base/transform.h"
#include "base/vec.h"

namespace lumirank::geometry {

struct Fibers {
  struct Point {  // as Embree reads it
    Vec3f position;
    float radius = 0;
  };
  std::vector<Point> points;
  std::vector<float> parameter;         // per point: 0 at the root of its curve, 1 at the tip (a texture's u)
  std::vector<std::uint32_t> segments;  // the first point of each; it ends at the point after
  bool smooth = false;                  // tangents are interpolated between segments

  bool empty() const { return segments.empty(); }
  // Another segment of the same curve ends where this one begins, or begins where it ends.
  bool follows(std::uint32_t segment) const {
    return segment > 0 && segments[segment - 1] + 1 == segments[segment];
  }
  bool goes_on(std::uint32_t segment) const {
    return segment + std::size_t{1} < segments.size() && segments[segment + 1] == segments[segment] + 1;
  }
  double area() const;  // of the round threads
  Bounds3f bounds() const;
  void transform(const Transform& t);  // radii by the cube root of the volume's change
};

enum class CurveBasis { bspline, bezier, linear };

// Cuts curves into straight segments. `first`: where each curve begins, and the number of points at the end;
// a cubic b-spline needs at least 4 points, a bezier curve 3k + 1, a polyline 2 (InternalError otherwise). A
// cubic piece gets as many segments as it turns by 5°, 24 at most. Segments without length are left out.
Fibers make_fibers(CurveBasis basis, std::span<const Vec3f> points, std::span<const float> radii,
                   std::span<const std::uint32_t> first);

// Part u of the way along a segment.
struct FiberPoint {
  Vec3f axis;     // on the segment
  Vec3f along;    // unit; the direction of the segment
  Vec3f tangent;  // unit; the same, or interpolated
  float radius = 0;
  float parameter = 0;
};
FiberPoint fiber_point(const Fibers& fibers, std::uint32_t segment, float u);

}  // namespace lumirank::geometry
