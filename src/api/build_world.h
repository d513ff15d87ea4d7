// From a loaded scene to the world that is rendered.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "lumirank/lumirank.h"
#include "scenedesc/schema/scene_desc.h"
#include "world/world.h"

namespace lumirank::api {

// "file:line: what; used instead: what", or "; left out".
std::string warning_text(const scenedesc::Warning& warning);
// Warnings to where a person sees them, notes to where one may.
void report_warnings(const Sinks& sinks, const std::vector<scenedesc::Warning>& warnings);

struct BuildExtras {
  std::vector<scenedesc::Warning>* warnings = nullptr;  // gets them as well
  // Of the same scene at another moment: it is built in the units of that, and shares what has not changed.
  const world::World* before = nullptr;
  bool media = false;  // whoever asks for it can render participating media
  // Instead, in its own units: that is traced no more, and Embree's structures are refitted where only
  // vertices have moved.
  const world::World* refit = nullptr;
  bool straight_panes = false;
};

// Reports its warnings.
std::shared_ptr<const world::World> build_world(const Scene& scene, const Sinks& sinks,
                                                const BuildExtras& extras = {});

}  // namespace lumirank::api
