#include "lumirank/animate.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <set>
#include <string_view>
#include <utility>

#include "api/render_in_shot.h"
#include "api/render_tensor.h"
#include "api/scene.h"
#include "api/shot_chunks.h"
#include "base/error.h"
#include "base/hash_text.h"
#include "base/timer.h"
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

Range frames_of(const scenedesc::SceneDesc& scene, const AnimateSettings& settings) {
  const scenedesc::Motion& motion = scene.motion;
  const double fps = settings.frames_per_second;
  if (!(fps > 0) || !std::isfinite(fps))
    throw InputError("the number of frames per second is not positive", "give --fps 24, say");
  const auto first_key = static_cast<int>(std::ceil(motion.begin * fps - kSlack)),
             last_key = static_cast<int>(std::floor(motion.end * fps + kSlack));
  const Range range{settings.first < 0 ? first_key : settings.first,
                    settings.last < 0 ? last_key : settings.last, first_key, last_key};
  if (range.last < range.first)
    throw InputError(
        "there are no frames from " + std::to_string(range.first) + " to " + std::to_string(range.last),
        "give --frames FIRST:LAST, both counted from 0");
  if (motion.end > motion.begin && (range.first < first_key || range.last > last_key))
    throw InputError({scene.source_file, 0},
                     "frames " + std::to_string(range.first) + " to " + std::to_string(range.last) +
                         " are not all within the motion, which has frames " + std::to_string(first_key) +
                         " to " + std::to_string(last_key) + " at " + Json(fps).dump() + " per second",
                     "give others with --frames, or another --clip");
  return range;
}

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

class Shot {
 public:
  Shot(const Scene& scene, const AnimateSettings& settings, std::string folder)
      : scene_(scene), settings_(settings), folder_(std::move(folder)) {}

