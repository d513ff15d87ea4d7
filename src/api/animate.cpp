#include "lumirank/animate.h"

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

#include "api/render_tensor.h"
#include "api/scene.h"
#include "base/error.h"
#include "base/hash_text.h"
#include "image/atomic_file.h"

namespace lumirank {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

std::string stem_of(int frame) {
  char text[32];
  std::snprintf(text, sizeof text, "frame_%04d", frame);
  return text;
}

// Rounding of frame numbers and key times: a millionth of a frame counts for nothing.
constexpr double kSlack = 1e-6;

struct Range {
  int first, last;
  int first_key, last_key;  // of the motion
};

Range frames_of(const scenedesc::Motion& motion, const AnimateSettings& settings) {
  const double fps = settings.frames_per_second;
  if (!(fps > 0) || !std::isfinite(fps))
    throw InputError("the number of frames per second is not positive", "give --fps 24, say");
  const auto first_key = static_cast<int>(std::ceil(motion.begin * fps - kSlack)),
             last_key = static_cast<int>(std::floor(motion.end * fps + kSlack));
  const Range range{settings.first, settings.last < 0 ? last_key : settings.last, first_key, last_key};
  if (range.first < 0 || range.last < range.first)
    throw InputError(
        "there are no frames from " + std::to_string(range.first) + " to " + std::to_string(range.last),
        "give --frames FIRST:LAST, both counted from 0");
  const bool moves = motion.end > motion.begin;
  if (moves && (range.first < first_key || range.last > last_key))
    throw InputError("frames " + std::to_string(range.first) + " to " + std::to_string(range.last) +
                         " are not all within the motion, which has frames " + std::to_string(first_key) +
                         " to " + std::to_string(last_key) + " at " + Json(fps).dump() + " per second",
                     "give others with --frames, or another --clip");
  return range;
}

// Of the scene file's bytes, so that a scene that was changed is another one.
std::string fingerprint(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  const std::string bytes(std::istreambuf_iterator<char>(in), {});
  const std::uint64_t hash = hash_text(bytes);
  char text[24];
  std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(hash));
  return text;
}

class Shot {
 public:
  Shot(const Scene& scene, const AnimateSettings& settings, std::string folder)
      : scene_(scene), settings_(settings), folder_(std::move(folder)) {}

