// Morton (Z-order) codes: positions that are near each other get codes that are mostly near each other.
#pragma once

#include <cstdint>

namespace lumirank {

// Spreads the lower 32 bits of x to the even bits.
inline std::uint64_t spread2(std::uint64_t x) {
  x &= 0xffffffffull;
  x = (x | x << 16) & 0x0000ffff0000ffffull;
  x = (x | x << 8) & 0x00ff00ff00ff00ffull;
  x = (x | x << 4) & 0x0f0f0f0f0f0f0f0full;
  x = (x | x << 2) & 0x3333333333333333ull;
  return (x | x << 1) & 0x5555555555555555ull;
}
// Spreads the lower 21 bits of x to every third bit.
inline std::uint64_t spread3(std::uint64_t x) {
  x &= 0x1fffffull;
  x = (x | x << 32) & 0x001f00000000ffffull;
  x = (x | x << 16) & 0x001f0000ff0000ffull;
  x = (x | x << 8) & 0x100f00f00f00f00full;
  x = (x | x << 4) & 0x10c30c30c30c30c3ull;
  return (x | x << 2) & 0x1249249249249249ull;
}

inline std::uint64_t morton2(std::uint32_t x, std::uint32_t y) { return spread2(x) | spread2(y) << 1; }
inline std::uint64_t morton3(std::uint32_t x, std::uint32_t y, std::uint32_t z) {
  return spread3(x) | spread3(y) << 1 | spread3(z) << 2;
}

}  // namespace lumirank
