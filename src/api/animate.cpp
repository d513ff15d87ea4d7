#include "lumirank/animate.h"

#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "api/render_tensor.h"
#include "api/scene.h"
#include "api/shot.h"
#include "api/shot_frames.h"
#include "api/shot_tensor.h"
#include "base/error.h"
#include "pipeline/pass_run.h"
#include "pipeline/path_run.h"

namespace lumirank {
namespace {

using Json = nlohmann::ordered_json;

// Rounding of frame numbers and key times: a millionth of a frame counts for nothing.
constexpr double kSlack = 1e-6;

api::ShotRange frames_of(const scenedesc::SceneDesc& scene, const AnimateSettings& settings) {
  const scenedesc::Motion& motion = scene.motion;
  const double fps = settings.frames_per_second;
  if (!(fps > 0) || !std::isfinite(fps))
    throw InputError("the number of frames per second is not positive", "give --fps 24, say");
  const auto first_key = static_cast<int>(std::ceil(motion.begin * fps - kSlack)),
             last_key = static_cast<int>(std::floor(motion.end * fps + kSlack));
  const api::ShotRange range{settings.first < 0 ? first_key : settings.first,
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
  const api::Shot shot{scene, settings, frames_of(scene.impl().desc, settings), {settings, folder}};
  shot.folder.open(scene);
  AnimationResult result{.first = shot.range.first, .last = shot.range.last};
  std::vector<int> missing;
  for (int frame = shot.range.first; frame <= shot.range.last; ++frame)
    if (shot.folder.is_finished(frame))
      ++result.kept;
    else
      missing.push_back(frame);
  if (settings.tensor)
    api::render_chunks(shot, missing, result, sinks);
  else
    filter > 0 ? api::render_averaged(shot, missing, result, sinks)
               : api::render_frames(shot, missing, result, sinks);
  return result;
}

}  // namespace lumirank
