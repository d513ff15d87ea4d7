#include "scenedesc/schema/scene_reader.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "scenedesc/schema/frame_files.h"

namespace lumirank::scenedesc {

SceneReader::SceneReader(const std::string& filename, const std::string& format, const ReadOptions& options)
    : options_(options) {
  scene_.source_file = filename;
  scene_.format = format;
}

void SceneReader::warn(const SourceLocation& where, const std::string& what,
                       const std::string& used_instead) {
  if (options_.strict)
    throw InputError(where, "Lumirank does not have " + what,
                     used_instead.empty() ? "without --strict it is left out"
                                          : "without --strict this is used: " + used_instead);
  scene_.warnings.push_back({where, what, used_instead});
}

void SceneReader::warn_once(const SourceLocation& where, const std::string& what,
                            const std::string& used_instead) {
  if (is_new(what)) warn(where, what, used_instead);
}

int SceneReader::add_bsdf(const std::string& id, const SourceLocation& where, decltype(BsdfDesc::kind) kind) {
  scene_.bsdfs.push_back({id, where, std::move(kind)});
  return static_cast<int>(scene_.bsdfs.size()) - 1;
}

int SceneReader::add_texture(const std::string& id, const SourceLocation& where,
                             decltype(TextureDesc::kind) kind) {
  scene_.textures.push_back({id, where, std::move(kind)});
  return static_cast<int>(scene_.textures.size()) - 1;
}

std::string SceneReader::path_at_time(const std::string& path) {
  std::optional<int> frame;
  if (options_.time) frame = static_cast<int>(std::lround(*options_.time * options_.frames_per_second));
  const auto found = file_of_frame(path, frame);
  if (!found) return path;
  add_motion(std::filesystem::path(path).filename().string(), found->first / options_.frames_per_second,
             found->last / options_.frames_per_second);
  return found->path;
}

std::vector<std::string> SceneReader::sequence(const std::string& path) {
  std::vector<std::string> files;
  for (auto& [number, name] : files_of_frames(path)) files.push_back(std::move(name));
  return files;
}

void SceneReader::add_motion(const std::string& what, double begin, double end) {
  Motion& motion = scene_.motion;
  const bool first = motion.moving.empty();
  motion.begin = first ? begin : std::min(motion.begin, begin);
  motion.end = first ? end : std::max(motion.end, end);
  motion.moving.push_back(what);
}

SceneReader::NamedFile SceneReader::named_file(const std::string& path, const SourceLocation& where,
                                               const std::string& kind, const std::string& stand_in) {
  if (found_files_.count(path)) return {path, false};
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (!std::filesystem::exists(status)) {
    missing_file(where, kind + " not found: " + path, stand_in);
    return {path, true};
  }
  if (std::filesystem::is_directory(status))
    throw InputError(where, kind + " " + path + " is a folder", "name a file in it");
  found_files_.insert(path);
  return {path, false};
}

void SceneReader::missing_file(const SourceLocation& where, const std::string& what,
                               const std::string& stand_in) {
  if (!options_.allow_missing || options_.strict)
    throw InputError(where, what,
                     options_.allow_missing ? "--strict is given: check the name"
                                            : "check the name, or let a stand-in be shown (--allow-missing)");
  scene_.warnings.push_back({where, what, stand_in});
}

}  // namespace lumirank::scenedesc
