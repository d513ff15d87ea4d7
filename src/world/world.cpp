#include "world/world.h"

#include <cmath>
#include <utility>

#include "base/error.h"
#include "world/impl.h"
#include "world/lights.h"
#include "world/material_builder.h"
#include "world/mesh_store.h"
#include "world/notes.h"
#include "world/placer.h"
#include "world/surface.h"
#include "world/texture_builder.h"

namespace lumirank::world {

namespace sd = scenedesc;

namespace {

geometry::Blocking blocking(scatter::MaterialSet::Passage passage) {
  switch (passage) {
    case scatter::MaterialSet::Passage::attenuating:
      return geometry::Blocking::attenuating;
    case scatter::MaterialSet::Passage::cutout:
      return geometry::Blocking::cutout;
    case scatter::MaterialSet::Passage::opaque:
      break;
  }
  return geometry::Blocking::opaque;
}

std::size_t bytes_of(const geometry::TriangleMesh& m) {
  return m.positions.size() * sizeof(Vec3f) + m.normals.size() * sizeof(Vec3f) +
         m.uvs.size() * sizeof(Vec2f) + m.colors.size() * sizeof(Rgb) +
         m.indices.size() * sizeof(std::uint32_t) +
         m.fibers.points.size() * (sizeof(geometry::Fibers::Point) + sizeof(float)) +
         m.fibers.segments.size() * sizeof(std::uint32_t);
}

std::size_t bytes_of(const emitters::Emitter& emitter) {
  if (const auto* area = std::get_if<emitters::AreaEmitter>(&emitter.kind))
    return area->triangles.size() * (sizeof(emitters::AreaEmitter::Triangle) + sizeof(double));
  if (const auto* sky = std::get_if<emitters::EnvironmentEmitter>(&emitter.kind))
    return sky->radiance.size() * (sizeof(Rgb) + sizeof(double));
  return 0;
}

Carrier carrier(const sd::ShapeDesc& shape) {
  return std::holds_alternative<sd::CurvesDesc>(shape.kind) ? Carrier::fibers : Carrier::surface;
}

void step(const Sinks& sinks, double fraction) {
  if (sinks.cancelled()) throw Cancelled();
  sinks.report("scene", fraction);
}

}  // namespace

World::World(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
World::World(World&&) noexcept = default;
World::~World() = default;

World World::build(const sd::SceneDesc& desc, const BuildOptions& options, std::vector<sd::Warning>& warnings,
                   const Sinks& sinks) {
  Notes notes(warnings, options.strict);
  if (desc.sensors.empty())
    throw InputError(SourceLocation{desc.source_file, 0}, "the scene has no sensor", "add a camera");
  for (const auto& sensor : desc.sensors) Camera{sensor};  // throws where one makes no sense

  step(sinks, 0);
  MeshStore store;
  std::vector<Placed> placed = place_shapes(desc, store, notes);
  if (placed.empty())
    throw InputError(SourceLocation{desc.source_file, 0}, "the scene has no geometry", "add a shape");
  TextureBuilder textures(desc);
  MaterialBuilder materials(desc, textures, notes);
  for (const Placed& p : placed) {
    textures.needed_by(*p.shape);
    materials.use(p.shape->bsdf, p.shape->where, carrier(*p.shape));
    if (p.shines) textures.color(p.shape->emitter->radiance, p.shape->emitter->where);
  }
  store.load(notes);
  step(sinks, 0.4);
  auto impl = std::make_unique<Impl>();
  Impl& w = *impl;

  const std::size_t meshes = store.size() - store.left_out(), left_out = store.left_out();
  w.units = units_for(placed, store);
  Geometry geometry = assemble(std::move(placed), store, w.units, notes);
  if (geometry.placements.empty())
    throw InputError(SourceLocation{desc.source_file, 0},
                     "no shape of the scene has any area" +
                         (store.left_out() > 0 ? ": " + store.why_left_out() : std::string()),
                     "add a shape that has");
  step(sinks, 0.5);

  // Indices are settled: the builders answer from memory from here on.
  std::vector<int> material_of;
  std::vector<scatter::ColorInput> radiance_of;
  for (const Placed& p : geometry.placed) {
    material_of.push_back(materials.use(p.shape->bsdf, p.shape->where, carrier(*p.shape)));
    radiance_of.push_back(p.shines ? textures.color(p.shape->emitter->radiance, p.shape->emitter->where)
                                   : scatter::ColorInput{});
  }
  w.materials.materials = materials.take();
  // Heights of bumps are lengths.
  for (auto& material : w.materials.materials)
    if (auto* bump = std::get_if<scatter::BumpMaterial>(&material))
      bump->scale *= static_cast<float>(w.units.scale());
  w.materials.textures = textures.finish();
  step(sinks, 0.6);

  EmitterNames names;
  for (std::size_t i = 0; i < geometry.placed.size(); ++i) {
    const Placed& p = geometry.placed[i];
    auto& placement = geometry.placements[i];
    placement.material = static_cast<std::uint32_t>(material_of[i]);
    placement.blocking = blocking(w.materials.passage(material_of[i]));
    w.placements.push_back({placement.to_world.is_identity(), w.materials.is_hair(material_of[i]),
                            geometry.flip[i], placement.to_world,
                            placement.to_world.inverse().value_or(Transform{})});
    if (!p.shines) continue;
    emitters::AreaEmitter area = make_area_emitter(
        geometry.meshes[placement.mesh], static_cast<std::uint32_t>(i), radiance_of[i], w.materials.textures);
    for (const auto& t : area.triangles) {
      if (!is_finite(t.mean_radiance))
        throw InputError(p.shape->emitter->where, "the radiance is not finite", "give finite numbers");
      check_light(max_component(t.mean_radiance), "the radiance", p.shape->emitter->where);
    }
    if (!(area.by_power.total() > 0)) continue;  // black
    placement.emitter = static_cast<std::uint32_t>(w.emitters.size());
    emitters::Emitter emitter;
    emitter.kind = std::move(area);
    names.name(emitter, p.shape->emitter->id.empty() ? p.shape->id : p.shape->emitter->id,
               p.shape->emitter->where);
    w.emitters.push_back(std::move(emitter));
    w.radiance.push_back(radiance_of[i]);
  }
  w.environment = add_lights(desc, names, w.units, notes, w.emitters);
  w.radiance.resize(w.emitters.size());
  for (std::size_t k = 0; k < w.emitters.size(); ++k) {
    const auto* sun = std::get_if<emitters::DirectionalEmitter>(&w.emitters[k].kind);
    if (sun && sun->cos_half_angle < 1) w.suns.push_back(k);
  }
  if (w.emitters.empty())
    notes.warn(SourceLocation{desc.source_file, 0}, "the scene has no light", "a black picture");

  w.info.meshes = meshes, w.info.meshes_left_out = left_out;
  w.info.instances = geometry.placements.size();
  w.info.triangles = geometry.triangles;
  w.info.segments = geometry.segments;
  w.info.unique_triangles = geometry.unique_triangles;
  w.info.textures = w.materials.textures.textures.size();
  w.info.materials = w.materials.materials.size();
  w.info.emitters = w.emitters.size();
  w.info.memory_bytes = textures.memory_bytes();
  for (const auto& mesh : geometry.meshes) w.info.memory_bytes += bytes_of(mesh);
  for (const auto& emitter : w.emitters) w.info.memory_bytes += bytes_of(emitter);
  step(sinks, 0.7);

  geometry::RayScene::PassageCallbacks callbacks;
  callbacks.opacity = [&w](const geometry::Hit& hit) {
    return w.materials.opacity(static_cast<int>(w.rays->placements()[hit.instance].material), w.uv(hit));
  };
  callbacks.transmittance = [&w](const geometry::Hit& hit, Vec3f direction) {
    const SurfaceHit at = w.surface(hit, direction);
    return w.materials.transmittance(at.material, at.point, normalize(direction));
  };
  w.rays.emplace(std::move(geometry.meshes), std::move(geometry.placements), std::move(callbacks));
  w.bounds = w.rays->bounds();
  w.info.memory_bytes += w.rays->memory_bytes();
  step(sinks, 1);
  return World(std::move(impl));
}

const geometry::RayScene& World::rays() const { return *impl_->rays; }
const scatter::MaterialSet& World::materials() const { return impl_->materials; }
const std::vector<emitters::Emitter>& World::emitters() const { return impl_->emitters; }
int World::environment() const { return impl_->environment; }
const Bounds3f& World::bounds() const { return impl_->bounds; }
const Units& World::units() const { return impl_->units; }
const WorldInfo& World::info() const { return impl_->info; }

std::optional<SurfaceHit> World::intersect(const geometry::Ray& ray) const {
  const std::optional<geometry::Hit> hit = impl_->rays->intersect(ray);
  if (!hit) return std::nullopt;
  return impl_->surface(*hit, ray.direction);
}

SurfaceHit World::surface(const geometry::Hit& hit, Vec3f ray_direction) const {
  return impl_->surface(hit, ray_direction);
}

Rgb World::emitted(const SurfaceHit& at, Vec3f wo) const {
  if (at.emitter < 0 || !(dot(wo, at.point.ng) > 0)) return Rgb{};
  return impl_->emitted_at(at.emitter, at.hit.triangle, at.hit.barycentric);
}

Rgb World::emitted(int emitter, std::uint32_t triangle, Vec2f barycentric) const {
  return impl_->emitted_at(emitter, triangle, barycentric);
}

Rgb World::background(Vec3f direction) const {
  if (impl_->environment < 0) return Rgb{};
  const auto& kind = impl_->emitters[static_cast<std::size_t>(impl_->environment)].kind;
  return std::get<emitters::EnvironmentEmitter>(kind).eval(direction);
}

Rgb World::sun_disc(Vec3f direction) const {
  Rgb sum;
  for (const std::size_t k : impl_->suns) {
    const auto& sun = std::get<emitters::DirectionalEmitter>(impl_->emitters[k].kind);
    // E = L π sin²α on a facing surface.
    if (dot(direction, sun.direction) < -sun.cos_half_angle)
      sum += sun.irradiance / (kPi * (1 - square(sun.cos_half_angle)));
  }
  return sum;
}

emitters::DirectSample World::sample_direct(int emitter, Vec3f point, float u1, Vec2f u2) const {
  const auto& e = impl_->emitters[static_cast<std::size_t>(emitter)];
  emitters::DirectSample s = emitters::sample_direct(e, point, u1, u2);
  if (s.pdf > 0 && std::holds_alternative<emitters::AreaEmitter>(e.kind))
    s.radiance = impl_->emitted_at(emitter, s.triangle, s.barycentric);
  return s;
}

emitters::Emission World::sample_emission(int emitter, float u1, Vec2f u_position, Vec2f u_direction) const {
  const auto& e = impl_->emitters[static_cast<std::size_t>(emitter)];
  emitters::Emission s = emitters::sample_emission(e, impl_->bounds, u1, u_position, u_direction);
  const auto* area = std::get_if<emitters::AreaEmitter>(&e.kind);
  if (area && impl_->radiance[static_cast<std::size_t>(emitter)].texture >= 0 && !(s.normal == Vec3f{})) {
    const auto& t = area->triangles[s.triangle];
    const float pdf = area->by_power.pmf(s.triangle) / t.area;
    s.weight = impl_->emitted_at(emitter, s.triangle, s.barycentric) * (kPi / pdf);
  }
  return s;
}

Vec3f World::offset_origin(Vec3f p, Vec3f ng, Vec3f direction) {
  // Positions and intersection distances are rounded in proportion to the coordinates they are computed from
  // (2⁻²⁴ of them, several times over), so the step is 5·10⁻⁵ of the point's largest coordinate: a few
  // hundred roundings. Near the origin of the world, where the triangles' corners are larger than the point,
  // the step stays at that of a coordinate of 0.02.
  const float size = std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z), 0.02f});
  const float step = 5e-5f * size;
  if (ng == Vec3f{}) return p + direction * (step / length(direction));
  return p + ng * (dot(direction, ng) < 0 ? -step : step);
}

}  // namespace lumirank::world
