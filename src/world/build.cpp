// A description → a world, in steps: what is placed, its materials and textures, its light, the ray scene.
#include <cmath>
#include <map>
#include <memory>
#include <string>
#include <utility>

#include "base/error.h"
#include "base/hash_text.h"
#include "base/parallel.h"
#include "world/colored_glass.h"
#include "world/emission_mesh.h"
#include "world/impl.h"
#include "world/lights.h"
#include "world/material_builder.h"
#include "world/media_builder.h"
#include "world/mesh_store.h"
#include "world/notes.h"
#include "world/panes.h"
#include "world/placer.h"
#include "world/surface.h"
#include "world/texture_builder.h"
#include "world/touching_faces.h"

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

// All meshes together that shine by pictures are divided into about so many triangles at most.
constexpr std::size_t kTrianglesOfPictures = std::size_t{1} << 15;

// Triangles of a mesh that is worth it: fewer are built in a twentieth of a second.
constexpr std::size_t kRefitLimit = std::size_t{1} << 16;

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

bool keeps_angles(const Transform& t) {
  constexpr double kRounding = 1e-6;
  const Vec3d x = t.axis(0), y = t.axis(1), z = t.axis(2);
  const auto product = [](Vec3d a, Vec3d b) { return a.x * b.x + a.y * b.y + a.z * b.z; };
  const double size = product(x, x), slack = kRounding * size;
  return std::abs(product(y, y) - size) <= slack && std::abs(product(z, z) - size) <= slack &&
         std::abs(product(x, y)) <= slack && std::abs(product(y, z)) <= slack &&
         std::abs(product(z, x)) <= slack;
}

Carrier carrier(const sd::ShapeDesc& shape) {
  return std::holds_alternative<sd::CurvesDesc>(shape.kind) ? Carrier::fibers : Carrier::surface;
}

}  // namespace

class World::Builder {
 public:
  Builder(const sd::SceneDesc& desc, const BuildOptions& options, std::vector<sd::Warning>& warnings,
          const Sinks& sinks)
      : desc_(desc),
        given_units_(options.units),
        before_(options.before),
        refit_(options.refit),
        with_media_(options.media),
        straight_panes_(options.straight_panes),
        sinks_(sinks),
        notes_(warnings, options.strict),
        textures_(desc),
        materials_(desc, textures_, notes_) {}

  std::unique_ptr<Impl> build() {
    check_cameras();
    step(0);
    place();
    step(0.4);
    assemble_geometry();
    step(0.5);
    set_materials();
    set_media();
    part_touching();
    step(0.6);
    for (std::size_t i = 0; i < geometry_.placed.size(); ++i) {
      set_placement(i);
      if (geometry_.placed[i].shines) add_area_emitter(i);
    }
    add_other_lights();
    share_meshes();
    count();
    step(0.7);
    make_rays();
    step(1);
    return std::move(impl_);
  }

 private:
  void step(double fraction) const {
    if (sinks_.cancelled()) throw Cancelled();
    sinks_.report("scene", fraction);
  }
  SourceLocation whole_scene() const { return {desc_.source_file, 0}; }
  int material_of(const Placed& p) {
    return materials_.use(p.shape->bsdf, p.shape->where, carrier(*p.shape));
  }
  scatter::ColorInput radiance_of(const Placed& p) {
    return p.shines ? textures_.color(p.shape->emitter->radiance, p.shape->emitter->where)
                    : scatter::ColorInput{};
  }

  void check_cameras() const {
    if (desc_.sensors.empty()) throw InputError(whole_scene(), "the scene has no sensor", "add a camera");
    for (const auto& sensor : desc_.sensors) Camera{sensor};  // throws where one makes no sense
  }

  // What is used is noted before anything is loaded: errors in the scene come first.
  void place() {
    placed_ = place_shapes(desc_, store_, notes_);
    if (placed_.empty()) throw InputError(whole_scene(), "the scene has no geometry", "add a shape");
    for (const auto& e : desc_.emitters) {
      const auto* projection = std::get_if<scenedesc::ProjectionLightDesc>(&e.kind);
      pictures_.push_back(projection ? textures_.color(projection->picture, e.where) : scatter::ColorInput{});
    }
    for (const Placed& p : placed_) {
      textures_.needed_by(*p.shape);
      material_of(p);
      radiance_of(p);
    }
    store_.load(notes_);
  }

  void assemble_geometry() {
    w_.info.meshes = store_.size() - store_.left_out(), w_.info.meshes_left_out = store_.left_out();
    w_.units = given_units_ ? *given_units_ : units_for(placed_, store_);
    geometry_ = assemble(std::move(placed_), store_, w_.units, notes_);
    if (geometry_.placements.empty())
      throw InputError(whole_scene(),
                       "no shape of the scene has any area" +
                           (store_.left_out() > 0 ? ": " + store_.why_left_out() : std::string()),
                       "add a shape that has");
  }