  // Before anything is written: the folder is new, or holds this shot.
  void open() {
    const LoadOptions& load = scene_.impl().options;
    manifest_ = {{"scene", fs::path(scene_.impl().desc.source_file).filename().string()},
                 {"scene_fingerprint", fingerprint(scene_)},
                 {"clip", load.clip},
                 {"frames_per_second", settings_.frames_per_second},
                 {"environment", load.environment},
                 {"defines", load.defines},
                 {"settings", Json::parse(to_json(settings_.render))},
                 {"tensor", tensor_json()},
                 {"refit", settings_.refit}};
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
  bool render_frame(int frame, const api::InShot& shot, const Sinks& sinks) const {
    const Scene now = scene_.at(frame / settings_.frames_per_second, sinks);
    const RenderResult result = api::render_in_shot(now, settings_.render, shot, sinks);
    if (result.interrupted) return false;
    write(frame, result.picture, result.report);
    return true;
  }

  // What its frames share if they are rendered one by one.
  std::shared_ptr<const pipeline::ShotLights> plan_lights(const Sinks& sinks) const {
    return api::plan_lights_of_motion(scene_, settings_.render, sinks);
  }

  // A chunk and its tail by one clustering; writes those of its own frames that are wanted. The tail of the
  // one before it is there.
  bool render_chunk(const api::ShotChunks& chunks, const api::Chunk& chunk, const std::vector<int>& wanted,
                    const Sinks& sinks) const {
    const Timer timer;
    std::vector<Scene> scenes;
    for (int frame = chunk.first; frame <= chunk.tail_last; ++frame)
      scenes.push_back(
          scene_.at(frame / settings_.frames_per_second, frame == chunk.first ? sinks : Sinks{}));
    const double read_seconds = timer.seconds() / chunk.size();
    api::TensorFrames made = api::render_tensor(scenes, settings_.render, *settings_.tensor, sinks);
    std::vector<RenderResult>& results = made.frames;
    if (results.empty()) return false;
    if (settings_.tensor->write_clusters) write_clusters(chunk, made);
    for (int frame = chunk.last + 1; frame <= chunk.tail_last; ++frame)
      if (!is_finished(frame))
        api::TailPicture(folder_, frame)
            .write(results[static_cast<std::size_t>(frame - chunk.first)].picture);
    for (const int frame : wanted) {
      RenderResult& result = results[static_cast<std::size_t>(frame - chunk.first)];
      const double part = chunks.part(frame);
      const api::TailPicture tail(folder_, frame);
      if (part < 1) tail.blend_into(result.picture, part);
      result.report.numbers["chunk.part"] = part;
      result.report.seconds["read"] = read_seconds;
      write(frame, result.picture, result.report);
      tail.remove();
    }
    return true;
  }

  // Frames of a chunk: as many as are asked for, and fit into the memory that is given.
  int frames_at_once(int first_key, int last_key) const {
    std::vector<Scene> first;
    for (int frame = first_key; frame <= std::min(last_key, first_key + 2); ++frame)
      first.push_back(scene_.at(frame / settings_.frames_per_second));
    return api::frames_within_memory(first, settings_.render, *settings_.tensor);
  }

  // All tails that `wanted` frames of a chunk need are there.
  bool has_tails(const api::ShotChunks& chunks, const std::vector<int>& wanted) const {
    return std::all_of(wanted.begin(), wanted.end(), [&](int frame) {
      return chunks.part(frame) == 1 || api::TailPicture(folder_, frame).exists();
    });
  }

 private:
  // Nothing but what decides about pixels.
  Json tensor_json() const {
    if (!settings_.tensor) return nullptr;
    std::map<std::string, std::string> parameters = parameters_of(*settings_.tensor);
    parameters.erase("clusters");
    return parameters;
  }
  void write_clusters(const api::Chunk& chunk, const api::TensorFrames& made) const {
    Json rectangles = Json::array();
    for (const auto& r : made.rectangles)
      rectangles.push_back(
          {{"frames", {chunk.first + static_cast<int>(r.begin), chunk.first + static_cast<int>(r.end) - 1}},
           {"lights", r.lights}});
    char name[32];
    std::snprintf(name, sizeof name, "clusters_%04d.json", chunk.first);
    image::write_whole_file(path(name), Json{{"frames", {chunk.first, chunk.tail_last}},
                                             {"lights", made.lights},
                                             {"rectangles", std::move(rectangles)}}
                                                .dump() +
                                            "\n");
  }
  void write(int frame, const Picture& picture, const Report& report) const {
    image::FilesTogether together;
    // One exposure for all frames, which are not known beforehand.
    DisplaySettings display = settings_.display;
    display.exposure = display.exposure.value_or(0);
    for (const std::string& ending : settings_.endings)
      write_picture(path(stem_of(frame) + ending), picture, display);
    write_text(path(stem_of(frame) + ".json"), report.json());  // last: with it the frame is finished
    together.commit();
  }
  std::string path(const std::string& name) const { return (fs::path(folder_) / name).string(); }

  const Scene& scene_;
  const AnimateSettings& settings_;
  std::string folder_;
  Json manifest_;
};

// Tells how far a part of the shot is, of all that is missing.
Sinks part_of_progress(const Sinks& sinks, double begin, double share) {
  Sinks own = sinks;
  own.progress = [&sinks, begin, share](const char* stage, double fraction) {
    // Stages of a chunk, and the part of its time that they take, about.
    constexpr std::pair<std::string_view, std::pair<double, double>> kStages[] = {
        {"frames", {0, 0.3}}, {"rows", {0.3, 0.15}}, {"columns", {0.45, 0.35}}, {"changes", {0.8, 0.2}}};
    for (const auto& [name, part] : kStages)
      if (name == stage) sinks.report("frames", begin + share * (part.first + part.second * fraction));
  };
  return own;
}

void render_frames(const Shot& shot, bool refit, const std::vector<int>& missing, AnimationResult& result,
                   const Sinks& sinks) {
  Sinks own = sinks;
  own.progress = [](const char*, double) {};
  std::shared_ptr<const world::World> before;
  api::InShot in_shot;
  if (refit) in_shot.refit = &before;
  try {
    if (!missing.empty()) in_shot.lights = shot.plan_lights(sinks);
  } catch (const Cancelled&) {
    result.interrupted = true;
    return;
  }
  for (std::size_t k = 0; k < missing.size(); ++k) {
    sinks.report("frames", static_cast<double>(k) / static_cast<double>(missing.size()));
    if (sinks.cancelled() || !shot.render_frame(missing[k], in_shot, own)) {
      result.interrupted = true;
      return;
    }
    ++result.rendered;
  }
}

void render_chunks(const Shot& shot, const AnimateSettings& settings, const Range& frames,
                   const std::vector<int>& missing, AnimationResult& result, const Sinks& sinks) {
  if (missing.empty()) return;
  const int length = shot.frames_at_once(frames.first_key, frames.last_key);
  const api::ShotChunks chunks(frames.first_key, std::max(frames.last_key, frames.last), length,
                               settings.tensor->overlap);
  const auto all = static_cast<double>(missing.size());
  for (std::size_t k = 0; k < missing.size();) {
    const api::Chunk chunk = chunks.of(missing[k]);
    const double begin = static_cast<double>(k) / all;
    std::vector<int> wanted;
    while (k < missing.size() && missing[k] <= chunk.last) wanted.push_back(missing[k++]);
    const double share = static_cast<double>(wanted.size()) / all;
    const bool before = !shot.has_tails(chunks, wanted);
    if (sinks.cancelled() ||
        (before &&
         !shot.render_chunk(chunks, chunks.before(chunk), {}, part_of_progress(sinks, begin, share / 2))) ||
        !shot.render_chunk(
            chunks, chunk, wanted,
            part_of_progress(sinks, begin + (before ? share / 2 : 0), before ? share / 2 : share))) {
      result.interrupted = true;
      return;
    }
    result.rendered += static_cast<int>(wanted.size());
  }
}

}  // namespace

