// Meshes whose vertices the scene itself lists.
#include <algorithm>

#include "scenedesc/meshes/loop_subdivision.h"
#include "scenedesc/pbrt/grids.h"
#include "scenedesc/pbrt/shape_kinds.h"

namespace lumirank::scenedesc::pbrt {

namespace {

using ShapeKind = decltype(ShapeDesc::kind);

std::vector<std::uint32_t> indices(Params& p, std::size_t vertices, std::size_t corners) {
  const auto& numbers = p.numbers("indices", ParamType::integer);
  std::vector<std::uint32_t> out;
  if (numbers.empty()) {
    // The one face that may go without saying.
    if (vertices != corners)
      throw InputError(p.where(), p.title() + " has no \"indices\"", "add \"integer indices\" [ … ]");
    for (std::uint32_t i = 0; i < corners; ++i) out.push_back(i);
    return out;
  }
  if (numbers.size() % corners != 0)
    p.fail("indices",
           "has " + std::to_string(numbers.size()) + " numbers, no multiple of " + std::to_string(corners));
  out.reserve(numbers.size());
  for (const double i : numbers) {
    if (!(i >= 0 && i < static_cast<double>(vertices)))
      p.fail(
          "indices",
          "refers to vertex " + std::to_string(static_cast<long long>(i)) + " of " + std::to_string(vertices),
          "indices start at 0");
    out.push_back(static_cast<std::uint32_t>(i));
  }
  return out;
}

template <typename List>
void check_count(Params& p, const char* name, const List& list, std::size_t vertices) {
  if (!list.empty() && list.size() != vertices)
    p.fail(name,
           "has " + std::to_string(list.size()) + " entries for " + std::to_string(vertices) + " vertices",
           "give one for each point of \"P\"");
}

std::vector<Vec2f> texture_coordinates(Params& p, const char* name) {
  const Parameter* given = p.find(name);
  // In pbrt-v3 a list of numbers as well.
  if (!given || given->type != ParamType::number || !p.reader().version3()) return p.points2(name);
  const auto& v = given->numbers;
  if (v.size() % 2 != 0) p.fail(name, "has an odd count of numbers", "give two for each vertex");
  std::vector<Vec2f> out(v.size() / 2);
  for (std::size_t i = 0; i < out.size(); ++i)
    out[i] = {static_cast<float>(v[2 * i]), static_cast<float>(v[2 * i + 1])};
  return out;
}

// Positions, normals and uv of the list, one of each per vertex.
MeshData vertices(Params& p) {
  MeshData out;
  auto [positions, origin] = near_positions(p.places3("P"));
  out.positions = std::move(positions), out.origin = origin;
  if (out.positions.empty())
    throw InputError(p.where_of("P"), p.title() + " has no points", "add \"point3 P\" [ … ]");
  out.normals = p.points3("N");
  out.uvs = texture_coordinates(p, p.has("st") ? "st" : "uv");
  check_count(p, "N", out.normals, out.positions.size());
  check_count(p, "uv", out.uvs, out.positions.size());
  return out;
}

}  // namespace

std::optional<ShapeKind> held_mesh(Params& p, MeshData mesh) {
  return InlineMeshDesc{std::make_shared<const MeshData>(check_mesh(std::move(mesh), p.where())), p.title()};
}

std::optional<ShapeKind> triangle_mesh(Reader&, Params& p) {
  MeshData mesh = vertices(p);
  mesh.indices = indices(p, mesh.positions.size(), 3);
  p.numbers("S", ParamType::point3), p.numbers("faceIndices", ParamType::integer);
  return held_mesh(p, std::move(mesh));
}

std::optional<ShapeKind> loop_surface(Reader& reader, Params& p) {
  MeshData mesh;
  auto [positions, origin] = near_positions(p.places3("P"));
  mesh.positions = std::move(positions), mesh.origin = origin;
  if (mesh.positions.empty())
    throw InputError(p.where_of("P"), p.title() + " has no points", "add \"point3 P\" [ … ]");
  mesh.indices = indices(p, mesh.positions.size(), 3);
  const int levels = p.integer("levels", 3);
  if (levels < 0) p.fail("levels", "is negative");
  p.ignore({"scheme"});
  // Each level has four times as many triangles.
  constexpr std::size_t kMaxTriangles = 1u << 24;
  int possible = 0;
  for (std::size_t n = mesh.triangle_count(); n > 0 && possible < levels && n <= kMaxTriangles / 4; n *= 4)
    ++possible;
  if (possible < levels && mesh.triangle_count() > 0)
    reader.warn(p.where_of("levels"), std::to_string(levels) + " levels of subdivision of " + p.title(),
                std::to_string(possible));
  return held_mesh(p, loop_subdivided(mesh, possible));
}

std::optional<ShapeKind> bilinear_mesh(Reader& reader, Params& p) {
  const MeshData control = vertices(p);
  const auto corners = indices(p, control.positions.size(), 4);
  if (p.has("emissionfilename")) {
    p.ignore({"emissionfilename"});
    reader.warn(p.where_of("emissionfilename"), "pictures of the light that patches emit", "its mean color");
  }
  p.numbers("faceIndices", ParamType::integer);
  MeshData mesh;
  mesh.origin = control.origin;
  for (std::size_t f = 0; f < corners.size(); f += 4) {
    // In pbrt's order: (0,0), (1,0), (0,1), (1,1).
    const std::uint32_t* c = &corners[f];
    const auto blend = [&](const auto& list, float u, float v) {
      return list[c[0]] * ((1 - u) * (1 - v)) + list[c[1]] * (u * (1 - v)) + list[c[2]] * ((1 - u) * v) +
             list[c[3]] * (u * v);
    };
    const auto& q = control.positions;
    const Vec3f twist = q[c[0]] + q[c[3]] - q[c[1]] - q[c[2]];
    const float size = length(q[c[3]] - q[c[0]]) + length(q[c[2]] - q[c[1]]);
    const int cells = length(twist) <= 1e-5f * size ? 1 : 16;  // a parallelogram is two triangles
    append_grid(mesh, cells, cells, [&](float u, float v) {
      const Vec3f du = (q[c[1]] - q[c[0]]) * (1 - v) + (q[c[3]] - q[c[2]]) * v;
      const Vec3f dv = (q[c[2]] - q[c[0]]) * (1 - u) + (q[c[3]] - q[c[1]]) * u;
      GridPoint out;
      out.position = blend(q, u, v);
      out.normal = control.normals.empty() ? cross(du, dv) : blend(control.normals, u, v);
      out.uv = control.uvs.empty() ? Vec2f{u, v} : blend(control.uvs, u, v);
      return out;
    });
  }
  return held_mesh(p, std::move(mesh));
}

std::optional<ShapeKind> curve(Reader& reader, Params& p) {
  const std::string type = p.text("type", "flat"), basis = p.text("basis", "bezier");
  if (type != "flat" && type != "cylinder" && type != "ribbon")
    p.fail("type", "is " + in_quotes(type), "flat, cylinder and ribbon are known");
  // Hair is flat, and turned to the ray, here too.
  if (type != "cylinder" && !(type == "flat" && reader.material_is_hair()))
    reader.warn_once(p.where(), "curves of the type \"" + type + "\"", "round curves");
  if (basis != "bezier" && basis != "bspline")
    p.fail("basis", "is " + in_quotes(basis), "bezier and bspline are known");
  const int degree = p.integer("degree", 3);
  if (degree != 2 && degree != 3) p.fail("degree", "is neither 2 nor 3");
  const float width = p.number("width", 1), w0 = p.number("width0", width), w1 = p.number("width1", width);
  if (!(w0 >= 0 && w1 >= 0)) p.fail("width0", "or \"width1\" is negative");
  p.ignore({"splitdepth", "N"});

  CurvesDesc out;
  auto [points, origin] = near_positions(p.places3("P"));
  out.points = std::move(points), out.origin = origin;
  if (degree == 2) {
    if (basis == "bspline") p.fail("degree", "is 2 for a b-spline", "give a cubic one");
    // Quadratic pieces raised to cubic ones.
    const auto q = std::move(out.points);
    if (q.size() < 3 || q.size() % 2 == 0)
      p.fail("P", "has " + std::to_string(q.size()) + " points", "a quadratic bezier curve has 2k + 1");
    out.points = {q[0]};
    for (std::size_t i = 0; i + 2 < q.size(); i += 2) {
      out.points.push_back(lerp(q[i], q[i + 1], 2.0f / 3));
      out.points.push_back(lerp(q[i + 2], q[i + 1], 2.0f / 3));
      out.points.push_back(q[i + 2]);
    }
  }
  const bool bspline = basis == "bspline";
  out.basis = bspline ? CurvesDesc::Basis::bspline : CurvesDesc::Basis::bezier;
  const std::size_t n = out.points.size();
  if (n < 4 || (!bspline && n % 3 != 1))
    p.fail("P", "has " + std::to_string(n) + " points",
           bspline ? "a cubic b-spline has at least 4" : "a cubic bezier curve has 3k + 1");
  // Control values that make the width linear along the curve: its value at their mean knots.
  for (std::size_t i = 0; i < n; ++i) {
    const float t = bspline ? (static_cast<float>(i) - 1) / static_cast<float>(n - 3)
                            : static_cast<float>(i) / static_cast<float>(n - 1);
    out.radii.push_back(std::max(0.5f * (w0 + t * (w1 - w0)), 0.0f));
  }
  out.first = {0, static_cast<std::uint32_t>(n)};
  return out;
}

}  // namespace lumirank::scenedesc::pbrt
