// The one door to BLAS: every call runs on one thread, so that callers may run many calls at once over fixed
// blocks and the number of threads never changes a bit.
#pragma once

#include <cstddef>

namespace lumirank::linalg {

// Called by everything that calls BLAS or LAPACK, before it does.
void one_thread_per_call();

// C (m×n) = beta·C + op(A)·op(B), all row-major, floats. A is m×k (or k×m if a_transposed), B is k×n (or
// n×k).
struct Gemm {
  std::size_t m, n, k;
  bool a_transposed = false, b_transposed = false;
  float beta = 0;
};
void gemm(const Gemm& shape, const float* a, std::size_t lda, const float* b, std::size_t ldb, float* c,
          std::size_t ldc);

}  // namespace lumirank::linalg
