// The one door to LAPACK: decompositions of matrices in double precision, column-major as LAPACK has them.
// Each runs on the calling thread alone, as every call of blas.h. (The templates of a header library took
// minutes to compile.)
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace lumirank::linalg {

struct ColumnMajor {
  std::size_t rows = 0, columns = 0;
  std::vector<double> values;  // rows · columns, one column after the other
  ColumnMajor() = default;
  ColumnMajor(std::size_t rows_, std::size_t columns_)
      : rows(rows_), columns(columns_), values(rows_ * columns_) {}
  double& operator()(std::size_t i, std::size_t j) { return values[j * rows + i]; }
  double operator()(std::size_t i, std::size_t j) const { return values[j * rows + i]; }
};

// op(A)·op(B).
ColumnMajor product(const ColumnMajor& a, bool a_transposed, const ColumnMajor& b, bool b_transposed);

// Orthonormal columns that span what the columns of a span. rows ≥ columns.
ColumnMajor orthonormal_basis(ColumnMajor a);

struct Svd {
  std::vector<double> values;  // min(rows, columns), descending
  ColumnMajor u, vt;  // rows × that many and that many × columns; empty where vectors are not asked for
};
Svd svd(ColumnMajor a, bool vectors);

// Of a symmetric matrix, n × n, whose lower triangle is read: eigenvalues ascending, and in its place the
// eigenvectors as columns.
void symmetric_eigen(std::span<double> a, std::size_t n, std::span<double> values);

}  // namespace lumirank::linalg
