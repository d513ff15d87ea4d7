#include "linalg/svd.h"

#include <algorithm>

#include "base/error.h"
#include "base/random.h"
#include "linalg/lapack.h"

namespace lumirank::linalg {

namespace {

ColumnMajor in_double(std::span<const float> matrix, std::size_t rows, std::size_t columns) {
  if (matrix.size() != rows * columns) throw InternalError("svd: wrong number of entries");
  ColumnMajor out(rows, columns);
  for (std::size_t i = 0; i < rows; ++i)
    for (std::size_t j = 0; j < columns; ++j) out(i, j) = static_cast<double>(matrix[i * columns + j]);
  return out;
}

}  // namespace

std::vector<double> singular_values(std::span<const float> matrix, std::size_t rows, std::size_t columns) {
  if (rows == 0 || columns == 0) return {};
  return svd(in_double(matrix, rows, columns), false).values;
}

TruncatedSvd randomized_svd(std::span<const float> matrix, std::size_t rows, std::size_t columns,
                            const RandomizedSvdSettings& settings) {
  TruncatedSvd result;
  const std::size_t smaller = std::min(rows, columns);
  if (smaller == 0) return result;
  const ColumnMajor a = in_double(matrix, rows, columns);
  const std::size_t rank = std::min(settings.rank, smaller),
                    width = std::min(settings.rank + settings.oversampling, smaller);
  Rng rng(settings.seed, Stage::projection, 0x535644);
  ColumnMajor gaussian(columns, width);
  for (double& g : gaussian.values) g = rng.next_gaussian();
  ColumnMajor q = orthonormal_basis(product(a, false, gaussian, false));
  for (std::size_t step = 0; step < settings.power_steps; ++step) {
    const ColumnMajor z = orthonormal_basis(product(a, true, q, false));
    q = orthonormal_basis(product(a, false, z, false));
  }
  const Svd inside = svd(product(q, true, a, false), true);  // width × columns
  const ColumnMajor u = product(q, false, inside.u, false);
  result.values.assign(inside.values.begin(), inside.values.begin() + static_cast<std::ptrdiff_t>(rank));
  result.u.resize(rows * rank);
  result.v.resize(columns * rank);
  for (std::size_t k = 0; k < rank; ++k) {
    for (std::size_t i = 0; i < rows; ++i) result.u[i * rank + k] = static_cast<float>(u(i, k));
    for (std::size_t j = 0; j < columns; ++j) result.v[j * rank + k] = static_cast<float>(inside.vt(k, j));
  }
  return result;
}

}  // namespace lumirank::linalg
