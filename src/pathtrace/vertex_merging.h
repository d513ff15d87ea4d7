// Vertex merging (Georgiev, Křivánek, Davidovič and Slusallek 2012; Hachisuka, Pantaleoni and Jensen 2012):
// light paths that end near a place that an eye path sees by a mirror or through glass count as if they had
// ended there. No light path can be shown to the eye from there, and what an eye path finds beyond, by glass
// or mirrors again, it finds by chance.
//
// Gathered is within about a pixel, so what is blurred is less than that, and textures are not blurred at
// all: they are the eye path's.
#pragma once

#include <cstdint>
#include <vector>

#include "base/rgb.h"
#include "world/world.h"

namespace lumirank::pathtrace {

// The first vertex of an eye path that is not specular, where that is not what the eye sees directly.
struct MergePoint {
  world::SurfaceHit hit;
  Vec3f wo;        // unit, to the vertex before
  Rgb throughput;  // of the path up to here
  float area = 0;  // of the disc within which light paths count
  int segments = 0;
  std::uint32_t pixel = 0;
};

// Those of one path from each pixel, found by place.
class MergePoints {
 public:
  MergePoints() = default;
  explicit MergePoints(std::vector<std::vector<MergePoint>> parts);

  // Those on whose disc `at` lies; `found` is emptied first.
  void around(const scatter::SurfacePoint& at, std::vector<const MergePoint*>& found) const;

 private:
  struct Cell {
    std::int64_t x, y, z;
  };
  struct Entry {
    std::uint64_t key;
    std::uint32_t point;
  };
  // Discs of a level have a diameter of at most its cell, 2^level.
  static int level_of(const MergePoint& point);
  static Cell cell_of(Vec3f place, int level);
  static std::uint64_t key_of(const Cell& cell, int level);
  static bool on_disc(const MergePoint& point, const scatter::SurfacePoint& at);

  std::vector<MergePoint> points_;
  std::vector<int> levels_;     // that occur
  std::vector<Entry> entries_;  // by buckets, a power of two of them
  std::vector<std::uint32_t> begins_;
};

}  // namespace lumirank::pathtrace
