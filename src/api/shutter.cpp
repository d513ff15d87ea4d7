#include "api/shutter.h"

#include <algorithm>
#include <map>

#include "api/build_world.h"
#include "api/scene.h"
#include "base/error.h"
#include "pipeline/exposure.h"
#include "pipeline/recipe.h"

namespace lumirank::api {

std::vector<pathtrace::Instant> open_shutter(const Scene& scene, const RenderSettings& settings,
                                             std::size_t count, bool media, const Sinks& sinks) {
  const LoadOptions& load = scene.impl().options;
  const scenedesc::Motion& motion = scene.impl().desc.motion;
  if (!(load.frames_per_second > 0))
    throw InputError("the number of frames per second is not positive", "give --fps 24, say");
  if (!(motion.end > motion.begin)) sinks.say("nothing in the scene moves: the shutter blurs nothing");
  const double moment = load.time.value_or(motion.begin), frame = 1 / load.frames_per_second;
  Sinks quiet;
  quiet.cancel = sinks.cancel;
  std::map<double, pathtrace::Instant> made;  // by its moment
  std::vector<pathtrace::Instant> instants;
  for (const double when :
       pipeline::instants_between(moment + frame * settings.view.shutter_open,
                                  moment + frame * settings.view.shutter_close, count, settings.seed)) {
    // Before the first key as at it, after the last one as at that.
    const double at = std::clamp(when, motion.begin, std::max(motion.begin, motion.end));
    auto found = made.find(at);
    if (found == made.end()) {
      const bool first = made.empty();
      const Scene now = scene.at(at, quiet);
      auto world = build_world(now, first ? sinks : quiet,
                               {.before = first ? nullptr : instants.back().world.get(), .media = media});
      found = made.emplace(at, pathtrace::Instant{std::move(world),
                                                  pipeline::make_view(now.impl().desc, settings.view)})
                  .first;
    }
    if (sinks.cancelled()) throw Cancelled();
    instants.push_back(found->second);
    sinks.report("scene", static_cast<double>(instants.size()) / static_cast<double>(count));
  }
  return instants;
}

}  // namespace lumirank::api
