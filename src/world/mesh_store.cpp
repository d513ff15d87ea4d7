#include "world/mesh_store.h"

#include <algorithm>
#include <cmath>
#include <exception>

#include "base/error.h"
#include "base/near_origin.h"
#include "base/parallel.h"
#include "geometry/tessellate.h"
#include "scenedesc/readers.h"

namespace lumirank::world {

namespace sd = scenedesc;

namespace {

// All shining spheres together get about this many triangles, beyond those of the coarsest: each is a light.
constexpr double kShiningSphereTriangles = 1 << 18;

geometry::TriangleMesh convert(sd::MeshData data, std::vector<std::string>& left_out,
                               std::vector<sd::MeshData::Mended>& mended, Vec3d& origin) {
  origin = data.origin;
  left_out = std::move(data.left_out);
  mended = std::move(data.mended);
  geometry::TriangleMesh mesh;
  mesh.positions = std::move(data.positions);
  mesh.normals = std::move(data.normals);
  mesh.uvs = std::move(data.uvs);
  mesh.colors = std::move(data.colors);
  mesh.indices = std::move(data.indices);
  for (Vec3f& n : mesh.normals) {
    const float len = length(n);
    n = len > 0 && std::isfinite(len) ? n / len : Vec3f{};
  }
  return mesh;
}

// What messages about a shape's mesh call it.
std::string mesh_name(const sd::ShapeDesc& shape) {
  if (const auto* held = std::get_if<sd::InlineMeshDesc>(&shape.kind)) return held->name;
  if (const auto* curves = std::get_if<sd::CurvesDesc>(&shape.kind))
    return curves->filename.empty() ? "a shape of curves" : curves->filename;
  return std::get<sd::MeshFileDesc>(shape.kind).filename;
}

std::string shape_name(const sd::ShapeDesc& shape) {
  return shape.id.empty() ? "the shape" : "the shape \"" + shape.id + "\"";
}

bool is_missing(const sd::ShapeDesc& shape) {
  const auto* held = std::get_if<sd::InlineMeshDesc>(&shape.kind);
  return held && !held->mesh;
}

geometry::TriangleMesh from_curves(const sd::ShapeDesc& shape, const sd::CurvesDesc& desc, Vec3d& origin) {
  const sd::CurvesDesc curves = sd::read_curves(desc);
  origin = curves.origin;
  using Basis = sd::CurvesDesc::Basis;
  const std::size_t count = curves.first.empty() ? 0 : curves.first.size() - 1;
  if (count == 0 && !desc.filename.empty()) return {};
  bool good = count > 0 && curves.radii.size() == curves.points.size() && curves.first[0] == 0 &&
              curves.first.back() == curves.points.size();
  for (std::size_t c = 0; good && c < count; ++c) {
    const std::size_t n = curves.first[c + 1] - std::size_t{curves.first[c]};
    good = curves.first[c + 1] <= curves.points.size() && curves.first[c] < curves.first[c + 1] &&
           n >= (curves.basis == Basis::linear ? 2u : 4u) && (curves.basis != Basis::bezier || n % 3 == 1);
  }
  if (!good)
    throw InputError(shape.where, "the curves have too few points, or lists that do not fit together",
                     "linear curves need 2 points, b-splines 4, bezier curves 4, 7, 10, …");
  for (std::size_t k = 0; k < curves.points.size(); ++k)
    if (!is_finite(curves.points[k]) || !(curves.radii[k] >= 0) || !std::isfinite(curves.radii[k]))
      throw InputError(shape.where, "a point or radius of the curves is not finite, or a radius negative",
                       "give finite points, and radii of 0 or more");
  const auto basis = curves.basis == Basis::bspline  ? geometry::CurveBasis::bspline
                     : curves.basis == Basis::bezier ? geometry::CurveBasis::bezier
                                                     : geometry::CurveBasis::linear;
  geometry::TriangleMesh mesh;
  mesh.fibers = geometry::make_fibers(basis, curves.points, curves.radii, curves.first);
  return mesh;
}

void check_numbers(const sd::ShapeDesc& shape, const std::vector<double>& numbers) {
  for (double v : numbers)
    if (!std::isfinite(v))
      throw InputError(shape.where, "the shape has a number that is not finite", "give finite numbers");
}

void check_radius(const sd::ShapeDesc& shape, float radius) {
  if (!(radius > 0))
    throw InputError(shape.where, "the shape's radius is not positive", "give a positive radius");
}

// A sphere from flat triangles has less area than the round one; the vertices are moved out until the areas
// agree, so that the light of the emitter is right.
void restore_area(geometry::TriangleMesh& mesh, Vec3f center, float radius) {
  // Sizes of about 1: squares of areas leave the range of float early. A power of two changes no bit.
  const float unit = std::exp2(-std::floor(std::log2(radius)));
  double area = 0;
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
    const std::uint32_t* corner = &mesh.indices[3 * t];
    const Vec3f a = mesh.positions[corner[0]] * unit;
    area += 0.5 * length(cross(mesh.positions[corner[1]] * unit - a, mesh.positions[corner[2]] * unit - a));
  }
  if (!(area > 0)) return;
  const double own = radius * unit, want = 4 * 3.14159265358979323846 * own * own;
  const float factor = static_cast<float>(std::sqrt(want / area));
  for (Vec3f& p : mesh.positions) p = center + (p - center) * factor;
}

}  // namespace

