// The two wrappings of a glTF file: JSON text (.gltf), and JSON with a block of bytes in chunks (.glb).
#pragma once

#include <string>
#include <string_view>

namespace lumirank::scenedesc::gltf {

struct Container {
  std::string_view json;
  std::string_view binary;  // of a .glb; empty if it has none
  bool is_glb = false;
};

// Told apart by the first four bytes. The views point into `bytes`. InputError for a .glb that is cut off, of
// another version, or whose chunks do not fit into it.
Container open_container(std::string_view bytes, const std::string& filename);

}  // namespace lumirank::scenedesc::gltf
