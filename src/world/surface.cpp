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
Vec3f point_on(Vec3f p0, Vec3f p1, Vec3f p2, Vec2f b) {
  Vec3f p;
  const double b1 = b.x, b2 = b.y;
  for (int k = 0; k < 3; ++k) {
    const double base = p0[k];
    p[k] = static_cast<float>(base + b1 * (p1[k] - base) + b2 * (p2[k] - base));
  }
  return p;
}

Vec3f unit_or_zero(Vec3f v) {
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

  Vec3f p[3];
  for (int k = 0; k < 3; ++k) {
    p[k] = mesh.positions[c.i[k]];
    if (!data.identity) p[k] = data.to_world.point(p[k]);
  }
  point.position = point_on(p[0], p[1], p[2], b);

  const auto to_world_normal = [&](Vec3f n) {
    if (!data.identity) n = unit_or_zero(Transform::normal(data.inverse, n));
    return data.flip ? -n : n;
  };
  point.ng = to_world_normal(outside_normal(mesh, hit.triangle));
  if (point.ng == Vec3f{}) point.ng = {0, 0, 1};
  Vec3f n = point.ng;
  if (!mesh.normals.empty()) {
    // Each to the world and to unit length before they are mixed, as if the mesh had been moved for good.
    const auto at = [&](int k) {
      const Vec3f local = mesh.normals[c.i[k]];
      return data.identity ? local : to_world_normal(local);
    };
    Vec3f smooth = unit_or_zero(at(0) * b0 + at(1) * b.x + at(2) * b.y);
    if (data.identity && data.flip) smooth = -smooth;
    if (!(smooth == Vec3f{})) n = dot(smooth, point.ng) < 0 ? -smooth : smooth;
  }

  point.uv = interpolate_uv(mesh, hit.triangle, b);
  if (!mesh.uvs.empty()) {
    const Vec2f d1 = mesh.uvs[c.i[1]] - mesh.uvs[c.i[0]], d2 = mesh.uvs[c.i[2]] - mesh.uvs[c.i[0]];
    const Vec3f e1 = p[1] - p[0], e2 = p[2] - p[0];
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