int MeshStore::use(const sd::ShapeDesc& shape) {
  Key key{shape.kind.index(), {}, {}, false, nullptr};
  auto& [kind, name, numbers, shines, held] = key;
  if (const auto* file = std::get_if<sd::MeshFileDesc>(&shape.kind)) {
    name = file->filename;
    numbers = {static_cast<double>(file->format),      static_cast<double>(file->shape_index),
               file->face_normals ? 1.0 : 0.0,         file->flip_tex_coords ? 1.0 : 0.0,
               file->max_smooth_angle.value_or(-1.0f), file->smooth_without_normals ? 1.0 : 0.0};
  } else if (const auto* mesh = std::get_if<sd::InlineMeshDesc>(&shape.kind)) {
    held = mesh->mesh.get();
    if (!held) name = mesh->name;
  } else if (const auto* curves = std::get_if<sd::CurvesDesc>(&shape.kind)) {
    name = curves->filename;
    if (name.empty()) held = curves;
    numbers = {static_cast<double>(curves->basis), curves->file_radius};
  } else if (const auto* sphere = std::get_if<sd::SphereDesc>(&shape.kind)) {
    numbers = {sphere->center.x, sphere->center.y, sphere->center.z, sphere->radius};
    shines = shape.emitter.has_value();
    check_radius(shape, sphere->radius);
  } else if (const auto* tube = std::get_if<sd::CylinderDesc>(&shape.kind)) {
    numbers = {tube->p0.x, tube->p0.y, tube->p0.z, tube->p1.x, tube->p1.y, tube->p1.z, tube->radius};
    check_radius(shape, tube->radius);
    if (tube->p0 == tube->p1)
      throw InputError(shape.where, "the cylinder's ends coincide", "give two different points");
  }
  check_numbers(shape, numbers);
  shining_spheres_ += shines ? 1 : 0;
  const auto [it, fresh] = index_.try_emplace(key, static_cast<int>(sources_.size()));
  if (fresh) sources_.push_back({&shape, shines, {}, {}});
  Source& source = sources_[static_cast<std::size_t>(it->second)];
  ++source.uses;
  source.lamps += shape.emitter && !shape.in_group ? 1 : 0;
  return it->second;
}

