// The picture in small blocks with a receiver at each corner, and who may learn from whom (Walter et al.
// 2005, section 5).
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "matrix/lighting_matrix.h"
#include "methods/common/row_group_pass.h"

namespace lumirank::methods {

// Film positions must be known.
class ImageBlocks {
 public:
  static constexpr int kSide = 4;  // pixels of a block

  struct Block {
    std::span<const matrix::Index> rows;
    // The first receivers of the pixels at its corners, which it shares with its neighbors; those that exist.
    std::array<matrix::Index, 4> corners;
    int corner_count = 0;
  };

  explicit ImageBlocks(const matrix::LightingMatrix& matrix);

  // Squares of blocks: large ones share more corners within, small ones are more to share out among threads.
  const RowGroups& row_groups() const { return row_groups_; }
  std::size_t blocks(std::size_t group) const { return first_block_[group + 1] - first_block_[group]; }
  Block block(std::size_t group, std::size_t which) const;

 private:
  struct Placed;
  RowGroups group(const matrix::LightingMatrix& matrix);

  int width_ = 0, height_ = 0;              // pixels
  std::vector<matrix::Index> pixel_row_;    // the first row of a pixel, or kNone
  std::vector<std::uint32_t> first_block_;  // by row group
  std::vector<std::uint32_t> first_row_;    // by block, into its row group's rows
  std::vector<std::array<int, 2>> place_;   // by block: its left upper pixel
  RowGroups row_groups_;
};

// Whether what light reaches one receiver tells of the other: normals within 30 degrees, and neither far
// above the other's plane, so that they do not look past each other or shadow one another. Rows whose
// places are unknown tell of each other.
bool alike(const matrix::RowFeatures& features, matrix::Index a, matrix::Index b);

}  // namespace lumirank::methods
