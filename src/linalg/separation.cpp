#include "linalg/separation.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "linalg/blas.h"
#include "linalg/fixed_sums.h"
#include "linalg/range_finder.h"

namespace lumirank::linalg {

namespace {

constexpr std::size_t kColumnBlock = 16;  // columns; a block of 1024 rows stays in a core's cache

// How far Z may keep off D − XY at an entry: not at all where D says nothing, without end where it is exact.
struct Thresholds {
  float of[4];
};

float square_sum(const float* v, std::size_t n) { return fixed_dot(v, v, n); }

// One column: from its X·Y (`product`, which becomes XY + Z − D) to the next Z, multiplier and B = D − Z − U.
// With R = D − XY − U the steps are Z = shrink(R, t), U ← U + XY + Z − D = Z − R.
void step(std::size_t rows, const float* d, const Entry* state, const Thresholds& thresholds, float* product,
          float* z, float* multiplier, float* next) {
  const float exact = thresholds.of[0], predicted = thresholds.of[1];
  for (std::size_t i = 0; i < rows; ++i) {
    const Entry s = state[i];
    const float t = s == Entry::exact ? exact : s == Entry::free ? 0.0f : predicted;
    const float r = d[i] - product[i] - multiplier[i];
    const float kept = std::max(-t, std::min(t, r));
    const float sparse = r - kept;
    product[i] = s == Entry::free ? 0.0f : product[i] + sparse - d[i];
    z[i] = sparse;
    multiplier[i] = -kept;
    next[i] = d[i] - sparse + kept;
  }
}

// The same with H stretched to the sphere of equation 12. In terms of Z, H' = τH means Z' = τZ + (1 − τ)sE/2.
// `h` becomes H where Z is not 0, `on` 1 there; else both are 0.
void constrained_step(std::size_t rows, const float* __restrict d, const float* __restrict e,
                      const Entry* __restrict state, const Thresholds& thresholds, float stretch,
                      float* __restrict product, float* __restrict z, float* __restrict multiplier,
                      float* __restrict next, float* __restrict h, float* __restrict on) {
  const float exact = thresholds.of[0], predicted = thresholds.of[1];
  for (std::size_t i = 0; i < rows; ++i) {
    const Entry s = state[i];
    const float t = s == Entry::exact ? exact : s == Entry::free ? 0.0f : predicted;
    const float r = d[i] - product[i] - multiplier[i];
    const float soft = r - std::max(-t, std::min(t, r));
    const float whole = s == Entry::predicted_hidden ? -e[i] : e[i];
    const bool predicted_here = s != Entry::exact && s != Entry::free;
    const float supported = (predicted_here & (soft != 0.0f) & (whole != 0.0f)) ? 1.0f : 0.0f;
    const float share = soft / (supported > 0 ? whole : 1.0f);
    const float clipped = 2 * std::max(-1.0f, std::min(2.0f, share)) - 1;
    const float sparse = supported > 0 ? 0.5f * whole * (stretch * clipped + 1) : soft;
    h[i] = supported * clipped;
    on[i] = supported;
    product[i] = s == Entry::free ? 0.0f : product[i] + sparse - d[i];
    z[i] = sparse;
    multiplier[i] = sparse - r;
    next[i] = d[i] - 2 * sparse + r;
  }
}

}  // namespace

void Separation::start(const CorruptedMatrix& matrix, const SeparationSettings& settings) {
  const std::size_t size = matrix.rows * matrix.columns;
  z_.assign(size, 0.0f);
  multiplier_.assign(size, 0.0f);
  low_rank_.resize(size);
  residuals_.clear();
  residuals_.reserve(settings.iterations);
  block_.resize(kColumnBlock * matrix.rows);
  product_.resize(kColumnBlock * matrix.rows);
  y_.resize(kColumnBlock * kMaxRank);
  scratch_.resize(2 * matrix.rows);
  gathered_.resize(kMaxRank * matrix.rows);
  x_.resize(kMaxRank * matrix.rows);
  values_.resize(kMaxRank);
  const RangeFound found =
      find_range(matrix.d, matrix.rows, matrix.columns, std::min(settings.max_rank, kMaxRank), settings.seed,
                 {x_, gathered_, y_, block_, values_});
  rank_ = found.rank;
  norm_ = found.norm;
  values_.resize(found.values);
  stretch_ = 1;
  converged_ = false;
}

double Separation::iterate(const CorruptedMatrix& matrix, const SeparationSettings& settings,
                           float threshold) {
  const std::size_t m = matrix.rows, k = rank_;
  constexpr float kNever = 3e38f;
  const bool all = settings.fit == SeparationSettings::Fit::all;
  const Thresholds thresholds{
      {all ? kNever : threshold, all ? threshold : 0.0f, all ? threshold : 0.0f, 0.0f}};
  const bool constrained = settings.constraint && all;
  std::fill_n(gathered_.begin(), k * m, 0.0f);
  double residual = 0, sphere = 0, support = 0;
  float *const h = scratch_.data(), *const on = h + m;
  for (std::size_t begin = 0; begin < matrix.columns; begin += kColumnBlock) {
    const std::size_t n = std::min(kColumnBlock, matrix.columns - begin), at = begin * m;
    project(matrix, at, n);
    for (std::size_t j = 0; j < n; ++j) {
      const std::size_t c = at + j * m, b = j * m;
      if (constrained) {
        constrained_step(m, &matrix.d[c], &matrix.e[c], &matrix.state[c], thresholds, stretch_, &product_[b],
                         &z_[c], &multiplier_[c], &block_[b], h, on);
        sphere += static_cast<double>(square_sum(h, m));
        support += static_cast<double>(square_sum(on, m));
      } else {
        step(m, &matrix.d[c], &matrix.state[c], thresholds, &product_[b], &z_[c], &multiplier_[c],
             &block_[b]);
      }
    }
    residual += static_cast<double>(square_sum(product_.data(), n * m));
    gemm({k, m, n, true, false, 1.0f}, y_.data(), k, block_.data(), m, gathered_.data(), m);
  }
  // The norm that H had in this pass stretches it in the next.
  if (sphere > 0) stretch_ = std::clamp(static_cast<float>(std::sqrt(support / sphere)), 0.5f, 2.0f);
  std::swap(x_, gathered_);
  orthonormalize(x_, k, m);
  return std::sqrt(residual);
}

// X·Y of a block of columns with Y = Xᵀ(D − Z − U), into product_.
void Separation::project(const CorruptedMatrix& matrix, std::size_t at, std::size_t n) {
  const std::size_t m = matrix.rows;
  for (std::size_t e = 0; e < n * m; ++e) block_[e] = matrix.d[at + e] - z_[at + e] - multiplier_[at + e];
  gemm({n, rank_, m, false, true}, block_.data(), m, x_.data(), m, y_.data(), rank_);
  gemm({n, m, rank_}, y_.data(), rank_, x_.data(), m, product_.data(), m);
}

void Separation::finish(const CorruptedMatrix& matrix) {
  for (std::size_t begin = 0; begin < matrix.columns; begin += kColumnBlock) {
    const std::size_t n = std::min(kColumnBlock, matrix.columns - begin), at = begin * matrix.rows;
    project(matrix, at, n);
    std::copy_n(product_.begin(), n * matrix.rows, &low_rank_[at]);
  }
}

void Separation::run(const CorruptedMatrix& matrix, const SeparationSettings& settings) {
  const std::size_t size = matrix.rows * matrix.columns;
  if (matrix.d.size() != size || matrix.state.size() != size ||
      (settings.constraint && matrix.e.size() != size))
    throw InternalError("separation: spans of the wrong length");
  start(matrix, settings);
  if (rank_ == 0 || !(norm_ > 0)) {
    std::fill(low_rank_.begin(), low_rank_.end(), 0.0f);
    converged_ = true;
    return;
  }
  const double threshold = settings.threshold * norm_ / std::sqrt(static_cast<double>(size));
  double last = 0;
  for (std::size_t k = 0; k < settings.iterations && !converged_; ++k) {
    const double residual = iterate(matrix, settings, static_cast<float>(threshold)) / norm_;
    residuals_.push_back(residual);
    converged_ = residual < settings.tolerance ||
                 (settings.min_progress > 0 && k > 2 && residual > (1 - settings.min_progress) * last);
    last = residual;
  }
  finish(matrix);
}

}  // namespace lumirank::linalg
