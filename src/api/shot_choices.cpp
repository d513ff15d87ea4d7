#include "api/shot_choices.h"

#include <algorithm>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <string>

#include "api/scene.h"
#include "base/error.h"
#include "pipeline/pass_run.h"
#include "pipeline/path_run.h"

namespace lumirank::api {
namespace {

// A shot of so many frames at least has a pilot of as much time as so many of them have. Of paths a denoiser
// needs some to know the noise, and of passes there have to be a few.
constexpr std::size_t kFramesForPilot = 12;
constexpr double kPilotFrames = 3, kPassesOfFrame = 1.8, kPathsOfFrame = 8;

}  // namespace

void ShotChoices::find_finished() {
  for (int frame = shot_.range.first_key; frame <= shot_.range.last_key && choices_.empty(); ++frame) {
    if (!shot_.folder.is_finished(frame)) continue;
    std::ifstream in(shot_.folder.report_file(frame), std::ios::binary);
    const auto report = nlohmann::ordered_json::parse(in, nullptr, false);
    if (!report.is_object() || !report.contains("choices")) continue;
    report["choices"].get_to(choices_);
    kind_ = report["method"] == pipeline::kByPaths ? InShot::Kind::paths : InShot::Kind::passes;
  }
}

bool ShotChoices::needs_pilot(std::size_t missing) const {
  const scenedesc::SceneDesc& desc = shot_.scene.impl().desc;
  const RenderSettings& settings = shot_.settings.render;
  return missing >= kFramesForPilot && settings.time > 0 && kind_ == InShot::Kind::open &&
         pipeline::passes_by_default(desc, settings) && pipeline::may_be_paths(settings) &&
         !pipeline::paths_by_default(desc, settings);
}

void ShotChoices::run_pilot(int frame, const InShot& in_shot, const Sinks& sinks) {
  RenderSettings settings = shot_.settings.render;
  settings.time *= kPilotFrames;
  Sinks silent;
  silent.cancel = sinks.cancel;
  const RenderResult result = render_by_choice(shot_.at(frame, silent), settings, in_shot, silent);
  if (result.interrupted) return;
  const auto number = [](const std::map<std::string, double>& of, const char* key) {
    const auto found = of.find(key);
    return found == of.end() ? 0.0 : found->second;
  };
  const auto seconds = [&](const char* key) { return number(result.report.seconds, key); };
  const auto counted = [&](const char* key) { return number(result.report.numbers, key); };
  // Of a frame: what it takes whatever it is made of, and how much of either fits into the rest.
  const double fixed = seconds("build") + seconds("features") + seconds("denoise"),
               left = shot_.settings.render.time - fixed;
  const auto fit = [left](double count, double took) {
    return count > 0 && took > 0 ? left * count / took : 0;
  };
  const double passes = fit(counted("passes"), seconds("total") - fixed - seconds("paths")),
               paths = fit(std::max(counted("paths"), counted("spp")), seconds("paths"));
  if (result.report.method == pipeline::kByPaths && paths >= kPathsOfFrame)
    kind_ = InShot::Kind::paths;
  else if (passes >= kPassesOfFrame)
    kind_ = InShot::Kind::passes;
}

RenderResult ShotChoices::render(int frame, RenderSettings settings, InShot in_shot, const Sinks& sinks) {
  in_shot.kind = kind_;
  if (kind_ != InShot::Kind::open) in_shot.why = "less noise in the shot's pilot";
  if (settings.time > 0 && !choices_.empty()) {
    settings.choices = choices_;
    try {
      return render_by_choice(shot_.at(frame, sinks), settings, in_shot, sinks);
    } catch (const InputError&) {
      settings.choices.clear();
    }
  }
  RenderResult result = render_by_choice(shot_.at(frame, sinks), settings, in_shot, sinks);
  if (!result.interrupted && settings.time > 0) choices_ = result.report.choices;
  return result;
}

}  // namespace lumirank::api
