// Hilbert's curve through the plane: an order in which neighbors are near each other.
#pragma once

#include <cstdint>
#include <utility>

namespace lumirank {

// Place along the curve of the cell (x, y) of a 2ᵇ × 2ᵇ grid, b ≤ 16; every cell has a place of its own, and
// cells that follow each other share a side.
inline std::uint32_t hilbert_place(std::uint32_t x, std::uint32_t y, unsigned bits) {
  std::uint32_t place = 0;
  for (std::uint32_t side = 1u << (bits - 1); side > 0; side /= 2) {
    const std::uint32_t right = (x & side) ? 1 : 0, up = (y & side) ? 1 : 0;
    place += side * side * ((3 * right) ^ up);
    // Turn the quadrant so that it looks like the whole.
    if (up == 0) {
      if (right == 1) {
        x = side - 1 - (x & (side - 1));
        y = side - 1 - (y & (side - 1));
      }
      std::swap(x, y);
    }
  }
  return place;
}

}  // namespace lumirank
