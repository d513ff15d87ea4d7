// Options of reading a scene, whatever its format.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>

namespace lumirank::scenedesc {

class MeshCache;

struct ReadOptions {
  std::map<std::string, std::string> defines;  // --define NAME=VALUE: win over <default>
  bool strict = false;                         // the first warning becomes an error
  std::string environment = {};  // read_scene: an image that replaces whatever environment the scene has
  // Pictures, meshes and profiles that do not exist are a warning, and something visible stands in for them.
  bool allow_missing = false;
  // The moment to read, in seconds; before the first key as at it, after the last one as at that. Unset:
  // glTF's nodes as they stand, the first key of a Mitsuba animation, the start of pbrt's shutter.
  std::optional<double> time = {};
  // glTF: the animation to show, by its name, or its number where it has none; "": the first; "*": all.
  std::string clip = {};
  double frames_per_second = 24;  // of meshes in numbered files
  // Meshes of readings before, to be used again where they are the same; may be null.
  std::shared_ptr<MeshCache> meshes = {};
};

}  // namespace lumirank::scenedesc
