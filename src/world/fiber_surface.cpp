// Points of fibers. What the tracer meets is a ribbon that faces the ray; shading sees a round thread.
#include <cmath>

#include "world/impl.h"

namespace lumirank::world {
namespace {

Vec3f unit_or(Vec3f v, Vec3f fallback) {
  const float len = length(v);
  return len > 0 && std::isfinite(len) ? v / len : fallback;
}

}  // namespace

// Hair is as thin as a line for all light: its vertices lie on the axis, whichever way they are seen, so that
// a path is the same traced from either end. Other BSDFs have the surface of the thread, with its normal.
scatter::SurfacePoint World::Impl::fiber_surface(const geometry::Hit& hit, Vec3f ray_direction) const {
  const PlacementData& data = placements[hit.instance];
  geometry::FiberPoint at =
      geometry::fiber_point(rays->mesh(hit.mesh).fibers, hit.triangle, hit.barycentric.x);
  if (!data.identity) {
    at.axis = data.to_world.point(at.axis);
    at.along = unit_or(data.to_world.vector(at.along), at.along);
    at.tangent = unit_or(data.to_world.vector(at.tangent), at.along);
    at.radius *= static_cast<float>(std::cbrt(std::abs(data.to_world.determinant3())));
  }
  scatter::SurfacePoint point;
  point.uv.uv = {at.parameter, 0.5f + 0.5f * hit.barycentric.y};
  // Hair has the segment's own direction: a sine by an interpolated one would not be that of the width which
  // rays meet. It turns little from segment to segment (make_fibers()).
  const Vec3f tangent = data.hair ? at.along : at.tangent;
  point.dpdu = tangent;
  // Across and towards the ray, as Hit says.
  const Vec3f sideways = unit_or(cross(at.along, -ray_direction), Frame::from_normal(at.along).s);
  const Vec3f towards = cross(sideways, at.along);
  const float y = hit.barycentric.y;
  const Vec3f n = data.hair ? towards : towards * std::sqrt(std::max(0.0f, 1 - y * y)) + sideways * y;
  point.position = data.hair ? at.axis : at.axis + n * at.radius;
  point.ng = data.hair ? Vec3f{} : n;
  // The shading normal stays perpendicular to the interpolated tangent.
  const Vec3f bent = unit_or(n - tangent * dot(n, tangent), n);
  point.shading = Frame::from_normal_tangent(bent, tangent);
  point.dpdv = point.shading.t;
  return point;
}

}  // namespace lumirank::world
