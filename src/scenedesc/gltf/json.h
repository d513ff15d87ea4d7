// JSON as a tree that knows its lines. nlohmann/json does the lexing and hands over events; its own tree has
// no positions, and messages about a scene need them.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace lumirank::scenedesc::gltf {

struct Json {
  enum class Kind : std::uint8_t { null, boolean, number, text, list, object };
  Kind kind = Kind::null;
  bool integral = false;  // a number without fraction or exponent
  int line = 0;           // 1-based, where the value begins (of a list or object: its bracket)
  double number = 0;      // a number's value; 1 for true
  std::string text;
  std::vector<Json> items;        // of a list, or the values of an object
  std::vector<std::string> keys;  // of an object, as many as items

  const Json* find(std::string_view key) const;  // null if this is no object or lacks the key
};

// InputError with the line for whatever is not JSON, for a key that an object has twice, and for nesting
// beyond 100 levels.
Json parse_json(std::string_view text, const std::string& filename);

}  // namespace lumirank::scenedesc::gltf
