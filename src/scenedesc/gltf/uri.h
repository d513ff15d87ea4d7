// Names of things outside the JSON: files beside the scene, and data that the name itself holds.
#pragma once

#include <string>

#include "scenedesc/gltf/element.h"

namespace lumirank::scenedesc::gltf {

struct Resource {
  bool embedded = false;
  std::string bytes;     // of a data: URI, decoded
  std::string filename;  // otherwise: an absolute path
};

// Reads a "uri" member. Relative names are taken from the scene's folder, with %20 and the like decoded; one
// that exists only as it is written, undecoded, is taken so. InputError for other schemes (http:), for
// absolute paths, which glTF does not allow, and for base64 that is none.
Resource resolve_uri(const Element& uri);

// A file that the scene names and that does not exist.
class MissingFile : public InputError {
 public:
  using InputError::InputError;
};

// The message without its place and without the way out, which has been taken.
std::string what_is_missing(const MissingFile& error);

// The whole file. InputError at `user` if it is missing (a MissingFile), a folder, or cannot be read.
std::string read_resource(const std::string& filename, const Element& user);

// The scene file itself.
std::string read_scene_file(const std::string& filename);

}  // namespace lumirank::scenedesc::gltf
