// Options of reading a scene, whatever its format.
#pragma once

#include <map>
#include <string>

namespace lumirank::scenedesc {

struct ReadOptions {
  std::map<std::string, std::string> defines;  // --define NAME=VALUE: win over <default>
  bool strict = false;                         // the first warning becomes an error
  std::string environment = {};  // read_scene: an image that replaces whatever environment the scene has
  // Pictures, meshes and profiles that do not exist are a warning, and something visible stands in for them.
  bool allow_missing = false;
};

}  // namespace lumirank::scenedesc
