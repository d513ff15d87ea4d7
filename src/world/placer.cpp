#include "world/placer.h"

#include <cmath>
#include <string>

#include "base/error.h"
#include "base/parallel.h"

namespace lumirank::world {

namespace sd = scenedesc;

namespace {

void check_transform(const Transform& t, const SourceLocation& where) {
  if (!t.is_finite()) throw InputError(where, "to_world is not finite", "give finite numbers");
  if (t.m[12] != 0 || t.m[13] != 0 || t.m[14] != 0 || t.m[15] != 1)
    throw InputError(where, "to_world is not affine (its last row is not 0 0 0 1)", "give an affine matrix");
}

bool is_group(const sd::ShapeDesc& s) { return std::holds_alternative<sd::ShapeGroupDesc>(s.kind); }
const sd::InstanceDesc* as_instance(const sd::ShapeDesc& s) { return std::get_if<sd::InstanceDesc>(&s.kind); }

const sd::ShapeDesc& shape_at(const sd::SceneDesc& desc, int index, const SourceLocation& user) {
  if (index < 0 || static_cast<std::size_t>(index) >= desc.shapes.size())
    throw InputError(user, "a shape is referred to that the scene does not have", "define it");
  return desc.shapes[static_cast<std::size_t>(index)];
}

bool shines(const sd::ShapeDesc& shape, Notes& notes) {
  if (!shape.emitter || !std::holds_alternative<sd::CurvesDesc>(shape.kind)) return shape.emitter.has_value();
  notes.warn(shape.where, "an emitter on curves", "the curves without it");
  return false;
}

void place_instance(const sd::SceneDesc& desc, const sd::ShapeDesc& instance, MeshStore& store, Notes& notes,
                    std::vector<Placed>& out) {
  const sd::ShapeDesc& group = shape_at(desc, as_instance(instance)->group, instance.where);
  if (!is_group(group))
    throw InputError(instance.where, "the instance refers to something that is not a shape group",
                     "refer to a shapegroup");
  if (instance.emitter) notes.warn(instance.where, "an emitter on an instance", "the instance without it");
  for (int member : std::get<sd::ShapeGroupDesc>(group.kind).shapes) {
    const sd::ShapeDesc& child = shape_at(desc, member, group.where);
    if (is_group(child) || as_instance(child))
      throw InputError(child.where, "a shape group holds another group or an instance",
                       "groups cannot be nested: place the shapes themselves in the group");
    check_transform(child.to_world, child.where);
    out.push_back({store.use(child), instance.to_world * child.to_world,
                   child.flip_normals != instance.flip_normals, &child, false, &instance});
  }
}

// Moves a mesh into the world, the outside kept: a mirroring map or flipped normals reverse the order of the
// corners.
void bake(geometry::TriangleMesh& mesh, const Transform& to_world, bool flip) {
  const std::optional<Transform> inverse = to_world.inverse();
  mesh.fibers.transform(to_world);
  const bool reverse = (to_world.determinant3() < 0) != flip;
  if (!to_world.is_identity()) {
    parallel_for(mesh.positions.size(), 1 << 16, [&](std::size_t b, std::size_t e) {
      for (std::size_t i = b; i < e; ++i) mesh.positions[i] = to_world.point(mesh.positions[i]);
    });
    // A map that flattens the mesh leaves no meaning to its vertex normals.
    if (!inverse) mesh.normals.clear();
    parallel_for(mesh.normals.size(), 1 << 16, [&](std::size_t b, std::size_t e) {
      for (std::size_t i = b; i < e; ++i) {
        const Vec3f n = Transform::normal(*inverse, mesh.normals[i]);
        const float len = length(n);
        mesh.normals[i] = len > 0 && std::isfinite(len) ? n / len : Vec3f{};
      }
    });
  }
  if (flip)
    for (Vec3f& n : mesh.normals) n = -n;
  if (reverse)
    for (std::size_t t = 0; t + 2 < mesh.indices.size(); t += 3)
      std::swap(mesh.indices[t + 1], mesh.indices[t + 2]);
}

double total_area(const geometry::TriangleMesh& mesh) {
  if (!mesh.fibers.empty()) return mesh.fibers.area();
  return parallel_sum(mesh.triangle_count(), std::size_t{1} << 16, 0.0, [&](std::size_t b, std::size_t e) {
    double sum = 0;
    for (std::size_t t = b; t < e; ++t) sum += 0.5 * static_cast<double>(length(mesh.area_vector(t)));
    return sum;
  });
}

bool all_finite(const geometry::TriangleMesh& mesh) {
  for (const Vec3f& p : mesh.positions)
    if (!is_finite(p)) return false;
  for (const geometry::Fibers::Point& p : mesh.fibers.points)
    if (!is_finite(p.position) || !std::isfinite(p.radius)) return false;
  return true;
}

}  // namespace

std::vector<Placed> place_shapes(const sd::SceneDesc& desc, MeshStore& store, Notes& notes) {
  std::vector<Placed> out;
  for (const sd::ShapeDesc& shape : desc.shapes) {
    if (shape.in_group) {
      if (shape.emitter) notes.warn(shape.where, "an emitter in a shape group", "the shape without it");
      continue;
    }
    if (is_group(shape)) continue;
    check_transform(shape.to_world, shape.where);
    if (as_instance(shape))
      place_instance(desc, shape, store, notes, out);
    else
      out.push_back({store.use(shape), shape.to_world, shape.flip_normals, &shape, shines(shape, notes)});
  }
  return out;
}

Units units_for(const std::vector<Placed>& placed, const MeshStore& store) {
  std::vector<Bounds3f> boxes(store.size());
  parallel_for(boxes.size(), 1, [&](std::size_t b, std::size_t e) {
    for (std::size_t s = b; s < e; ++s) {
      const geometry::TriangleMesh& mesh = store.mesh(static_cast<int>(s));
      boxes[s] = mesh.fibers.bounds();
      for (const std::uint32_t k : mesh.indices) boxes[s].extend(mesh.positions[k]);  // of those in use
    }
  });
  Bounds3d all;
  double min_radius = kInfinity;
  for (const Placed& p : placed) {
    const Bounds3f& box = boxes[static_cast<std::size_t>(p.source)];
    if (box.empty()) continue;
    Bounds3d own;
    for (int corner = 0; corner < 8; ++corner) {
      const Vec3f local{corner & 1 ? box.hi.x : box.lo.x, corner & 2 ? box.hi.y : box.lo.y,
                        corner & 4 ? box.hi.z : box.lo.z};
      own.extend(p.to_world.place(local + store.origin(p.source)));
    }
    all.extend(own.lo), all.extend(own.hi);
    if (own.radius() > 0) min_radius = std::min(min_radius, own.radius());
  }
  return Units(all, min_radius);
}

Geometry assemble(std::vector<Placed> placed, MeshStore& store, const Units& units, Notes& notes) {
  for (Placed& p : placed) {
    const Vec3d origin = store.origin(p.source);
    if (!(origin == Vec3d{})) p.to_world = p.to_world * Transform::translate(origin);
    p.to_world = units.to_world(p.to_world);
  }
  Geometry g;
  std::erase_if(placed, [&](const Placed& p) { return store.is_empty(p.source); });
  std::vector<std::size_t> uses(store.size(), 0);
  for (const Placed& p : placed) ++uses[static_cast<std::size_t>(p.source)];
  for (std::size_t s = 0; s < store.size(); ++s)
    g.unique_triangles += store.mesh(static_cast<int>(s)).triangle_count();

  std::vector<int> shared(store.size(), -1);  // mesh that all placements of a source share
  for (Placed& p : placed) {
    const auto source = static_cast<std::size_t>(p.source);
    const geometry::TriangleMesh& original = store.mesh(p.source);
    const std::size_t triangles = original.triangle_count(), segments = original.fibers.segments.size();
    const bool copy = p.shines || uses[source] == 1 || !p.to_world.inverse();
    geometry::Placement placement;
    bool flip = false;
    if (copy) {
      geometry::TriangleMesh mesh = uses[source] == 1 ? store.take(p.source) : original;
      bake(mesh, p.to_world, p.flip_normals);
      if (!all_finite(mesh))
        throw InputError(p.shape->where, "to_world overflows", "reduce its scale or translation");
      if (!(total_area(mesh) > 0)) {
        notes.warn(p.shape->where,
                   p.shines ? "the shape has no area, so its light is gone too" : "the shape has no area",
                   "");
        continue;
      }
      placement.mesh = static_cast<std::uint32_t>(g.meshes.size());
      g.meshes.push_back(std::move(mesh));
      p.to_world = Transform{};
    } else {
      if (shared[source] < 0) {
        shared[source] = static_cast<int>(g.meshes.size());
        g.meshes.push_back(original);
      }
      placement.mesh = static_cast<std::uint32_t>(shared[source]);
      placement.to_world = p.to_world;
      flip = p.flip_normals;
    }
    g.triangles += triangles, g.segments += segments;
    g.placements.push_back(placement);
    g.flip.push_back(flip);
    g.placed.push_back(p);
  }
  return g;
}

}  // namespace lumirank::world
