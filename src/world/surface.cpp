#include "world/surface.h"

#include <cmath>

#include "world/impl.h"

namespace lumirank::world {

namespace {

struct Corners {
  std::uint32_t i[3];
};
Corners corners(const geometry::TriangleMesh& mesh, std::size_t triangle) {
  const std::uint32_t* p = &mesh.indices[3 * triangle];
  return {{p[0], p[1], p[2]}};
}

// In double precision, so that the point lies in the triangle's plane to within one rounding even where the
// triangle is large.
Vec3d point_on(const geometry::TriangleMesh& mesh, const Corners& c, Vec2f b) {
  const Vec3f p0 = mesh.positions[c.i[0]], p1 = mesh.positions[c.i[1]], p2 = mesh.positions[c.i[2]];
  const double b1 = b.x, b2 = b.y;
  const auto mix = [&](double x0, double x1, double x2) { return x0 + b1 * (x1 - x0) + b2 * (x2 - x0); };
  return {mix(p0.x, p1.x, p2.x), mix(p0.y, p1.y, p2.y), mix(p0.z, p1.z, p2.z)};
}

Vec3f unit_or_zero(Vec3f v) {
  const float squared = length_squared(v);
  if (squared > 1e-30f && squared < 1e30f) return v / std::sqrt(squared);
  // Scaled first: the square of a tiny or huge vector leaves the range of float.
  const float max_abs = std::max(std::abs(v.x), std::max(std::abs(v.y), std::abs(v.z)));
  if (!(max_abs > 0) || !std::isfinite(max_abs)) return {};
  return normalize(v / max_abs);
}

}  // namespace

Vec3f outside_normal(const geometry::TriangleMesh& mesh, std::size_t triangle) {
  const Vec3f n = unit_or_zero(mesh.area_vector(triangle));
  if (mesh.normals.empty()) return n;
  const Corners c = corners(mesh, triangle);
  const Vec3f sum = mesh.normals[c.i[0]] + mesh.normals[c.i[1]] + mesh.normals[c.i[2]];
  return dot(sum, n) < 0 ? -n : n;
}

double primitive_area(const World& world, std::uint32_t placement, std::uint32_t primitive) {
  const geometry::Placement& placed = world.rays().placements()[placement];
  const geometry::TriangleMesh& mesh = world.rays().mesh(placed.mesh);
  const Transform& to_world = placed.to_world;
  if (!mesh.fibers.empty()) {
    const geometry::Fibers::Point* ends = &mesh.fibers.points[mesh.fibers.segments[primitive]];
    const double axis = length(to_world.vector(ends[1].position - ends[0].position));
    return axis * std::cbrt(std::abs(static_cast<double>(to_world.determinant3()))) *
           static_cast<double>(ends[0].radius + ends[1].radius);
  }
  const Corners c = corners(mesh, primitive);
  const Vec3f a = mesh.positions[c.i[0]];
  const Vec3f e1 = to_world.vector(mesh.positions[c.i[1]] - a),
              e2 = to_world.vector(mesh.positions[c.i[2]] - a);
  return 0.5 * static_cast<double>(length(cross(e1, e2)));
}

scatter::SurfaceUv interpolate_uv(const geometry::TriangleMesh& mesh, std::uint32_t triangle, Vec2f b) {
  scatter::SurfaceUv at;
  at.uv = b;
  if (mesh.uvs.empty() && mesh.colors.empty()) return at;
  const Corners c = corners(mesh, triangle);
  const float b0 = 1 - b.x - b.y;
  if (!mesh.uvs.empty()) at.uv = mesh.uvs[c.i[0]] * b0 + mesh.uvs[c.i[1]] * b.x + mesh.uvs[c.i[2]] * b.y;
  if (!mesh.colors.empty())
    at.vertex_color = mesh.colors[c.i[0]] * b0 + mesh.colors[c.i[1]] * b.x + mesh.colors[c.i[2]] * b.y;
  return at;
}

scatter::SurfaceUv World::Impl::uv(const geometry::Hit& hit) const {
  const geometry::Fibers& fibers = rays->mesh(hit.mesh).fibers;
  if (!fibers.empty()) {
    // Asked of every crossing, for its opacity: across the fiber nothing varies.
    scatter::SurfaceUv at;
    at.uv = {geometry::fiber_point(fibers, hit.triangle, hit.barycentric.x).parameter, 0.5f};
    return at;
  }
  return interpolate_uv(rays->mesh(hit.mesh), hit.triangle, hit.barycentric);
}

SurfaceHit World::Impl::surface(const geometry::Hit& hit, Vec3f ray_direction) const {
  const geometry::TriangleMesh& mesh = rays->mesh(hit.mesh);
  const geometry::Placement& placement = rays->placements()[hit.instance];
  const PlacementData& data = placements[hit.instance];

  SurfaceHit out;
  out.hit = hit;
  out.material = static_cast<int>(placement.material);
  out.emitter = placement.emitter == 0xffffffffu ? -1 : static_cast<int>(placement.emitter);
  if (!mesh.fibers.empty()) {
    out.point = fiber_surface(hit, ray_direction);
    return out;
  }
  const Corners c = corners(mesh, hit.triangle);
  const Vec2f b = hit.barycentric;
  const float b0 = 1 - b.x - b.y;
  scatter::SurfacePoint& point = out.point;

  const Vec3d local = point_on(mesh, c, b);
  point.position = static_cast<Vec3f>(data.identity ? local : data.to_world.place(local));

  const auto to_world_normal = [&](Vec3f n) {
    if (!data.identity) n = unit_or_zero(Transform::normal(data.inverse, n));
    return data.flip ? -n : n;
  };
  point.ng = to_world_normal(outside_normal(mesh, hit.triangle));
  if (point.ng == Vec3f{}) point.ng = {0, 0, 1};
  Vec3f n = point.ng;
  if (!mesh.normals.empty()) {
    // Each to the world and to unit length before they are mixed, as if the mesh had been moved for good; but
    // what keeps angles may move their mix.
    const bool mixed_first = data.identity || data.keeps_angles;
    const auto at = [&](int k) {
      const Vec3f normal = mesh.normals[c.i[k]];
      return mixed_first ? normal : to_world_normal(normal);
    };
    Vec3f smooth = at(0) * b0 + at(1) * b.x + at(2) * b.y;
    if (mixed_first && !data.identity) smooth = Transform::normal(data.inverse, smooth);
    smooth = unit_or_zero(smooth);
    if (mixed_first && data.flip) smooth = -smooth;
    if (!(smooth == Vec3f{})) n = dot(smooth, point.ng) < 0 ? -smooth : smooth;
  }

  point.uv = interpolate_uv(mesh, hit.triangle, b);
  if (!mesh.uvs.empty()) {
    const Vec2f d1 = mesh.uvs[c.i[1]] - mesh.uvs[c.i[0]], d2 = mesh.uvs[c.i[2]] - mesh.uvs[c.i[0]];
    Vec3f e1 = mesh.positions[c.i[1]] - mesh.positions[c.i[0]];
    Vec3f e2 = mesh.positions[c.i[2]] - mesh.positions[c.i[0]];
    if (!data.identity) e1 = data.to_world.vector(e1), e2 = data.to_world.vector(e2);
    const float determinant = d1.x * d2.y - d1.y * d2.x;
    if (determinant != 0) {
      const Vec3f dpdu = (e1 * d2.y - e2 * d1.y) / determinant, dpdv = (e2 * d1.x - e1 * d2.x) / determinant;
      if (is_finite(dpdu) && is_finite(dpdv)) point.dpdu = dpdu, point.dpdv = dpdv;
    }
  }
  point.shading = Frame::from_normal_tangent(n, unit_or_zero(point.dpdu));
  return out;
}

Rgb World::Impl::emitted_at(int emitter, std::uint32_t triangle, Vec2f barycentric) const {
  const auto& input = radiance[static_cast<std::size_t>(emitter)];
  if (input.texture < 0) return input.value;
  const auto& area = std::get<emitters::AreaEmitter>(emitters[static_cast<std::size_t>(emitter)].kind);
  const auto& mesh = rays->mesh(rays->placements()[area.placement].mesh);
  return materials.textures.lookup(input.texture, interpolate_uv(mesh, triangle, barycentric));
}

}  // namespace lumirank::world
