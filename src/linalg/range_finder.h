// The leading range of a matrix and how many directions of it stand out, without allocating: what the
// separation starts from.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace lumirank::linalg {

struct RangeSpace {
  std::span<float> x;         // max_rank × rows, orthonormal; of it the first rank × rows are the result
  std::span<float> gathered;  // as large
  std::span<float> y;         // at least 16 × max_rank
  std::span<float> block;     // unused rows are left alone
  std::span<double> values;   // max_rank
};
struct RangeFound {
  std::size_t rank = 0;    // 1 … max_rank, or 0 if the matrix is zero
  std::size_t values = 0;  // leading singular values, descending, in RangeSpace::values
  double norm = 0;         // Frobenius
};

// Randomized range (Halko, Martinsson and Tropp 2011, algorithm 4.4 with one power step) from a sparse
// embedding: every column is added, with a random sign, to one of `most` sums. A singular value counts if it
// is above what noise with the energy of all that lies outside the range would reach
// (σ²(√rows + √columns)², the edge of Marchenko and Pastur's law). The matrix lies column after column.
RangeFound find_range(std::span<const float> d, std::size_t rows, std::size_t columns, std::size_t max_rank,
                      std::uint64_t seed, const RangeSpace& space);

// k vectors of length n, one after the other: Gram and Schmidt twice. A vector that depends on those before
// it becomes zero.
void orthonormalize(std::span<float> vectors, std::size_t k, std::size_t n);

}  // namespace lumirank::linalg
