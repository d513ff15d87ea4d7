#include "linalg/lapack.h"

#include <cblas.h>

#include <algorithm>
#include <string>

#include "base/error.h"
#include "linalg/blas.h"

// LAPACK's own interface, since not every LAPACK comes with a header.
extern "C" {
void dgeqrf_(const int* m, const int* n, double* a, const int* lda, double* tau, double* work,
             const int* lwork, int* info);
void dorgqr_(const int* m, const int* n, const int* k, double* a, const int* lda, const double* tau,
             double* work, const int* lwork, int* info);
void dgesdd_(const char* jobz, const int* m, const int* n, double* a, const int* lda, double* s, double* u,
             const int* ldu, double* vt, const int* ldvt, double* work, const int* lwork, int* iwork,
             int* info, std::size_t jobz_length);
void dsyev_(const char* jobz, const char* uplo, const int* n, double* a, const int* lda, double* w,
            double* work, const int* lwork, int* info, std::size_t jobz_length, std::size_t uplo_length);
}

namespace lumirank::linalg {

namespace {

void check_info(const char* name, int info) {
  if (info != 0) throw InternalError(std::string("LAPACK's ") + name + " returned " + std::to_string(info));
}

// Runs call(work, its length) twice: first with length -1, which answers how much it wants.
template <class Call>
void with_workspace(Call&& call) {
  double wanted = 0;
  call(&wanted, -1);
  std::vector<double> work(static_cast<std::size_t>(std::max(wanted, 1.0)));
  call(work.data(), static_cast<int>(work.size()));
}

}  // namespace

ColumnMajor product(const ColumnMajor& a, bool a_transposed, const ColumnMajor& b, bool b_transposed) {
  one_thread_per_call();
  const std::size_t m = a_transposed ? a.columns : a.rows, k = a_transposed ? a.rows : a.columns,
                    n = b_transposed ? b.rows : b.columns;
  ColumnMajor c(m, n);
  if (m == 0 || n == 0 || k == 0) return c;
  cblas_dgemm(CblasColMajor, a_transposed ? CblasTrans : CblasNoTrans,
              b_transposed ? CblasTrans : CblasNoTrans, static_cast<int>(m), static_cast<int>(n),
              static_cast<int>(k), 1.0, a.values.data(), static_cast<int>(a.rows), b.values.data(),
              static_cast<int>(b.rows), 0.0, c.values.data(), static_cast<int>(m));
  return c;
}

ColumnMajor orthonormal_basis(ColumnMajor a) {
  one_thread_per_call();
  if (a.rows < a.columns) throw InternalError("orthonormal_basis: more columns than rows");
  const int m = static_cast<int>(a.rows), n = static_cast<int>(a.columns);
  std::vector<double> tau(a.columns);
  int info = 0;
  with_workspace([&](double* work, int length) {
    dgeqrf_(&m, &n, a.values.data(), &m, tau.data(), work, &length, &info);
    check_info("dgeqrf", info);
  });
  with_workspace([&](double* work, int length) {
    dorgqr_(&m, &n, &n, a.values.data(), &m, tau.data(), work, &length, &info);
    check_info("dorgqr", info);
  });
  return a;
}

Svd svd(ColumnMajor a, bool vectors) {
  one_thread_per_call();
  const std::size_t smaller = std::min(a.rows, a.columns);
  Svd out;
  if (smaller == 0) return out;
  out.values.resize(smaller);
  if (vectors) {
    out.u = ColumnMajor(a.rows, smaller);
    out.vt = ColumnMajor(smaller, a.columns);
  }
  const int m = static_cast<int>(a.rows), n = static_cast<int>(a.columns), k = static_cast<int>(smaller);
  const char job = vectors ? 'S' : 'N';
  std::vector<int> integers(8 * smaller);
  int info = 0;
  with_workspace([&](double* work, int length) {
    dgesdd_(&job, &m, &n, a.values.data(), &m, out.values.data(), out.u.values.data(), &m,
            out.vt.values.data(), &k, work, &length, integers.data(), &info, 1);
    check_info("dgesdd", info);
  });
  return out;
}

void symmetric_eigen(std::span<double> a, std::size_t n, std::span<double> values) {
  one_thread_per_call();
  if (n == 0) return;
  if (a.size() < n * n || values.size() < n) throw InternalError("symmetric_eigen: too few entries");
  const int size = static_cast<int>(n);
  int info = 0;
  with_workspace([&](double* work, int length) {
    dsyev_("V", "L", &size, a.data(), &size, values.data(), work, &length, &info, 1, 1);
    check_info("dsyev", info);
  });
}

}  // namespace lumirank::linalg
