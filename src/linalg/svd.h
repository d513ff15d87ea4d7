// Singular values: exactly, of matrices that fit in memory (2007, figure 3), and the leading ones of larger
// matrices.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace lumirank::linalg {

// All min(rows, columns) singular values of a row-major matrix, descending, in double precision. O(rows ·
// columns · the smaller of both): a few seconds at 1,200 × 1,000.
std::vector<double> singular_values(std::span<const float> matrix, std::size_t rows, std::size_t columns);

struct RandomizedSvdSettings {
  std::size_t rank = 20;
  std::size_t oversampling = 10;  // more directions than asked for: the error falls off with it
  std::size_t power_steps =
      2;  // each multiplies the contrast between singular values; they are squared per step
  std::uint64_t seed = 1;
};

// matrix ≈ U · diag(values) · Vᵀ. u: rows × rank, v: columns × rank, row-major.
struct TruncatedSvd {
  std::vector<double> values;
  std::vector<float> u, v;
};

// Halko, Martinsson, Tropp 2011, "Finding structure with randomness", algorithms 4.4 and 5.1: orthonormal
// range of the matrix times a Gaussian one, power steps with orthonormalization between, then the SVD of what
// is left in that range. rank is reduced to min(rows, columns) where it is larger.
TruncatedSvd randomized_svd(std::span<const float> matrix, std::size_t rows, std::size_t columns,
                            const RandomizedSvdSettings& settings);

}  // namespace lumirank::linalg
