// Implementation of the public scene. Inside this room only (and its tests).
#pragma once

#include "lumirank/lumirank.h"
#include "scenedesc/schema/scene_desc.h"

namespace lumirank {
struct Scene::Impl {
  scenedesc::SceneDesc desc;
  LoadOptions options;
  std::vector<std::string> files_read;  // by the reader; pictures and meshes are read when the scene is built
};
}  // namespace lumirank
