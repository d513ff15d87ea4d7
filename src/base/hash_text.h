// A number for a text that is the same on every machine (FNV-1a, 64 bits).
#pragma once

#include <cstdint>
#include <string_view>

namespace lumirank {

inline constexpr std::uint64_t kHashOfNothing = 0xcbf29ce484222325u;

// `before`: the hash of the text that this one goes on.
inline std::uint64_t hash_text(std::string_view text, std::uint64_t before = kHashOfNothing) {
  for (const char c : text) before = (before ^ static_cast<unsigned char>(c)) * 0x100000001b3u;
  return before;
}

}  // namespace lumirank
