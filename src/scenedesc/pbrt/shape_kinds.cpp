#include "scenedesc/pbrt/shape_kinds.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "scenedesc/pbrt/grids.h"
#include "scenedesc/schema/files.h"

namespace lumirank::scenedesc::pbrt {

namespace {

using ShapeKind = decltype(ShapeDesc::kind);

float radians(float degrees) { return degrees * (kPi / 180); }

float phi_max(Params& p) {
  const float degrees = p.number("phimax", 360);
  if (!(degrees > 0)) p.fail("phimax", "is not positive", "give an angle in degrees up to 360");
  return radians(std::min(degrees, 360.0f));
}

std::optional<ShapeKind> sphere(Params& p, Transform& to_world) {
  const float radius = p.positive("radius", 1), phi = phi_max(p);
  const float z0 = p.number("zmin", -radius), z1 = p.number("zmax", radius);
  const float low = std::max(std::min(z0, z1), -radius), high = std::min(std::max(z0, z1), radius);
  if (!(low < high))
    p.fail("zmax", "leaves nothing of the sphere", "zmin and zmax lie between -radius and radius");
  if (low > -radius || high < radius || phi < radians(360))
    return held_mesh(p, part_of_sphere(radius, low, high, phi));
  // pbrt's v runs from the south pole up, that of the built-in sphere down.
  to_world = to_world * Transform::scale(1, 1, -1);
  return SphereDesc{{0, 0, 0}, radius};
}

std::optional<ShapeKind> cylinder(Params& p) {
  const float radius = p.positive("radius", 1), z0 = p.number("zmin", -1), z1 = p.number("zmax", 1);
  if (z0 == z1) p.fail("zmax", "is the same as zmin", "give the cylinder a height");
  return held_mesh(p, part_of_cylinder(radius, std::min(z0, z1), std::max(z0, z1), phi_max(p)));
}

std::optional<ShapeKind> disk(Params& p) {
  const float height = p.number("height", 0), radius = p.positive("radius", 1);
  const float inner = p.number("innerradius", 0);
  if (!(inner >= 0 && inner < radius)) p.fail("innerradius", "is not between 0 and the radius");
  return held_mesh(p, part_of_disk(height, radius, inner, phi_max(p)));
}

std::optional<ShapeKind> cone(Params& p) {
  const float radius = p.positive("radius", 1), height = p.number("height", 1);
  const auto line = [&](float v) { return Vec3f{radius * (1 - v), 0, height * v}; };
  return held_mesh(p, turned_about_z(line, 8, phi_max(p)));
}

std::optional<ShapeKind> paraboloid(Params& p) {
  const float radius = p.positive("radius", 1), z0 = p.number("zmin", 0), z1 = p.number("zmax", 1);
  const float low = std::min(z0, z1), high = std::max(z0, z1);
  if (!(low >= 0 && low < high)) p.fail("zmax", "is not above \"zmin\", which is 0 or more");
  const auto line = [&](float v) {
    const float z = low + v * (high - low);
    return Vec3f{radius * std::sqrt(z / high), 0, z};
  };
  return held_mesh(p, turned_about_z(line, 64, phi_max(p)));
}

std::optional<ShapeKind> hyperboloid(Params& p) {
  const auto a = static_cast<Vec3f>(p.point3("p1", {0, 0, 0})),
             b = static_cast<Vec3f>(p.point3("p2", {1, 1, 1}));
  return held_mesh(p, turned_about_z([&](float v) { return lerp(a, b, v); }, 64, phi_max(p)));
}

std::optional<ShapeKind> height_field(Params& p) {
  const int columns = p.integer("nu", 0), rows = p.integer("nv", 0);
  const auto& heights = p.numbers("Pz", ParamType::number);
  if (columns < 2 || rows < 2 ||
      heights.size() / static_cast<std::size_t>(columns) != static_cast<std::size_t>(rows) ||
      heights.size() % static_cast<std::size_t>(columns) != 0)
    p.fail("Pz", "has not \"nu\" times \"nv\" numbers, of at least 2 each");
  MeshData mesh;
  append_grid(mesh, columns - 1, rows - 1, [&](float u, float v) {
    const auto at = [](float t, int n) {
      return static_cast<std::size_t>(std::lround(t * static_cast<float>(n - 1)));
    };
    const double z = heights[at(v, rows) * static_cast<std::size_t>(columns) + at(u, columns)];
    return GridPoint{{u, v, static_cast<float>(z)}, {0, 0, 1}, {u, v}};
  });
  mesh.normals.clear();
  return held_mesh(p, std::move(mesh));
}

// The shapes that pbrt-v4 has no more. Empty: it is none of these.
std::optional<std::optional<ShapeKind>> shape_of_version3(Reader& reader, Params& p,
                                                          const std::string& type) {
  if (type == "cone") return cone(p);
  if (type == "paraboloid") return paraboloid(p);
  if (type == "hyperboloid") return hyperboloid(p);
  if (type == "heightfield") return height_field(p);
  if (type != "nurbs") return std::nullopt;
  reader.warn(p.where(), "the shape " + in_quotes(type), "");
  p.ignore_all();
  return std::optional<ShapeKind>{};
}

std::optional<ShapeKind> ply_mesh(Reader& reader, Params& p) {
  MeshFileDesc out;
  out.format = MeshFormat::ply;
  const std::string name = p.required_text("filename");
  const std::string path = resolve_path(name, SourceLocation(p.where_of("filename")).file);
  const std::string now = reader.path_at_time(path);
  const auto file = reader.file(now == path ? name : now, p.where_of("filename"), "mesh file", "");
  out.filename = file.name;
  out.sequence = Reader::sequence(path);
  out.smooth_without_normals = false;
  if (p.has("displacement")) {
    p.ignore({"displacement", "displacement.edgelength", "edgelength"});
    reader.warn(p.where_of("displacement"), "displaced meshes", "the mesh as it is");
  }
  if (file.missing) return InlineMeshDesc{nullptr, out.filename};
  return out;
}

}  // namespace

std::optional<ShapeKind> make_shape(Reader& reader, Params& p, const std::string& type, Transform& to_world) {
  if (type == "trianglemesh") return triangle_mesh(reader, p);
  if (type == "plymesh") return ply_mesh(reader, p);
  if (type == "bilinearmesh") return bilinear_mesh(reader, p);
  if (type == "loopsubdiv") return loop_surface(reader, p);
  if (type == "sphere") return sphere(p, to_world);
  if (type == "cylinder") return cylinder(p);
  if (type == "disk") return disk(p);
  if (type == "curve") return curve(reader, p);
  if (reader.version3())
    if (auto old = shape_of_version3(reader, p, type)) return std::move(*old);
  throw InputError(p.where(), "the shape " + in_quotes(type) + " is not known",
                   "trianglemesh, plymesh, bilinearmesh, loopsubdiv, sphere, disk, cylinder and curve are");
}

}  // namespace lumirank::scenedesc::pbrt
