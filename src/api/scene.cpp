// Loading scenes, and what `lumirank info` says of them.
#include "api/scene.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "api/build_world.h"
#include "pipeline/memory.h"
#include "scenedesc/readers.h"
#include "scenedesc/schema/files.h"
#include "scenedesc/writer/mitsuba_writer.h"

namespace lumirank {
namespace {

nlohmann::ordered_json info_object(const Scene& scene, const Sinks& sinks) {
  const auto& desc = scene.impl().desc;
  std::vector<scenedesc::Warning> warnings;
  const std::shared_ptr<const world::World> built = api::build_world(scene, sinks, &warnings);
  const world::World& world = *built;
  nlohmann::ordered_json json;
  json["file"] = desc.source_file;
  json["format"] = desc.format;
  const auto& info = world.info();
  json["triangles"] = info.triangles;
  json["triangles.unique"] = info.unique_triangles;
  json["fiber_segments"] = info.segments;
  json["meshes"] = info.meshes;
  json["meshes.left_out"] = info.meshes_left_out;
  json["instances"] = info.instances;
  json["textures"] = info.textures;
  json["materials"] = info.materials;
  json["emitters"] = nlohmann::json::array();
  for (const auto& e : world.emitters()) {
    const Rgb p = world.units().power_in_file(emitters::power(e, world.bounds().radius()));
    json["emitters"].push_back({{"name", e.name}, {"group", e.group}, {"power", {p.r, p.g, p.b}}});
  }
  const auto corner = [&](Vec3f own) -> nlohmann::ordered_json {
    if (world.units().are_the_files()) return {own.x, own.y, own.z};
    const Vec3d p = world.units().place_in_file(own);
    return {p.x, p.y, p.z};
  };
  json["bounds"] = {corner(world.bounds().lo), corner(world.bounds().hi)};
  json["cameras"] = nlohmann::json::array();
  for (const auto& s : desc.sensors)
    json["cameras"].push_back(
        {{"id", s.id}, {"width", s.film.width}, {"height", s.film.height}, {"fov_x", s.fov_x}});
  json["max_depth"] = desc.max_depth;
  json["memory.scene_bytes"] = info.memory_bytes;
  json["warnings"] = nlohmann::json::array();
  json["notes"] = nlohmann::json::array();
  for (const auto& w : desc.warnings) json[w.harmless ? "notes" : "warnings"].push_back(api::warning_text(w));
  for (const auto& w : warnings) json[w.harmless ? "notes" : "warnings"].push_back(api::warning_text(w));
  return json;
}

}  // namespace

Scene Scene::load(const std::string& filename, const LoadOptions& options, const Sinks& sinks) {
  auto impl = std::make_shared<Impl>();
  impl->options = options;
  scenedesc::ReadOptions read;
  read.defines = options.defines;
  read.strict = options.strict;
  read.environment = options.environment;
  read.allow_missing = options.allow_missing;
  const scenedesc::FilesRead files;
  pipeline::within_memory("the scene is too large for this machine",
                          [&] { impl->desc = scenedesc::read_scene(filename, read); });
  impl->files_read = files.names();
  api::report_warnings(sinks, impl->desc.warnings);
  return Scene(std::move(impl));
}

std::vector<std::string> Scene::files() const {
  std::vector<std::string> files = impl_->files_read;
  const auto later = scenedesc::files_of(impl_->desc);
  files.insert(files.end(), later.begin(), later.end());
  return files;
}

std::string Scene::info_json(const Sinks& sinks) const { return info_object(*this, sinks).dump(1) + "\n"; }

std::string Scene::info_text(const Sinks& sinks) const {
  const auto json = info_object(*this, sinks);
  std::string text = scenedesc::describe(impl_->desc);
  text += "\nbuilt: " + json["triangles"].dump() + " triangles (" + json["triangles.unique"].dump() +
          " unique) in " + json["meshes"].dump() + " meshes and " + json["instances"].dump() +
          " instances, " + json["textures"].dump() + " textures, " + json["materials"].dump() +
          " materials\n";
  if (json["meshes.left_out"] > 0)
    text += "left out: " + json["meshes.left_out"].dump() + " meshes without a triangle, or without a file\n";
  text +=
      "bounds: " + json["bounds"].dump() + "\nemitters: " + std::to_string(json["emitters"].size()) + "\n";
  std::size_t shown = 0;
  for (const auto& e : json["emitters"]) {
    if (++shown > 32) {
      text += "  … and " + std::to_string(json["emitters"].size() - 32) + " more (see --json)\n";
      break;
    }
    text += "  " + e["name"].get<std::string>() + "  " + e["power"].dump() + " W\n";
  }
  // The description above has listed the reader's own.
  const auto& reader_warnings = impl_->desc.warnings;
  const auto read =
      static_cast<std::size_t>(std::count_if(reader_warnings.begin(), reader_warnings.end(),
                                             [](const scenedesc::Warning& w) { return !w.harmless; }));
  const std::size_t all = json["warnings"].size();
  text += "warnings while building: " + std::to_string(all - read) + "\n";
  for (std::size_t w = read; w < all; ++w) text += "  " + json["warnings"][w].get<std::string>() + "\n";
  if (!json["notes"].empty()) text += "notes (nothing that a picture shows):\n";
  for (const auto& note : json["notes"]) text += "  " + note.get<std::string>() + "\n";
  return text;
}

}  // namespace lumirank
