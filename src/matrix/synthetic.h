// Made-up lighting matrices whose structure is known: what the methods' tests stand on. Entries are never
// negative.
#pragma once

#include <cstdint>

#include "matrix/dense_matrix.h"

namespace lumirank::matrix {

struct SyntheticSize {
  std::size_t rows = 256;
  std::size_t columns = 500;
  std::uint64_t seed = 1;
};

// `clusters` directions; every column is a multiple (of widely varying size and the same color) of one of
// them. The feature `indirect` is not set; direction of column j is j mod clusters.
DenseMatrix clustered_matrix(const SyntheticSize& size, std::size_t clusters);

// A sum of `rank` products of positive factors that vary smoothly over a square image and over the columns,
// colored lights, 2 receivers per pixel. Powers are the columns' emitted power, with noise. With `groups` >
// 1 columns are dealt out to groups in turn.
DenseMatrix low_rank_matrix(const SyntheticSize& size, std::size_t rank, std::size_t groups = 1);

// Mostly zero: every column lights only a random patch of the rows, `share` of them; visibility is apart from
// the unoccluded part. Some columns are zero everywhere and some have no power.
DenseMatrix sparse_matrix(const SyntheticSize& size, double share);

// The low-rank matrix of rank 4 as if through fog: visibilities between 0 and 1, apart from the unoccluded
// part.
DenseMatrix hazy_matrix(const SyntheticSize& size);

// The adversary of figure 8: omni lamps in recesses. A smooth common part reaches all rows; besides, every
// column lights a few rows of its own, strongly, so columns look alike on most sampled rows.
DenseMatrix recess_matrix(const SyntheticSize& size);

// A room with shadows: receivers on the floor of a unit cube (2 per pixel of a square image), small lamps on
// its ceiling that shine downwards, between them `occluders` horizontal discs and squares in mid-air.
// Visibility is apart from the unoccluded part; rows and columns have places, normals, powers and colors.
DenseMatrix occluded_matrix(const SyntheticSize& size, std::size_t occluders);

}  // namespace lumirank::matrix