geometry::TriangleMesh MeshStore::make(Source& source, Vec3d& origin) const {
  const sd::ShapeDesc& shape = *source.shape;
  if (const auto* file = std::get_if<sd::MeshFileDesc>(&shape.kind))
    return convert(sd::read_mesh(*file), source.left_out, source.mended, origin);
  if (const auto* held = std::get_if<sd::InlineMeshDesc>(&shape.kind))
    return held->mesh ? convert(*held->mesh, source.left_out, source.mended, origin)
                      : geometry::TriangleMesh{};
  if (const auto* curves = std::get_if<sd::CurvesDesc>(&shape.kind))
    return from_curves(shape, *curves, origin);
  if (std::holds_alternative<sd::RectangleDesc>(shape.kind)) return geometry::make_rectangle();
  if (std::holds_alternative<sd::CubeDesc>(shape.kind)) return geometry::make_cube();
  if (std::holds_alternative<sd::DiskDesc>(shape.kind)) return geometry::make_disk();
  // Shapes that state a place have an origin of their own where it is far away, as meshes do.
  const auto far_origin = [](std::initializer_list<Vec3d> ends, double radius) {
    Bounds3d box;
    for (const Vec3d& p : ends)
      box.extend(p - Vec3d{radius, radius, radius}), box.extend(p + Vec3d{radius, radius, radius});
    return near_origin(box, sd::kFarMesh);
  };
  if (const auto* tube = std::get_if<sd::CylinderDesc>(&shape.kind)) {
    origin = far_origin({tube->p0, tube->p1}, tube->radius);
    return geometry::make_cylinder(static_cast<Vec3f>(tube->p0 - origin),
                                   static_cast<Vec3f>(tube->p1 - origin), tube->radius);
  }
  if (const auto* sphere = std::get_if<sd::SphereDesc>(&shape.kind)) {
    origin = far_origin({sphere->center}, sphere->radius);
    const auto center = static_cast<Vec3f>(sphere->center - origin);
    if (!source.shines) return geometry::make_sphere(center, sphere->radius);
    // A sphere of r rings has about 4r² triangles.
    const double each = kShiningSphereTriangles / static_cast<double>(shining_spheres_);
    const int rings = std::clamp(static_cast<int>(std::sqrt(each / 4)), 12, 64);
    geometry::TriangleMesh mesh = geometry::make_sphere(center, sphere->radius, rings);
    restore_area(mesh, center, sphere->radius);
    return mesh;
  }
  throw InternalError("MeshStore: a shape without a mesh of its own");
}

void MeshStore::load(Notes& notes) {
  meshes_.resize(sources_.size()), origins_.resize(sources_.size());
  std::vector<std::exception_ptr> failures(sources_.size());
  parallel_for(sources_.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) try {
        meshes_[i] = make(sources_[i], origins_[i]);
        sources_[i].empty = meshes_[i].indices.empty() && meshes_[i].fibers.empty();
      } catch (const InputError& e) {
        // What the scene's own numbers are to blame for has its place in the scene already.
        const sd::ShapeDesc& shape = *sources_[i].shape;
        failures[i] = e.where().file == shape.where.file
                          ? std::current_exception()
                          : std::make_exception_ptr(InputError(
                                shape.where, "the mesh of " + shape_name(shape) + ": " + e.what()));
      } catch (...) {
        failures[i] = std::current_exception();
      }
  });
  for (const auto& failure : failures)
    if (failure) std::rethrow_exception(failure);
  for (const auto& source : sources_) {
    if (source.empty) {
      warn_of_empty(source, notes);
      continue;
    }
    for (const std::string& what : source.left_out)
      notes.note(source.shape->where, mesh_name(*source.shape) + ": " + what + " left out");
    for (const auto& mended : source.mended)
      notes.warn(source.shape->where, mesh_name(*source.shape) + ": " + mended.what, mended.used_instead);
  }
}

std::size_t MeshStore::left_out() const {
  return static_cast<std::size_t>(
      std::count_if(sources_.begin(), sources_.end(), [](const Source& s) { return s.empty; }));
}

std::string MeshStore::why_left_out() const {
  for (const Source& source : sources_)
    if (source.empty) return why_empty(source);
  return {};
}

std::string MeshStore::why_empty(const Source& source) {
  const std::string name = mesh_name(*source.shape);
  if (is_missing(*source.shape)) return name + " is missing";
  std::string why;
  for (const std::string& what : source.left_out) why += (why.empty() ? " (" : ", ") + what;
  return name + " has no triangle to show" + why + (why.empty() ? "" : ")");
}

void MeshStore::warn_of_empty(const Source& source, Notes& notes) const {
  const sd::ShapeDesc& shape = *source.shape;
  // The reader has warned of a missing file, but the light that is gone with it is no small thing.
  if (is_missing(shape) && source.lamps == 0) return;
  std::string text = why_empty(source);
  text += source.uses == 1 ? ": " + shape_name(shape) + " is left out"
                           : ": " + std::to_string(source.uses) + " shapes are left out";
  if (source.lamps > 0)
    text += source.uses == 1 ? ", and its light is gone too"
                             : ", and the light of " + std::to_string(source.lamps) + " of them is gone too";
  notes.warn(shape.where, text, "");
}

}  // namespace lumirank::world
