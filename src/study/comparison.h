// Several methods on one scene against one reference: the public comparison, on a description.
#pragma once

#include <string>
#include <vector>

#include "lumirank/compare.h"
#include "scenedesc/schema/scene_desc.h"

namespace lumirank::study {

struct StudiedScene {
  const scenedesc::SceneDesc& desc;
  bool strict;                     // warnings about the scene are errors
  std::vector<std::string> files;  // what it was read from: no output may be one of these
};

// As lumirank::compare().
Comparison compare(const StudiedScene& scene, const CompareSettings& settings, const std::string& folder,
                   const Sinks& sinks);

}  // namespace lumirank::study
