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

// Reports its warnings; `keep` (may be nullptr) gets them as well. `units`: instead of its own, or nullptr.
std::shared_ptr<const world::World> build_world(const Scene& scene, const Sinks& sinks,
                                                std::vector<scenedesc::Warning>* keep = nullptr,
                                                const world::Units* units = nullptr);

}  // namespace lumirank::api
