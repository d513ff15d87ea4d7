// Slices: groups of rows that are alike, cut by a kd-tree over places and normals (Ou and Pellacini 2011,
// section 4; Huo et al. 2015, section 4.1). Within one the lighting matrix has a far lower rank than as a
// whole.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "matrix/lighting_matrix.h"

namespace lumirank::methods {

struct Slices {
  std::vector<matrix::Index> rows;   // slice after slice; within one ascending
  std::vector<std::uint32_t> first;  // of each slice, and one past the end

  std::size_t count() const { return first.empty() ? 0 : first.size() - 1; }
  std::span<const matrix::Index> slice(std::size_t s) const {
    return {rows.data() + first[s], rows.data() + first[s + 1]};
  }
};

// A row as the slices see it: its place, and its normal times an eighth of the diagonal of the box of all
// places: opposite normals are as far apart as a quarter of it. Without features, the index.
class SlicePoints {
 public:
  using Point = std::array<float, 6>;

  SlicePoints(const matrix::RowFeatures& features, std::size_t rows);
  Point operator[](matrix::Index i) const;
  bool known() const { return known_; }

 private:
  matrix::RowFeatures features_;
  bool known_;
  float normal_weight_ = 0;
};

// How far slices reach into each other: in each cut a pixel's rows are moved together, by a random way of up
// to `share` of the side of a slice. What differs from one slice to the next then ends in noise instead of an
// edge.
struct SliceOverlap {
  float share = 0;  // of a slice's side, to either side
  std::uint64_t seed = 0;
};

// Every row is in one slice of at most `max_rows`; slices have as many rows as each other, ± 1, but where
// rounding adds up. Cells are cut across their longest axis. Deterministic; rows of equal points go by index.
//
// Rows of a slice ascend: receivers are numbered along the film, those of one pixel in a stretch, so the ones
// that a slice has of a pixel lie together.
Slices make_slices(const matrix::RowFeatures& features, std::size_t rows, std::size_t max_rows = 1024,
                   SliceOverlap overlap = {});

// The pixels of a slice dealt to parts: of each stretch of as many pixels along the film every part gets one,
// in an order that changes from stretch to stretch. What a part has to itself, as the representatives of its
// clusters, then errs in every pixel in another way: noise that hardly clumps. Work space; keeps its buffers.
class PixelDeal {
 public:
  void deal(const matrix::RowFeatures& features, std::span<const matrix::Index> slice, std::size_t parts,
            std::uint64_t key);
  std::span<const matrix::Index> part(std::size_t p) const { return parts_[p]; }

 private:
  std::vector<std::vector<matrix::Index>> parts_;
};

}  // namespace lumirank::methods
