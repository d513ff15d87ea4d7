// What an area light does to a shape.
#include <algorithm>
#include <cmath>
#include <utility>

#include "scenedesc/pbrt/shape_kinds.h"
#include "scenedesc/schema/lamp_back.h"

namespace lumirank::scenedesc::pbrt {

namespace {

float area_of(const MeshData& mesh, std::size_t triangle, const Transform& to_world) {
  const auto corner = [&](std::size_t k) {
    return to_world.place(mesh.positions[mesh.indices[3 * triangle + k]] + mesh.origin);
  };
  // In double precision: the triangle may be small, and far away.
  const Vec3d a = corner(0), u = corner(1) - a, v = corner(2) - a;
  return static_cast<float>(0.5 *
                            std::hypot(u.y * v.z - u.z * v.y, u.z * v.x - u.x * v.z, u.x * v.y - u.y * v.x));
}

// pbrt takes the areas of quadrics as they are before their transform, and is one light of each.
bool is_quadric(const std::string& title) {
  return title.find("\"disk\"") != std::string::npos || title.find("\"cylinder\"") != std::string::npos ||
         title.find("\"sphere\"") != std::string::npos;
}

// How many lights pbrt makes of the shape: "power" is that of each.
std::size_t light_count(Params& p, std::size_t triangles) {
  if (is_quadric(p.title())) return 1;
  if (p.title().find("\"bilinearmesh\"") != std::string::npos)
    return std::max<std::size_t>(1, p.numbers("indices", ParamType::integer).size() / 4);
  return triangles;
}

// Radiance over "L" that makes each of pbrt's lights emit `power`, if they are equally large.
float power_factor(Reader& reader, Params& p, const ShapeDesc& shape, const AreaLight& light) {
  const float sides = light.two_sided ? 2 : 1;
  if (const auto* sphere = std::get_if<SphereDesc>(&shape.kind))  // of the untransformed one, as in pbrt
    return light.power / (sides * kPi * 4 * kPi * sphere->radius * sphere->radius);
  const MeshData& mesh = *std::get<InlineMeshDesc>(shape.kind).mesh;
  const std::size_t lights = light_count(p, mesh.triangle_count());
  const Transform to_world = is_quadric(p.title()) ? Transform{} : shape.to_world;
  double sum = 0;
  float min_area = kInfinity, max_area = 0;
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
    const float area = area_of(mesh, t, to_world);
    sum += area, min_area = std::min(min_area, area), max_area = std::max(max_area, area);
  }
  if (lights == mesh.triangle_count() && max_area > 1.01f * min_area)
    reader.warn(p.where(), "the same power for each of many triangles of different sizes (" + p.title() + ")",
                "the same radiance for all, of the same power together");
  return static_cast<float>(static_cast<double>(lights) * light.power / (sides * kPi * sum));
}

}  // namespace

std::optional<ShapeDesc> shine(Reader& reader, Params& p, ShapeDesc& shape, const AreaLight& light) {
  shape.emitter = AreaEmitterDesc{light.radiance, shape.id, light.where};
  if (light.power <= 0 && !light.two_sided) return std::nullopt;
  // Both need the mesh itself.
  if (const auto* file = std::get_if<MeshFileDesc>(&shape.kind)) try {
      shape.kind = InlineMeshDesc{std::make_shared<const MeshData>(read_mesh(*file)), file->filename};
    } catch (const InputError& e) {
      throw InputError(p.where(), "the mesh of " + p.title() + ": " + e.what());
    }
  // What has no triangle is left out when the world is built, and its light with it.
  if (const auto* held = std::get_if<InlineMeshDesc>(&shape.kind))
    if (!held->mesh || held->mesh->triangle_count() == 0) return std::nullopt;
  if (light.power > 0) shape.emitter->radiance.value *= power_factor(reader, p, shape, light);
  if (!light.two_sided) return std::nullopt;
  return back_of(shape);
}

}  // namespace lumirank::scenedesc::pbrt
