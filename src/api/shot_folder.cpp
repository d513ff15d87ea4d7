#include "api/shot_folder.h"

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <utility>

#include "api/scene.h"
#include "base/error.h"
#include "base/hash_text.h"
#include "image/atomic_file.h"

namespace lumirank::api {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

// Of the bytes of all files that the scene consists of, so that a scene that was changed is another one.
std::string fingerprint(const Scene& scene) {
  std::uint64_t hash = kHashOfNothing;
  std::set<std::string> seen;
  for (const std::string& name : scene.files()) {
    if (!seen.insert(name).second) continue;
    std::ifstream in(name, std::ios::binary);  // one that is missing has a stand-in
    hash = hash_text(std::string(std::istreambuf_iterator<char>(in), {}), hash);
  }
  char text[24];
  std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(hash));
  return text;
}

// Nothing but what decides about pixels.
Json tensor_json(const AnimateSettings& settings) {
  if (!settings.tensor) return nullptr;
  std::map<std::string, std::string> parameters = parameters_of(*settings.tensor);
  parameters.erase("clusters");
  return parameters;
}

Json manifest_of(const Scene& scene, const AnimateSettings& settings) {
  const LoadOptions& load = scene.impl().options;
  return {{"scene", fs::path(scene.impl().desc.source_file).filename().string()},
          {"scene_fingerprint", fingerprint(scene)},
          {"clip", load.clip},
          {"frames_per_second", settings.frames_per_second},
          {"environment", load.environment},
          {"defines", load.defines},
          {"settings", Json::parse(to_json(settings.render))},
          {"tensor", tensor_json(settings)},
          {"temporal_filter", settings.temporal_filter.value_or(0)},
          {"refit", settings.refit}};
}

}  // namespace

ShotFolder::ShotFolder(const AnimateSettings& settings, std::string folder)
    : settings_(settings), folder_(std::move(folder)) {}

void ShotFolder::open(const Scene& scene) const {
  const Json manifest = manifest_of(scene, settings_);
  const std::string file = (fs::path(folder_) / "shot.json").string();
  std::error_code error;
  if (fs::exists(file, error)) {
    std::ifstream in(file, std::ios::binary);
    const Json found = Json::parse(in, nullptr, false);
    for (const auto& [key, value] : manifest.items())
      if (!found.is_object() || !found.contains(key) || found[key] != value)
        throw InputError({file, 0},
                         "the folder holds frames of another shot: its \"" + key + "\" is different",
                         "choose another folder");
    return;
  }
  if (fs::is_directory(folder_, error))
    for (const auto& entry : fs::directory_iterator(folder_, error))
      if (entry.path().filename().string().starts_with("frame_"))
        throw InputError({entry.path().string(), 0},
                         "the folder holds frames that are not of this shot: it has no shot.json",
                         "choose another folder");
  fs::create_directories(folder_, error);
  if (error)
    throw InputError({folder_, 0}, "the folder cannot be made: " + error.message(), "choose another place");
  image::write_whole_file(file, manifest.dump(1) + "\n");
}

bool ShotFolder::is_finished(int frame) const {
  std::error_code error;
  if (!fs::exists(report_file(frame), error)) return false;
  for (const std::string& ending : settings_.endings)
    if (!fs::exists(frame_file(frame, ending), error)) return false;
  return true;
}

void ShotFolder::write(int frame, const Picture& picture, const Report& report) const {
  image::FilesTogether together;
  // One exposure for all frames, which are not known beforehand.
  DisplaySettings display = settings_.display;
  display.exposure = display.exposure.value_or(0);
  for (const std::string& ending : settings_.endings)
    write_picture(frame_file(frame, ending), picture, display);
  write_text(report_file(frame), report.json());  // last: with it the frame is finished
  together.commit();
}

std::string ShotFolder::numbered_file(const char* kind, int frame, const std::string& ending) const {
  char number[16];
  std::snprintf(number, sizeof number, "_%04d", frame);
  return (fs::path(folder_) / (kind + (number + ending))).string();
}

}  // namespace lumirank::api
