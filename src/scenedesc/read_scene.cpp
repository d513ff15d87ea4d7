// Which reader a file gets, and what is done to a scene whatever its format.
#include <algorithm>
#include <cctype>
#include <filesystem>

#include "scenedesc/readers.h"
#include "scenedesc/schema/warnings.h"

namespace lumirank::scenedesc {
namespace {

bool is_environment(const EmitterDesc& emitter) {
  return std::holds_alternative<ConstantEnvironmentDesc>(emitter.kind) ||
         std::holds_alternative<EnvironmentMapDesc>(emitter.kind) ||
         std::holds_alternative<SunSkyDesc>(emitter.kind);
}

}  // namespace

void replace_environment(SceneDesc& scene, const std::string& filename) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(filename, error))
    throw InputError("the environment map " + filename + " does not exist", "check --environment");
  const std::size_t removed = std::erase_if(scene.emitters, is_environment);
  EnvironmentMapDesc map;
  map.filename = std::filesystem::absolute(filename).lexically_normal().string();
  const SourceLocation where{scene.source_file, 0};
  if (removed > 0) add_note(scene, where, "the scene's own environment gives way to --environment");
  scene.emitters.push_back({"environment", where, map});
}

void light_if_dark(SceneDesc& scene, const ReadOptions& options) {
  if (!scene.emitters.empty()) return;
  for (const ShapeDesc& shape : scene.shapes)
    if (shape.emitter) return;
  const SourceLocation where{scene.source_file, 0};
  if (options.strict)
    throw InputError(where, "the scene has no light",
                     "give --environment; without --strict it gets a white environment");
  scene.emitters.push_back({"environment", where, ConstantEnvironmentDesc{Rgb(1)}});
  scene.warnings.push_back({where, "the scene has no light", "a white environment; see --environment"});
}

SceneDesc read_scene(const std::string& filename, const ReadOptions& options) {
  const std::string plain = filename.ends_with(".gz") ? filename.substr(0, filename.size() - 3) : filename;
  std::string extension = std::filesystem::path(plain).extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  const bool gltf = extension == ".gltf" || extension == ".glb";
  const bool pbrt = extension == ".pbrt";
  if (extension != ".xml" && !gltf && !pbrt) {
    if (std::error_code error; !std::filesystem::exists(filename, error))
      throw InputError("file not found: " + filename, "check the name");
    throw InputError(SourceLocation{filename, 0}, "no reader for files that end in \"" + extension + "\"",
                     "Mitsuba (.xml), pbrt (.pbrt) and glTF (.gltf, .glb) scenes can be read");
  }
  if (!gltf && !options.clip.empty())
    throw InputError(SourceLocation{filename, 0},
                     "the file has no clip '" + options.clip + "': only glTF has clips", "leave out --clip");
  SceneDesc scene = gltf   ? read_gltf(filename, options)
                    : pbrt ? read_pbrt(filename, options)
                           : read_mitsuba(filename, options);
  if (!options.environment.empty()) replace_environment(scene, options.environment);
  // glTF files hardly ever bring lights along, and are shown by whatever the viewer has; in the other formats
  // a scene without any is meant to be dark, or a mistake that should show.
  if (gltf) light_if_dark(scene, options);
  return scene;
}

}  // namespace lumirank::scenedesc
