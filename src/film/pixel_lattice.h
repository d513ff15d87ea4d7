// Interleaved pixels: every side-th of a film in x and in y, one of side² sets that lie between each other.
// What is shared by the pixels of a set, errors among it, neighbors do not share, so that it is noise to a
// denoiser and to an eye (A. Keller, W. Heidrich, "Interleaved Sampling", 2001).
#pragma once

namespace lumirank::film {

struct PixelLattice {
  int side = 1, x = 0, y = 0;  // x, y: its first pixel

  bool has(int pixel_x, int pixel_y) const { return pixel_x % side == x && pixel_y % side == y; }
  // The same pixels counted from a corner of a window of the film.
  PixelLattice in_window(int corner_x, int corner_y) const {
    const auto from = [this](int first, int corner) { return ((first - corner) % side + side) % side; };
    return {side, from(x, corner_x), from(y, corner_y)};
  }
  friend bool operator==(const PixelLattice&, const PixelLattice&) = default;
};

// The k-th of side² sets, below that; the first side of them have no two in one row or column.
inline PixelLattice interleaved(int side, int k) {
  const int x = k % side;
  return {side, x, (k / side + x) % side};
}

}  // namespace lumirank::film
