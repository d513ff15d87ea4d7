#include "film/pixel_lattice.h"

#include <gtest/gtest.h>

namespace lumirank::film {
namespace {

TEST(PixelLattice, SetsAreAllPixelsOnce) {
  for (const int side : {1, 2, 3})
    for (int y = 0; y < 7; ++y)
      for (int x = 0; x < 7; ++x) {
        int sets = 0;
        for (int k = 0; k < side * side; ++k) sets += interleaved(side, k).has(x, y);
        EXPECT_EQ(sets, 1) << side << ": " << x << ", " << y;
      }
}

TEST(PixelLattice, AWindowHasThePixelsOfTheFilm) {
  for (int k = 0; k < 9; ++k) {
    const PixelLattice film = interleaved(3, k), window = film.in_window(5, 4);
    for (int y = 0; y < 6; ++y)
      for (int x = 0; x < 6; ++x) EXPECT_EQ(window.has(x, y), film.has(x + 5, y + 4));
  }
}

}  // namespace
}  // namespace lumirank::film
