#include "linalg/blas.h"

#include <cblas.h>

#include <mutex>

// Present in OpenBLAS only; another BLAS is taken to be serial. Weak, so that either links.
extern "C" void openblas_set_num_threads(int) __attribute__((weak));

namespace lumirank::linalg {

void one_thread_per_call() {
  static std::once_flag once;
  std::call_once(once, [] {
    if (openblas_set_num_threads) openblas_set_num_threads(1);
  });
}

void gemm(const Gemm& shape, const float* a, std::size_t lda, const float* b, std::size_t ldb, float* c,
          std::size_t ldc) {
  one_thread_per_call();
  cblas_sgemm(CblasRowMajor, shape.a_transposed ? CblasTrans : CblasNoTrans,
              shape.b_transposed ? CblasTrans : CblasNoTrans, static_cast<int>(shape.m),
              static_cast<int>(shape.n), static_cast<int>(shape.k), 1.0f, a, static_cast<int>(lda), b,
              static_cast<int>(ldb), shape.beta, c, static_cast<int>(ldc));
}

}  // namespace lumirank::linalg