  // Indices are settled: the builders answer from memory from here on.
  void set_materials() {
    for (const Placed& p : geometry_.placed) {
      material_of_.push_back(material_of(p));
      radiance_of_.push_back(radiance_of(p));
      if (radiance_of_.back().texture >= 0) ++shining_pictures_;
    }
    w_.materials.materials = materials_.take();
    // Heights of bumps are lengths.
    for (auto& material : w_.materials.materials)
      if (auto* bump = std::get_if<scatter::BumpMaterial>(&material))
        bump->scale *= static_cast<float>(w_.units.scale());
    w_.materials.textures = textures_.finish();
    w_.materials.note_bitmaps();
  }

  void set_media() {
    if (desc_.media.empty()) return;
    if (!with_media_ && may_color_glass(desc_)) {
      w_.absorption = absorption_of_glass(desc_);
      for (Rgb& a : w_.absorption) a *= static_cast<float>(1 / w_.units.scale());
      return;
    }
    if (!with_media_) return notes_.warn(desc_.media[0].where, "participating media", "empty space");
    MediaBuilder media(desc_, notes_);
    w_.media = media.build(w_.units);
    w_.info.media = w_.media.size();
    w_.info.memory_bytes += media.memory_bytes();
  }

  void part_touching() {
    std::vector<Part> parts;
    for (std::size_t i = 0; i < material_of_.size(); ++i) {
      const Placed& placed = geometry_.placed[i];
      if (materials_.transmits(material_of_[i]))
        parts.push_back(knows_media() && placed.shape->media.divides ? Part::medium : Part::clear);
      else
        parts.push_back(placed.shines && placed.shape->emitter->seen ? Part::lamp : Part::opaque);
    }
    w_.info.touching_faces = part_touching_faces(geometry_.meshes, geometry_.placements, parts);
  }

  // Asked once of all placements that differ in size and place alone.
  bool is_pane(const geometry::Placement& placement) {
    const geometry::TriangleMesh& mesh = geometry_.meshes[placement.mesh];
    if (!keeps_angles(placement.to_world)) return is_made_of_panes(mesh, placement.to_world);
    const auto known = panes_.find(placement.mesh);
    if (known != panes_.end()) return known->second;
    return panes_[placement.mesh] = is_made_of_panes(mesh, placement.to_world);
  }

  // Glass of a pane becomes a sheet of which each of the two faces does its part.
  void straighten(std::size_t i) {
    const auto& placement = geometry_.placements[i];
    auto& materials = w_.materials.materials;
    const auto* glass = std::get_if<scatter::DielectricMaterial>(&materials[index_of(material_of_[i])]);
    if (!glass || !glass->smooth) return;
    if ((knows_media() && geometry_.placed[i].shape->media.divides) || !is_pane(placement)) {
      ++w_.info.bending_glass;
      return;
    }
    const auto [known, is_new] =
        face_of_pane_.try_emplace(material_of_[i], static_cast<int>(materials.size()));
    material_of_[i] = known->second;
    ++w_.info.panes;
    if (is_new)
      materials.push_back(scatter::SlabFaceMaterial{glass->eta, glass->specular_reflectance,
                                                    glass->specular_transmittance, known->first});
  }
  bool knows_media() const { return with_media_ || !w_.absorption.empty(); }
  static std::size_t index_of(int material) { return static_cast<std::size_t>(material); }

  void set_placement(std::size_t i) {
    auto& placement = geometry_.placements[i];
    if (straight_panes_) straighten(i);
    placement.material = static_cast<std::uint32_t>(material_of_[i]);
    placement.blocking = blocking(w_.materials.passage(material_of_[i]));
    // Behind the holes of a cut-out that divides media is another one, which rays must learn.
    if (with_media_ && geometry_.placed[i].shape->media.divides &&
        placement.blocking == geometry::Blocking::cutout)
      placement.blocking = geometry::Blocking::attenuating;
    w_.placements.push_back({placement.to_world.is_identity(), keeps_angles(placement.to_world),
                             w_.materials.is_hair(material_of_[i]), geometry_.flip[i], placement.to_world,
                             placement.to_world.inverse().value_or(Transform{}),
                             knows_media() ? geometry_.placed[i].shape->media : sd::MediumInterfaceDesc{}});
    const Placed& placed = geometry_.placed[i];
    std::string name = placed.shape->id;
    if (placed.instance) name += '\n' + placed.instance->id;
    w_.placement_ids.push_back(hash_text(name + '\n' + std::to_string(named_[name]++)));
  }

  void add_area_emitter(std::size_t i) {
    const sd::ShapeDesc& shape = *geometry_.placed[i].shape;
    auto& placement = geometry_.placements[i];
    if (const int texture = radiance_of_[i].texture; texture >= 0) {
      geometry::TriangleMesh& mesh = geometry_.meshes[placement.mesh];
      mesh = divided_by_texture(std::move(mesh), texture, w_.materials.textures,
                                kTrianglesOfPictures / shining_pictures_);
    }
    emitters::AreaEmitter area =
        make_area_emitter(geometry_.meshes[placement.mesh], static_cast<std::uint32_t>(i), radiance_of_[i],
                          w_.materials.textures);
    for (const auto& t : area.triangles) {
      if (!is_finite(t.mean_radiance))
        throw InputError(shape.emitter->where, "the radiance is not finite", "give finite numbers");
      check_light(max_component(t.mean_radiance), "the radiance", shape.emitter->where);
    }
    if (!(area.by_power.total() > 0)) return;  // black
    area.seen = shape.emitter->seen;
    // Rays pass through what cannot be seen, and find no emitter there.
    if (area.seen) placement.emitter = static_cast<std::uint32_t>(w_.emitters.size());
    emitters::Emitter emitter;
    emitter.kind = std::move(area);
    names_.name(emitter, shape.emitter->id.empty() ? shape.id : shape.emitter->id, shape.emitter->where);
    w_.emitters.push_back(std::move(emitter));
    w_.radiance.push_back(radiance_of_[i]);
  }

