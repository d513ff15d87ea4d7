// What a scene consists of: typed, as text and as JSON.
#include <algorithm>
#include <nlohmann/json.hpp>

#include "api/build_world.h"
#include "api/scene.h"
#include "lumirank/info.h"
#include "scenedesc/schema/describe.h"

namespace lumirank {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kEmittersShown = 32, kMovingShown = 32;

Json bounds_json(const SceneInfo& info) { return {info.bounds[0], info.bounds[1]}; }

std::array<double, 3> corner(const world::World& world, Vec3f own) {
  if (world.units().are_the_files())
    return {static_cast<double>(own.x), static_cast<double>(own.y), static_cast<double>(own.z)};
  const Vec3d p = world.units().place_in_file(own);
  return {p.x, p.y, p.z};
}

}  // namespace

SceneInfo Scene::info(const Sinks& sinks) const {
  const scenedesc::SceneDesc& desc = impl_->desc;
  std::vector<scenedesc::Warning> warnings;
  const std::shared_ptr<const world::World> world =
      api::build_world(*this, sinks, {.warnings = &warnings, .media = true});
  const auto& built = world->info();
  SceneInfo info;
  info.file = desc.source_file, info.format = desc.format;
  info.triangles = built.triangles, info.unique_triangles = built.unique_triangles;
  info.fiber_segments = built.segments;
  info.meshes = built.meshes, info.meshes_left_out = built.meshes_left_out;
  info.instances = built.instances, info.textures = built.textures, info.materials = built.materials;
  info.media = built.media;
  for (const auto& e : world->emitters()) {
    const Rgb p = world->units().power_in_file(emitters::power(e, world->bounds().radius()));
    info.emitters.push_back({e.name,
                             static_cast<int>(e.group),
                             {static_cast<double>(p.r), static_cast<double>(p.g), static_cast<double>(p.b)}});
  }
  info.bounds = {corner(*world, world->bounds().lo), corner(*world, world->bounds().hi)};
  for (const auto& s : desc.sensors)
    info.cameras.push_back({s.id, s.film.width, s.film.height, static_cast<double>(s.fov_x)});
  info.max_depth = desc.max_depth;
  info.scene_bytes = built.memory_bytes;
  info.motion_begin = desc.motion.begin, info.motion_end = desc.motion.end;
  info.moving = desc.motion.moving, info.clips = desc.motion.clips;
  const auto add = [&](const scenedesc::Warning& w) {
    (w.harmless ? info.notes : info.warnings).push_back(api::warning_text(w));
  };
  std::ranges::for_each(desc.warnings, add);
  std::ranges::for_each(warnings, add);
  info.listing = scenedesc::describe(desc);
  return info;
}

std::string SceneInfo::json() const {
  Json json;
  json["file"] = file;
  json["format"] = format;
  json["triangles"] = triangles;
  json["triangles.unique"] = unique_triangles;
  json["fiber_segments"] = fiber_segments;
  json["meshes"] = meshes;
  json["meshes.left_out"] = meshes_left_out;
  json["instances"] = instances;
  json["textures"] = textures;
  json["materials"] = materials;
  json["media"] = media;
  json["emitters"] = Json::array();
  for (const Emitter& e : emitters)
    json["emitters"].push_back({{"name", e.name}, {"group", e.group}, {"power", e.power}});
  json["bounds"] = bounds_json(*this);
  json["cameras"] = Json::array();
  for (const Camera& c : cameras)
    json["cameras"].push_back({{"id", c.id}, {"width", c.width}, {"height", c.height}, {"fov_x", c.fov_x}});
  json["max_depth"] = max_depth;
  json["memory.scene_bytes"] = scene_bytes;
  json["motion"] = {{"begin", motion_begin}, {"end", motion_end}, {"moving", moving}, {"clips", clips}};
  json["warnings"] = warnings;
  json["notes"] = notes;
  return json.dump(1) + "\n";
}

std::string SceneInfo::text() const {
  const auto count = [](std::uint64_t n, const char* what) { return std::to_string(n) + what; };
  std::string text = listing + "\nbuilt: " + count(triangles, " triangles (") +
                     count(unique_triangles, " unique) in ") + count(meshes, " meshes and ") +
                     count(instances, " instances, ") + count(textures, " textures, ") +
                     count(materials, " materials") + (media > 0 ? ", " + count(media, " media\n") : "\n");
  if (meshes_left_out > 0)
    text += "left out: " + count(meshes_left_out, " meshes without a triangle, or without a file\n");
  text += "bounds: " + bounds_json(*this).dump() + "\nemitters: " + std::to_string(emitters.size()) + "\n";
  for (std::size_t k = 0; k < std::min(emitters.size(), kEmittersShown); ++k)
    text += "  " + emitters[k].name + "  " + Json(emitters[k].power).dump() + " W\n";
  if (emitters.size() > kEmittersShown)
    text += "  … and " + std::to_string(emitters.size() - kEmittersShown) + " more (see --json)\n";
  if (motion_end > motion_begin || !moving.empty()) {
    text += "moves from " + Json(motion_begin).dump() + " to " + Json(motion_end).dump() + " s";
    for (std::size_t k = 0; k < clips.size(); ++k) text += (k == 0 ? "; clips: " : ", ") + clips[k];
    text += "\n";
    for (std::size_t k = 0; k < std::min(moving.size(), kMovingShown); ++k) text += "  " + moving[k] + "\n";
    if (moving.size() > kMovingShown)
      text += "  … and " + std::to_string(moving.size() - kMovingShown) + " more (see --json)\n";
  }
  text += "warnings: " + std::to_string(warnings.size()) + "\n";
  for (const std::string& warning : warnings) text += "  " + warning + "\n";
  if (!notes.empty()) text += "notes (nothing that a picture shows):\n";
  for (const std::string& note : notes) text += "  " + note + "\n";
  return text;
}

}  // namespace lumirank