void choose_shot_method(const Scene& scene, AnimateSettings& settings) {
  const scenedesc::Motion& motion = scene.impl().desc.motion;
  RenderSettings& render = settings.render;
  // Not where every frame or instant has lights of its own (api/render_in_shot.h).
  if (motion.end > motion.begin && render.lights.placement == LightPlacement::automatic && render.time == 0 &&
      !render.view.is_open())
    render.lights.placement = LightPlacement::gather;
  if (settings.tensor || settings.refit || render.method.name != "auto" ||
      !render.method.parameters.empty() || !(motion.end > motion.begin))
    return;
  TensorSettings tensor;
  tensor.columns = kShotColumns, tensor.memory = kShotMemory;
  try {
    api::check(tensor, render);
  } catch (const InputError&) {  // something that it refuses is asked for
    return;
  }
  settings.tensor = tensor;
}

AnimationResult animate(const Scene& scene, const AnimateSettings& settings, const std::string& folder,
                        const Sinks& sinks) {
  validate(settings.render);
  if (settings.tensor) api::check(*settings.tensor, settings.render);
  if (settings.refit && (settings.tensor || settings.render.view.is_open()))
    throw InputError(std::string("structures cannot be refitted: ") +
                         (settings.tensor ? "tensor clustering" : "an open shutter") +
                         " needs those of many moments at once",
                     settings.tensor ? "name another --method, or leave out --refit" : "leave out --refit");
  if (settings.render.view.is_open() && scene.impl().options.frames_per_second != settings.frames_per_second)
    throw InputError("the shutter counts in other frames than the shot: the scene was read at " +
                         Json(scene.impl().options.frames_per_second).dump() + " per second",
                     "read it with the same LoadOptions::frames_per_second");
  if (settings.endings.empty()) throw InputError("the frames have no format", "give --format exr,png");
  const Range frames = frames_of(scene.impl().desc, settings);
  Shot shot(scene, settings, folder);
  shot.open();
  AnimationResult result{.first = frames.first, .last = frames.last};
  std::vector<int> missing;
  for (int frame = frames.first; frame <= frames.last; ++frame)
    if (shot.is_finished(frame))
      ++result.kept;
    else
      missing.push_back(frame);
  if (settings.tensor)
    render_chunks(shot, settings, frames, missing, result, sinks);
  else
    render_frames(shot, settings.refit, missing, result, sinks);
  return result;
}

}  // namespace lumirank
