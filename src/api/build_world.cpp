#include "api/build_world.h"

#include "api/scene.h"
#include "pipeline/memory.h"

namespace lumirank::api {

std::string warning_text(const scenedesc::Warning& warning) {
  std::string text = to_string(warning.where);
  if (!text.empty()) text += ": ";
  text += warning.what;
  if (!warning.used_instead.empty())
    text += "; used instead: " + warning.used_instead;
  else if (!warning.harmless && warning.what.find("left out") == std::string::npos)
    text += "; left out";
  return text;
}

void report_warnings(const Sinks& sinks, const std::vector<scenedesc::Warning>& warnings) {
  for (const auto& w : warnings)
    if (w.harmless)
      sinks.say(warning_text(w));
    else
      sinks.warn(warning_text(w));
}

std::shared_ptr<const world::World> build_world(const Scene& scene, const Sinks& sinks,
                                                const BuildExtras& extras) {
  std::vector<scenedesc::Warning> warnings;
  world::BuildOptions options;
  options.strict = scene.impl().options.strict;
  options.before = extras.refit ? extras.refit : extras.before;
  options.media = extras.media;
  options.refit = extras.refit != nullptr;
  options.straight_panes = extras.straight_panes;
  if (extras.before) options.units = extras.before->units();
  std::shared_ptr<const world::World> world;
  pipeline::within_memory("the scene is too large for this machine", [&] {
    world = std::make_shared<world::World>(world::World::build(scene.impl().desc, options, warnings, sinks));
  });
  report_warnings(sinks, warnings);
  if (extras.warnings) *extras.warnings = std::move(warnings);
  return world;
}

}  // namespace lumirank::api
