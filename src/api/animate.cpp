#include "lumirank/animate.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <deque>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <set>
#include <string_view>
#include <utility>

#include "api/build_world.h"
#include "api/render_in_shot.h"
#include "api/render_tensor.h"
#include "api/scene.h"
#include "api/shot_chunks.h"
#include "base/error.h"
#include "base/hash_text.h"
#include "base/parallel.h"
#include "base/timer.h"
#include "image/atomic_file.h"
#include "pipeline/develop.h"
#include "pipeline/pass_run.h"
#include "pipeline/path_run.h"

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

// A shot of so many frames at least has a pilot of as much time as so many of them have. Of paths a denoiser
// needs some to know the noise, and of passes there have to be a few.
constexpr std::size_t kFramesForPilot = 12;
constexpr double kPilotFrames = 3, kPassesOfFrame = 1.8, kPathsOfFrame = 8;

// Without a budget: the mean of seven frames has the noise of one with three times its passes, or less.
constexpr double kPartOfStill = 0.375;

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
                 {"temporal_filter", settings_.temporal_filter.value_or(0)},
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
    const RenderResult result = rendered(frame, settings_.render, shot, sinks);
    if (result.interrupted) return false;
    write(frame, result.picture, result.report);
    return true;
  }

  // Before it is averaged with its neighbors. Without a result it was interrupted.
  struct FrameAlone {
    int frame = 0;
    pipeline::ShotFrame filmed;
    std::optional<RenderResult> result = {};
  };
  FrameAlone render_alone(int frame, const api::InShot& shot, const Sinks& sinks) {
    FrameAlone alone{frame, {}};
    RenderSettings settings = settings_.render;
    settings.seed += static_cast<std::uint64_t>(frame);
    api::InShot own = shot;
    own.filmed = &alone.filmed, own.part_of_usual = kPartOfStill;
    RenderResult result = repeating_choices(frame, settings, own, sinks);
    if (!result.interrupted) alone.result = std::move(result);
    return alone;
  }

  // The world at the beginning of the motion, whichever frames are asked for.
  std::shared_ptr<const world::World> first_world(const Sinks& sinks) const {
    Sinks silent;
    silent.cancel = sinks.cancel;
    std::shared_ptr<const world::World> world;
    with_threads(settings_.render.threads, [&] {
      const Scene first = scene_.at(scene_.impl().desc.motion.begin, silent);
      world = api::build_world(first, silent,
                               {.media = pipeline::paths_by_default(first.impl().desc, settings_.render),
                                .straight_panes = settings_.render.traced.panes == Panes::straight});
    });
    return world;
  }

  // What the clock chose for a frame that is finished, if there is one.
  void find_choices(const Range& frames) {
    for (int frame = frames.first_key; frame <= frames.last_key && choices_.empty(); ++frame) {
      if (!is_finished(frame)) continue;
      std::ifstream in(path(stem_of(frame) + ".json"), std::ios::binary);
      const Json report = Json::parse(in, nullptr, false);
      if (!report.is_object() || !report.contains("choices")) continue;
      report["choices"].get_to(choices_);
      kind_ = report["method"] == pipeline::kByPaths ? api::InShot::Kind::paths : api::InShot::Kind::passes;
    }
  }

  // Whether passes or paths have less noise takes longer to find out than a frame may have, and is found once
  // for a shot of some length: of its middle, in as much time as some frames have.
  void pilot(int frame, const api::InShot& shot, const Sinks& sinks) {
    RenderSettings settings = settings_.render;
    settings.time *= kPilotFrames;
    Sinks silent;
    silent.cancel = sinks.cancel;
    const RenderResult result = rendered(frame, settings, shot, silent);
    if (result.interrupted) return;
    const auto number = [](const std::map<std::string, double>& of, const char* key) {
      const auto found = of.find(key);
      return found == of.end() ? 0.0 : found->second;
    };
    const auto seconds = [&](const char* key) { return number(result.report.seconds, key); };
    const auto counted = [&](const char* key) { return number(result.report.numbers, key); };
    // Of a frame: what it takes whatever it is made of, and how much of either fits into the rest.
    const double fixed = seconds("build") + seconds("features") + seconds("denoise"),
                 left = settings_.render.time - fixed;
    const auto fit = [left](double count, double took) {
      return count > 0 && took > 0 ? left * count / took : 0;
    };
    const double passes = fit(counted("passes"), seconds("total") - fixed - seconds("paths")),
                 paths = fit(std::max(counted("paths"), counted("spp")), seconds("paths"));
    if (result.report.method == pipeline::kByPaths && paths >= kPathsOfFrame)
      kind_ = api::InShot::Kind::paths;
    else if (passes >= kPassesOfFrame)
      kind_ = api::InShot::Kind::passes;
  }
  bool leaves_kind_open() const {
    return settings_.render.time > 0 && kind_ == api::InShot::Kind::open &&
           pipeline::passes_by_default(scene_.impl().desc, settings_.render) &&
           pipeline::may_be_paths(settings_.render) &&
           !pipeline::paths_by_default(scene_.impl().desc, settings_.render);
  }

  void write_averaged(FrameAlone& alone, const std::deque<pipeline::ShotFrame>& frames,
                      std::size_t own) const {
    const Timer timer;
    RenderResult& result = *alone.result;
    with_threads(settings_.render.threads, [&] {
      Picture picture = pipeline::to_picture(pipeline::filtered_in_time(frames, own));
      result.picture.planes[0] = std::move(picture.planes[0]);
    });
    result.report.numbers["shot.averaged"] = static_cast<double>(frames.size());
    result.report.seconds["filter"] = timer.seconds();
    write(alone.frame, result.picture, result.report);
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
  using Choices = decltype(RenderSettings::choices);

  // Under a time budget the first frame chooses for all: how many passes or paths, and of which size. Where
  // each chooses by its own clock they differ in what they look like, and flicker. A frame that is of another
  // kind chooses anew.
  RenderResult repeating_choices(int frame, RenderSettings settings, api::InShot shot, const Sinks& sinks) {
    shot.kind = kind_;
    if (kind_ != api::InShot::Kind::open) shot.why = "less noise in the shot's pilot";
    if (settings.time > 0 && !choices_.empty()) {
      settings.choices = choices_;
      try {
        return rendered(frame, settings, shot, sinks);
      } catch (const InputError&) {
        settings.choices.clear();
      }
    }
    RenderResult result = rendered(frame, settings, shot, sinks);
    if (!result.interrupted && settings.time > 0) choices_ = result.report.choices;
    return result;
  }
  RenderResult rendered(int frame, const RenderSettings& settings, const api::InShot& shot,
                        const Sinks& sinks) const {
    const Scene now = scene_.at(frame / settings_.frames_per_second, sinks);
    return api::render_by_choice(now, settings, shot, sinks);
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
  Choices choices_;
  api::InShot::Kind kind_ = api::InShot::Kind::open;
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

// Says no warning again that differs from an earlier one in its numbers alone, as one of a short budget does
// from frame to frame. Must outlive the sinks that it makes.
class WarnsOnce {
 public:
  Sinks sinks(const Sinks& asked) {
    Sinks own = asked;
    own.progress = [](const char*, double) {};
    if (asked.warning)
      own.warning = [this, &asked](const std::string& text) {
        std::string words = text;
        std::erase_if(words, [](char c) { return c == '.' || (c >= '0' && c <= '9'); });
        if (said_.insert(words).second) asked.warning(text);
      };
    return own;
  }

 private:
  std::set<std::string> said_;
};

void render_frames(const Shot& shot, bool refit, const std::vector<int>& missing, AnimationResult& result,
                   const Sinks& sinks) {
  WarnsOnce once;
  const Sinks own = once.sinks(sinks);
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

// The same, averaged with neighbors, which are rendered for it where they are finished already, or belong to
// another process: a frame has the same bits whichever are asked for.
void render_averaged(Shot& shot, int reach, const Range& frames, const std::vector<int>& missing,
                     AnimationResult& result, const Sinks& sinks) {
  WarnsOnce once;
  const Sinks own = once.sinks(sinks);
  if (missing.empty()) return;
  try {
    shot.find_choices(frames);
    const api::InShot in_shot{.before = shot.first_world(sinks)};
    if (missing.size() >= kFramesForPilot && shot.leaves_kind_open())
      shot.pilot(missing[missing.size() / 2], in_shot, sinks);
    std::deque<Shot::FrameAlone> alone;
    std::deque<pipeline::ShotFrame> filmed;
    for (std::size_t k = 0; k < missing.size(); ++k) {
      const int first = std::max(frames.first_key, missing[k] - reach),
                last = std::min(std::max(frames.last_key, frames.last), missing[k] + reach);
      while (!alone.empty() && alone.front().frame < first) alone.pop_front(), filmed.pop_front();
      for (int frame = alone.empty() ? first : alone.back().frame + 1; frame <= last; ++frame) {
        sinks.report("frames", (static_cast<double>(k) +
                                static_cast<double>(frame - first) / static_cast<double>(last - first + 1)) /
                                   static_cast<double>(missing.size()));
        if (!sinks.cancelled()) alone.push_back(shot.render_alone(frame, in_shot, own));
        if (sinks.cancelled() || !alone.back().result) {
          result.interrupted = true;
          return;
        }
        filmed.push_back(std::move(alone.back().filmed));
      }
      const auto at = static_cast<std::size_t>(missing[k] - first);
      shot.write_averaged(alone[at], filmed, at);
      ++result.rendered;
    }
  } catch (const Cancelled&) {
    result.interrupted = true;
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
  const scenedesc::SceneDesc& desc = scene.impl().desc;
  RenderSettings& render = settings.render;
  if (!(desc.motion.end > desc.motion.begin)) return;
  const bool fresh_lights = !settings.tensor && (pipeline::passes_by_default(desc, render) ||
                                                 pipeline::paths_by_default(desc, render));
  if (fresh_lights) {
    if (!settings.temporal_filter && !settings.refit) settings.temporal_filter = kShotFilter;
    return;
  }
  // Not where every frame or instant has lights of its own (api/render_in_shot.h).
  if (render.lights.placement == LightPlacement::automatic && render.time == 0 && !render.view.is_open())
    render.lights.placement = LightPlacement::gather;
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
  const int filter = settings.temporal_filter.value_or(0);
  if (filter < 0 || filter > 100)
    throw InputError("frames cannot be averaged with " + std::to_string(filter) + " on either side",
                     "give 0 to 100");
  if (filter > 0 && (settings.tensor || settings.refit || settings.render.view.is_open()))
    throw InputError(std::string("frames cannot be averaged with their neighbors: ") +
                         (settings.tensor  ? "tensor clustering has a filter of its own"
                          : settings.refit ? "structures that are refitted are those of one moment"
                                           : "those of an open shutter show many moments"),
                     "leave one of both out");
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
    filter > 0 ? render_averaged(shot, filter, frames, missing, result, sinks)
               : render_frames(shot, settings.refit, missing, result, sinks);
  return result;
}

}  // namespace lumirank