  // Before anything is written: the folder is new, or holds this shot.
  void open() {
    const LoadOptions& load = scene_.impl().options;
    manifest_ = {{"scene", fs::path(scene_.impl().desc.source_file).filename().string()},
                 {"scene_fingerprint", fingerprint(scene_.impl().desc.source_file)},
                 {"clip", load.clip},
                 {"frames_per_second", settings_.frames_per_second},
                 {"environment", load.environment},
                 {"defines", load.defines},
                 {"settings", Json::parse(to_json(settings_.render))},
                 {"tensor", tensor_json()}};
    const std::string name = path("shot.json");
    std::error_code error;
    if (fs::exists(name, error)) {
      std::ifstream in(name, std::ios::binary);
      const Json found = Json::parse(in, nullptr, false);
      for (const auto& [key, value] : manifest_.items())
        if (!found.is_object() || !found.contains(key) || found[key] != value)
          throw InputError({name, 0},
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
    image::write_whole_file(name, manifest_.dump(1) + "\n");
  }

  bool is_finished(int frame) const {
    std::error_code error;
    if (!fs::exists(path(stem_of(frame) + ".json"), error)) return false;
    for (const std::string& ending : settings_.endings)
      if (!fs::exists(path(stem_of(frame) + ending), error)) return false;
    return true;
  }

  // False if it was interrupted.
  bool render_frame(int frame, const Sinks& sinks) const {
    const Scene now = scene_.at(frame / settings_.frames_per_second, sinks);
    const RenderResult result = render(now, settings_.render, sinks);
    if (result.interrupted) return false;
    write(frame, result.picture, result.report);
    return true;
  }

  // All frames from `first` to `last` by one clustering; writes those that are missing.
  bool render_chunk(int first, int last, const std::vector<int>& missing, const Sinks& sinks) const {
    std::vector<Scene> scenes;
    for (int frame = first; frame <= last; ++frame)
      scenes.push_back(scene_.at(frame / settings_.frames_per_second, frame == first ? sinks : Sinks{}));
    const auto pictures = api::render_tensor(scenes, settings_.render, *settings_.tensor, sinks);
    if (pictures.empty()) return false;
    for (const int frame : missing) {
      const RenderResult& result = pictures[static_cast<std::size_t>(frame - first)];
      write(frame, result.picture, result.report);
    }
    return true;
  }

 private:
  Json tensor_json() const {
    if (!settings_.tensor) return nullptr;
    const TensorSettings& t = *settings_.tensor;
    return {{"chunk", t.chunk},
            {"rows", t.rows},
            {"columns", t.columns},
            {"initial_clusters", t.initial_clusters},
            {"time_weight", t.time_weight},
            {"max_distance", t.max_distance},
            {"max_change", t.max_change},
            {"bits", t.bits}};
  }
  void write(int frame, const Picture& picture, const Report& report) const {
    image::FilesTogether together;
    for (const std::string& ending : settings_.endings)
      write_picture(path(stem_of(frame) + ending), picture, settings_.display);
    write_text(path(stem_of(frame) + ".json"), report.json());  // last: with it the frame is finished
    together.commit();
  }
  std::string path(const std::string& name) const { return (fs::path(folder_) / name).string(); }

  const Scene& scene_;
  const AnimateSettings& settings_;
  std::string folder_;
  Json manifest_;
};

}  // namespace

AnimationResult animate(const Scene& scene, const AnimateSettings& settings, const std::string& folder,
                        const Sinks& sinks) {
  validate(settings.render);
  if (settings.tensor) {
    api::check(*settings.tensor, settings.render);
    if (settings.render.traced.rest != RestOfPaths::skip)
      sinks.warn(
          "tensor clustering leaves out light that columns cannot carry (caustics, light through glass); "
          "--rest skip says so");
  }
  if (settings.render.view.is_open() && scene.impl().options.frames_per_second != settings.frames_per_second)
    throw InputError("the shutter counts in other frames than the shot: the scene was read at " +
                         Json(scene.impl().options.frames_per_second).dump() + " per second",
                     "read it with the same LoadOptions::frames_per_second");
  if (settings.endings.empty()) throw InputError("the frames have no format", "give --format exr,png");
  const Range frames = frames_of(scene.impl().desc.motion, settings);
  Shot shot(scene, settings, folder);
  shot.open();
  AnimationResult result;
  std::vector<int> missing;
  for (int frame = frames.first; frame <= frames.last; ++frame)
    if (shot.is_finished(frame))
      ++result.kept;
    else
      missing.push_back(frame);
  Sinks own = sinks;
  own.progress = [](const char*, double) {};
  // Frame by frame, or chunks that begin at the same frames whatever part of the shot is asked for.
  const int chunk = settings.tensor ? settings.tensor->chunk : 1;
  for (std::size_t k = 0; k < missing.size();) {
    sinks.report("frames", static_cast<double>(k) / static_cast<double>(missing.size()));
    const int first = frames.first_key + (missing[k] - frames.first_key) / chunk * chunk,
              last = std::min(first + chunk - 1, std::max(frames.last_key, frames.last));
    std::vector<int> together;
    while (k < missing.size() && missing[k] <= last) together.push_back(missing[k++]);
    const bool whole = !sinks.cancelled() && (settings.tensor ? shot.render_chunk(first, last, together, own)
                                                              : shot.render_frame(together[0], own));
    if (!whole) {
      result.interrupted = true;
      break;
    }
    result.rendered += static_cast<int>(together.size());
  }
  return result;
}

}  // namespace lumirank
