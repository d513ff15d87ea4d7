// Numbers on a regular grid that fills a box, and what lies between them.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "base/rgb.h"
#include "base/transform.h"
#include "base/vec.h"

namespace lumirank::media {

class Grid {
 public:
  enum class Sampling : std::uint8_t {
    corners,       // the first and the last number lie on the faces of the box
    centers,       // in the middle of cells; between there and a face the outermost number holds
    fading_cells,  // in the middle of cells, with zeros beyond
  };

  // `values`: x fastest, then y, then z; 1 or 3 channels at each place.
  Grid(std::array<int, 3> size, int channels, std::vector<float> values, Sampling sampling,
       bool nearest = false);

  // At a place of the unit cube (others count as the nearest one in it); one channel as gray.
  Rgb at(Vec3f unit) const;
  // The least and the largest of what at() gives in a box of the unit cube, or beyond both.
  struct Range {
    Rgb least, most;
  };
  Range range(Vec3f lo, Vec3f hi) const;

  const std::array<int, 3>& size() const { return size_; }
  int channels() const { return channels_; }
  std::size_t memory_bytes() const { return values_.size() * sizeof(float); }

 private:
  Rgb value(int x, int y, int z) const;
  // In numbers along each axis: at 0 is the first one, at size - 1 the last.
  Vec3f index(Vec3f unit) const;

  std::array<int, 3> size_;
  int channels_;
  std::vector<float> values_;
  Sampling sampling_;
  bool nearest_;
  Vec3f steps_;  // numbers along the unit cube
  float shift_;  // of the first one from its face
};

// A quantity of a medium: a constant, times a grid if there is one.
struct Field {
  Rgb scale{0};
  std::shared_ptr<const Grid> grid = nullptr;
  Transform to_unit = {};     // from the world to the grid's unit cube
  bool zero_outside = false;  // of the cube; else as on its faces

  Rgb at(Vec3f place) const { return grid ? in_grid(place) : scale; }
  bool zero() const { return is_black(scale); }

 private:
  Rgb in_grid(Vec3f place) const;
};

}  // namespace lumirank::media
