#include "linalg/range_finder.h"

// g++ 12 takes the undefined lanes inside its own AVX-512 intrinsics for uninitialized variables.
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"
#endif

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>

#include "base/random.h"
#include "linalg/blas.h"
#include "linalg/fixed_sums.h"
#include "linalg/lapack.h"

namespace lumirank::linalg {

namespace {

constexpr std::size_t kVectorBlock = 16;
constexpr std::size_t kMax = 24;
using Vector = Eigen::Map<Eigen::VectorXf>;

Vector vector(float* v, std::size_t n) { return {v, static_cast<Eigen::Index>(n)}; }

}  // namespace

void orthonormalize(std::span<float> vectors, std::size_t k, std::size_t n) {
  for (std::size_t a = 0; a < k; ++a) {
    float* const at = &vectors[a * n];
    Vector va = vector(at, n);
    const float before = std::sqrt(fixed_dot(at, at, n));
    for (int pass = 0; pass < 2; ++pass)
      for (std::size_t b = 0; b < a; ++b) {
        va -= fixed_dot(at, &vectors[b * n], n) * vector(&vectors[b * n], n);
      }
    const float after = std::sqrt(fixed_dot(at, at, n));
    if (after > 1e-5f * before && after > 0)
      va /= after;
    else
      va.setZero();
  }
}

RangeFound find_range(std::span<const float> d, std::size_t rows, std::size_t columns, std::size_t max_rank,
                      std::uint64_t seed, const RangeSpace& space) {
  RangeFound found;
  const std::size_t s = std::min({max_rank, kMax, rows, columns}), m = rows;
  if (s == 0) return found;
  float* const x = space.x.data();
  std::fill_n(x, s * m, 0.0f);
  double energy = 0;
  for (std::size_t j = 0; j < columns; ++j) {
    const std::uint64_t bits = hash_ids(seed, Stage::projection, 0x52414e47, j);
    const float sign = bits & 1 ? 1.0f : -1.0f;
    const Eigen::Map<const Eigen::VectorXf> column(&d[j * m], static_cast<Eigen::Index>(m));
    vector(x + (j < s ? j : (bits >> 8) % s) * m, m) += sign * column;
    energy += static_cast<double>(fixed_dot(&d[j * m], &d[j * m], m));
  }
  found.norm = std::sqrt(energy);
  if (!(energy > 0)) return found;
  orthonormalize(space.x, s, m);

  std::array<double, kMax * kMax>
      gram{};  // s × s, symmetric; its eigenvectors afterwards, one after the other
  float* const gathered = space.gathered.data();
  float* const y = space.y.data();
  std::fill_n(gathered, s * m, 0.0f);
  for (std::size_t begin = 0; begin < columns; begin += kVectorBlock) {
    const std::size_t n = std::min(kVectorBlock, columns - begin);
    gemm({n, s, m, false, true}, &d[begin * m], m, x, m, y, s);
    gemm({s, m, n, true, false, 1.0f}, y, s, &d[begin * m], m, gathered, m);
    for (std::size_t j = 0; j < n; ++j)
      for (std::size_t a = 0; a < s; ++a)
        for (std::size_t b = 0; b < s; ++b)
          gram[a * s + b] += static_cast<double>(y[j * s + a] * y[j * s + b]);
  }
  std::array<double, kMax> squares{};  // ascending
  symmetric_eigen(gram, s, squares);
  double inside = 0;
  for (std::size_t a = 0; a < s; ++a) inside += std::max(squares[a], 0.0);
  const double min_side = static_cast<double>(std::min(rows, columns)),
               max_side = static_cast<double>(std::max(rows, columns));
  const double outside = std::max(energy - inside, 1e-10 * energy);
  const double directions = std::max(min_side - static_cast<double>(s), 1.0);
  const double edge =
      outside / directions * (1 + std::sqrt(min_side / max_side)) * (1 + std::sqrt(min_side / max_side));
  for (std::size_t a = 0; a < s; ++a) {
    const double square = std::max(squares[s - 1 - a], 0.0);
    space.values[a] = std::sqrt(square);
    if (a == 0 || square > edge) found.rank = a + 1;
  }
  found.values = s;
  // The power step, turned to the leading directions.
  for (std::size_t a = 0; a < found.rank; ++a) {
    Vector xa = vector(x + a * m, m);
    xa.setZero();
    for (std::size_t b = 0; b < s; ++b)
      xa += static_cast<float>(gram[(s - 1 - a) * s + b]) * vector(gathered + b * m, m);
  }
  orthonormalize(space.x, found.rank, m);
  return found;
}

}  // namespace lumirank::linalg