  void add_other_lights() {
    w_.environment =
        add_lights(desc_, pictures_, w_.materials.textures, names_, w_.units, notes_, w_.emitters);
    w_.radiance.resize(w_.emitters.size());
    for (std::size_t k = 0; k < w_.emitters.size(); ++k) {
      const auto* sun = std::get_if<emitters::DirectionalEmitter>(&w_.emitters[k].kind);
      if (sun && sun->cos_half_angle < 1) w_.suns.push_back(k);
    }
    if (w_.emitters.empty()) notes_.warn(whole_scene(), "the scene has no light", "a black picture");
  }

  // Meshes that are as they were before are the same objects.
  void share_meshes() {
    std::vector<geometry::SharedMesh> were(geometry_.meshes.size());
    if (before_ && before_->placement_ids() == w_.placement_ids)
      for (std::size_t i = 0; i < geometry_.placements.size(); ++i)
        were[geometry_.placements[i].mesh] = before_->rays().meshes()[before_->rays().placements()[i].mesh];
    meshes_.resize(were.size());
    parallel_for(were.size(), 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t m = begin; m < end; ++m)
        meshes_[m] = were[m] && geometry::same_mesh(*were[m], geometry_.meshes[m])
                         ? were[m]
                         : geometry::share_mesh(std::move(geometry_.meshes[m]));
    });
    for (std::size_t m = 0; m < were.size(); ++m)
      if (meshes_[m] != were[m]) w_.info.memory_bytes += bytes_of(*meshes_[m]);
    geometry_.meshes.clear();
  }

  void count() {
    w_.hides_emitters = desc_.hide_emitters;
    w_.info.instances = geometry_.placements.size();
    w_.info.triangles = geometry_.triangles;
    w_.info.segments = geometry_.segments;
    w_.info.unique_triangles = geometry_.unique_triangles;
    w_.info.textures = w_.materials.textures.textures.size();
    w_.info.materials = w_.materials.materials.size();
    w_.info.emitters = w_.emitters.size();
    w_.info.memory_bytes += textures_.memory_bytes();
    for (const auto& emitter : w_.emitters) w_.info.memory_bytes += bytes_of(emitter);
  }

  void make_rays() {
    Impl& w = w_;
    geometry::RayScene::PassageCallbacks callbacks;
    callbacks.opacity = [&w](const geometry::Hit& hit) {
      return w.materials.opacity(static_cast<int>(w.rays->placements()[hit.instance].material), w.uv(hit));
    };
    callbacks.transmittance = [&w](const geometry::Hit& hit, Vec3f direction) {
      const SurfaceHit at = w.surface(hit, direction);
      return w.materials.transmittance(at.material, at.point, normalize(direction));
    };
    geometry::RayScene::Sharing sharing{before_ ? &before_->rays() : nullptr};
    if (refit_) sharing.refit = true, sharing.least = kRefitLimit;
    w.rays.emplace(std::move(meshes_), std::move(geometry_.placements), std::move(callbacks), sharing);
    w.bounds = w.rays->bounds();
    w.info.memory_bytes += w.rays->memory_bytes();
  }

  const sd::SceneDesc& desc_;
  std::optional<Units> given_units_;
  const World* before_;
  bool refit_, with_media_, straight_panes_;
  const Sinks& sinks_;
  Notes notes_;
  MeshStore store_;
  TextureBuilder textures_;
  std::vector<scatter::ColorInput> pictures_;  // that emitters throw
  MaterialBuilder materials_;
  EmitterNames names_;
  std::map<int, int> face_of_pane_;      // materials of panes: what stands for them
  std::map<std::uint32_t, bool> panes_;  // by meshes
  std::map<std::string, int> named_;     // placements by the ids of their shapes
  std::vector<Placed> placed_;
  Geometry geometry_;
  std::vector<geometry::SharedMesh> meshes_;
  std::vector<int> material_of_;                  // of each of geometry_.placed
  std::vector<scatter::ColorInput> radiance_of_;  // where it shines
  std::size_t shining_pictures_ = 0;              // of these, by a texture
  std::unique_ptr<Impl> impl_ = std::make_unique<Impl>();
  Impl& w_ = *impl_;
};

World World::build(const sd::SceneDesc& desc, const BuildOptions& options, std::vector<sd::Warning>& warnings,
                   const Sinks& sinks) {
  return World(Builder(desc, options, warnings, sinks).build());
}

}  // namespace lumirank::world
