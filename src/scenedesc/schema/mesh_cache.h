// Meshes that several readings of one file share: what does not change over time stays the same object, so
// that whatever is built from it can be kept too.
#pragma once

#include <map>
#include <memory>
#include <string>

#include "scenedesc/schema/mesh.h"

namespace lumirank::scenedesc {

class MeshCache {
 public:
  // `key` says where in its file the mesh stands and what was made of it; equal keys must be equal meshes.
  std::shared_ptr<const MeshData> find(const std::string& key) const {
    const auto found = meshes_.find(key);
    return found == meshes_.end() ? nullptr : found->second;
  }
  void keep(const std::string& key, std::shared_ptr<const MeshData> mesh) { meshes_[key] = std::move(mesh); }

 private:
  std::map<std::string, std::shared_ptr<const MeshData>> meshes_;
};

}  // namespace lumirank::scenedesc
