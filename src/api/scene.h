// Implementation of the public scene. Inside this room only (and its tests).
#pragma once

#include <memory>

#include "lumirank/lumirank.h"
#include "scenedesc/schema/mesh_cache.h"
#include "scenedesc/schema/scene_desc.h"

namespace lumirank {
struct Scene::Impl {
  scenedesc::SceneDesc desc;
  LoadOptions options;
  std::shared_ptr<scenedesc::MeshCache> meshes;  // of all moments; null for a scene from memory
  std::vector<std::string> files_read;  // by the reader; pictures and meshes are read when the scene is built
};
}  // namespace lumirank
