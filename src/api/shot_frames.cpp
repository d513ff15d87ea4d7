#include "api/shot_frames.h"

#include <algorithm>
#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include "api/build_world.h"
#include "api/render_in_shot.h"
#include "api/scene.h"
#include "api/shot_choices.h"
#include "base/error.h"
#include "base/parallel.h"
#include "base/timer.h"
#include "pipeline/develop.h"
#include "pipeline/path_run.h"
#include "pipeline/shot_filter.h"

namespace lumirank::api {
namespace {

// Without a budget: the mean of seven frames has the noise of one with three times its passes, or less.
constexpr double kPartOfStill = 0.375;

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

// The world at the beginning of the motion, whichever frames are asked for.
std::shared_ptr<const world::World> first_world(const Shot& shot, const Sinks& sinks) {
  const RenderSettings& settings = shot.settings.render;
  Sinks silent;
  silent.cancel = sinks.cancel;
  std::shared_ptr<const world::World> world;
  with_threads(settings.threads, [&] {
    const Scene first = shot.scene.at(shot.scene.impl().desc.motion.begin, silent);
    world = build_world(first, silent,
                        {.media = pipeline::paths_by_default(first.impl().desc, settings),
                         .straight_panes = settings.traced.panes == Panes::straight});
  });
  return world;
}

// Before it is averaged with its neighbors. Without a result it was interrupted.
struct FrameAlone {
  int frame = 0;
  pipeline::ShotFrame filmed;
  std::optional<RenderResult> result = {};
};

FrameAlone render_alone(const Shot& shot, ShotChoices& choices, int frame, InShot in_shot,
                        const Sinks& sinks) {
  FrameAlone alone{frame, {}};
  RenderSettings settings = shot.settings.render;
  settings.seed += static_cast<std::uint64_t>(frame);
  in_shot.filmed = &alone.filmed, in_shot.part_of_usual = kPartOfStill;
  RenderResult result = choices.render(frame, settings, in_shot, sinks);
  if (!result.interrupted) alone.result = std::move(result);
  return alone;
}

void write_averaged(const Shot& shot, FrameAlone& alone, const std::deque<pipeline::ShotFrame>& frames,
                    std::size_t own) {
  const Timer timer;
  RenderResult& result = *alone.result;
  with_threads(shot.settings.render.threads, [&] {
    Picture picture = pipeline::to_picture(pipeline::filtered_in_time(frames, own));
    pipeline::refilter(picture, frames[own].lacking_filter);
    result.picture.planes[0] = std::move(picture.planes[0]);
  });
  result.report.numbers["shot.averaged"] = static_cast<double>(frames.size());
  result.report.seconds["filter"] = timer.seconds();
  shot.folder.write(alone.frame, result.picture, result.report);
}

// False if it was interrupted.
bool render_frame(const Shot& shot, int frame, const InShot& in_shot, const Sinks& sinks) {
  const RenderResult result = render_by_choice(shot.at(frame, sinks), shot.settings.render, in_shot, sinks);
  if (result.interrupted) return false;
  shot.folder.write(frame, result.picture, result.report);
  return true;
}

}  // namespace

void render_frames(const Shot& shot, const std::vector<int>& missing, AnimationResult& result,
                   const Sinks& sinks) {
  WarnsOnce once;
  const Sinks own = once.sinks(sinks);
  std::shared_ptr<const world::World> before;
  InShot in_shot;
  if (shot.settings.refit) in_shot.refit = &before;
  try {
    if (!missing.empty()) in_shot.lights = plan_lights_of_motion(shot.scene, shot.settings.render, sinks);
  } catch (const Cancelled&) {
    result.interrupted = true;
    return;
  }
  for (std::size_t k = 0; k < missing.size(); ++k) {
    sinks.report("frames", static_cast<double>(k) / static_cast<double>(missing.size()));
    if (sinks.cancelled() || !render_frame(shot, missing[k], in_shot, own)) {
      result.interrupted = true;
      return;
    }
    ++result.rendered;
  }
}

void render_averaged(const Shot& shot, const std::vector<int>& missing, AnimationResult& result,
                     const Sinks& sinks) {
  WarnsOnce once;
  const Sinks own = once.sinks(sinks);
  if (missing.empty()) return;
  const ShotRange& range = shot.range;
  const int reach = shot.settings.temporal_filter.value_or(0);
  try {
    ShotChoices choices(shot);
    choices.find_finished();
    const InShot in_shot{.before = first_world(shot, sinks)};
    if (choices.needs_pilot(missing.size())) choices.run_pilot(missing[missing.size() / 2], in_shot, sinks);
    std::deque<FrameAlone> alone;
    std::deque<pipeline::ShotFrame> filmed;
    for (std::size_t k = 0; k < missing.size(); ++k) {
      const int first = std::max(range.first_key, missing[k] - reach),
                last = std::min(std::max(range.last_key, range.last), missing[k] + reach);
      while (!alone.empty() && alone.front().frame < first) alone.pop_front(), filmed.pop_front();
      for (int frame = alone.empty() ? first : alone.back().frame + 1; frame <= last; ++frame) {
        sinks.report("frames", (static_cast<double>(k) +
                                static_cast<double>(frame - first) / static_cast<double>(last - first + 1)) /
                                   static_cast<double>(missing.size()));
        if (!sinks.cancelled()) alone.push_back(render_alone(shot, choices, frame, in_shot, own));
        if (sinks.cancelled() || !alone.back().result) {
          result.interrupted = true;
          return;
        }
        filmed.push_back(std::move(alone.back().filmed));
      }
      const auto at = static_cast<std::size_t>(missing[k] - first);
      write_averaged(shot, alone[at], filmed, at);
      ++result.rendered;
    }
  } catch (const Cancelled&) {
    result.interrupted = true;
  }
}

}  // namespace lumirank::api
