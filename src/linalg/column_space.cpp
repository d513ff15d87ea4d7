#include "linalg/column_space.h"

#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"
#endif

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

namespace lumirank::linalg {

namespace {

// Of a column's norm: less of it outside of the space is rounding.
constexpr double kInside = 1e-5;
// Of a direction's norm in the sampled rows: less than this outside of the others' is too little to tell it
// by, and what it would be multiplied by is mostly noise.
constexpr double kUnseen = 1e-2;
// Of what the sampled rows would see of a direction that is spread evenly over all rows: one of which they
// see less lies in a few rows that are not sampled, and these would be foretold by a multiple of next to
// nothing.
constexpr double kLeastSeen = 0.3;
constexpr double kSelfForetold = 1e-5;

// Single precision: vectors are orthogonalized twice, and what is left of one is compared with far more than
// its rounding.
Eigen::Map<const Eigen::VectorXf> vector(const float* x, std::size_t n) {
  return {x, static_cast<Eigen::Index>(n)};
}
double inner(const float* a, const float* b, std::size_t n) {
  return static_cast<double>(vector(a, n).dot(vector(b, n)));
}

// y += factor · x
void add_scaled(float factor, const float* x, float* y, std::size_t n) {
  Eigen::Map<Eigen::VectorXf>(y, static_cast<Eigen::Index>(n)) += factor * vector(x, n);
}

// Of a positive definite matrix of few rows, in place: Gauss and Jordan without pivots.
void invert_positive(std::vector<double>& m, std::size_t n) {
  for (std::size_t p = 0; p < n; ++p) {
    const double pivot = m[p * n + p];
    m[p * n + p] = 1;
    for (std::size_t j = 0; j < n; ++j) m[p * n + j] /= pivot;
    for (std::size_t i = 0; i < n; ++i) {
      if (i == p) continue;
      const double factor = m[i * n + p];
      m[i * n + p] = 0;
      for (std::size_t j = 0; j < n; ++j) m[i * n + j] -= factor * m[p * n + j];
    }
  }
}

}  // namespace

void ColumnSpace::begin(std::size_t rows, std::size_t width) {
  width_ = width, length_ = rows * width, rank_ = 0, factored_ = 0;
  basis_.clear(), rows_.clear(), q_.clear(), r_.clear(), seen_.clear(), leverage_.clear(), open_.clear();
}

void ColumnSpace::add(std::span<const float> column, std::vector<float>& coordinates) {
  coordinates.assign(rank_, 0.0f);
  basis_.insert(basis_.end(), column.begin(), column.end());
  float* rest = basis_.data() + rank_ * length_;
  const double size = std::sqrt(inner(rest, rest, length_));
  // All directions at once, so that the basis is read by blocks; what rounding leaves goes in the second
  // pass.
  const Eigen::Map<const Eigen::MatrixXf> basis(basis_.data(), static_cast<Eigen::Index>(length_),
                                                static_cast<Eigen::Index>(rank_));
  Eigen::Map<Eigen::VectorXf> remainder(rest, static_cast<Eigen::Index>(length_));
  Eigen::Map<Eigen::VectorXf> shares(coordinates.data(), static_cast<Eigen::Index>(rank_));
  for (int pass = 0; pass < 2 && rank_ > 0; ++pass) {
    const Eigen::VectorXf share = basis.transpose() * remainder;
    remainder.noalias() -= basis * share;
    shares += share;
  }
  const double left = std::sqrt(inner(rest, rest, length_));
  if (!(left > kInside * size)) {
    basis_.resize(rank_ * length_);
    return;
  }
  const auto scale = static_cast<float>(1 / left);
  for (std::size_t k = 0; k < length_; ++k) rest[k] *= scale;
  coordinates.push_back(static_cast<float>(left));
  ++rank_;
}

void ColumnSpace::sample(std::span<const std::uint32_t> rows) {
  rows_.assign(rows.begin(), rows.end());
  factored_ = 0;
  q_.clear(), r_.clear(), seen_.clear();
  leverage_.assign(rows.size() * width_ * width_, 0.0f);
}

// Appends the directions that are new to the QR factors of the sampled part of the basis.
void ColumnSpace::factor() {
  if (factored_ == rank_ && !open_.empty()) return;
  const std::size_t n = rows_.size() * width_;
  q_.resize(rank_ * n), seen_.resize(rank_, 0), r_.resize(rank_);
  const double least = kLeastSeen * std::sqrt(static_cast<double>(n) / static_cast<double>(length_));
  for (std::size_t d = factored_; d < rank_; ++d) {
    float* q = q_.data() + d * n;
    const float* direction = basis_.data() + d * length_;
    for (std::size_t a = 0; a < rows_.size(); ++a)
      std::copy_n(direction + rows_[a] * width_, width_, q + a * width_);
    r_[d].assign(d + 1, 0.0f);
    const double size = std::sqrt(inner(q, q, n));
    for (int pass = 0; pass < 2; ++pass)
      for (std::size_t e = 0; e < d; ++e) {
        if (!seen_[e]) continue;
        const float* other = q_.data() + e * n;
        const auto share = static_cast<float>(inner(other, q, n));
        add_scaled(-share, other, q, n);
        r_[d][e] += share;
      }
    const double left = std::sqrt(inner(q, q, n));
    if (!(left > std::max(kUnseen * size, least))) {
      std::fill_n(q, n, 0.0f);
      continue;
    }
    seen_[d] = 1;
    r_[d][d] = static_cast<float>(left);
    const auto scale = static_cast<float>(1 / left);
    for (std::size_t k = 0; k < n; ++k) q[k] *= scale;
    for (std::size_t a = 0; a < rows_.size(); ++a)
      for (std::size_t i = 0; i < width_; ++i)
        for (std::size_t j = 0; j < width_; ++j)
          leverage_[(a * width_ + i) * width_ + j] += q[a * width_ + i] * q[a * width_ + j];
  }
  factored_ = rank_;
  invert_leverages();
}

void ColumnSpace::invert_leverages() {
  // A row that is left out is off by (I − H)⁻¹ of its residual, H the block of Q·Qᵀ that belongs to it.
  const std::size_t size = width_ * width_;
  open_.resize(leverage_.size());
  std::vector<double> open(size);
  for (std::size_t a = 0; a < rows_.size(); ++a) {
    for (std::size_t k = 0; k < size; ++k) open[k] = -static_cast<double>(leverage_[a * size + k]);
    // A row without which a direction would not be seen foretells itself: as good as infinitely far off.
    for (std::size_t i = 0; i < width_; ++i) open[i * width_ + i] += 1 + kSelfForetold;
    invert_positive(open, width_);
    for (std::size_t k = 0; k < size; ++k) open_[a * size + k] = static_cast<float>(open[k]);
  }
}

ColumnSpace::Fit ColumnSpace::fit(std::span<const float> values, std::vector<float>& coordinates) {
  factor();
  const std::size_t n = values.size();
  Fit fit;
  fit.size = std::sqrt(inner(values.data(), values.data(), n));
  coordinates.assign(rank_, 0.0f);
  std::vector<float> rest(values.begin(), values.end());
  // Directions that are not seen have a q of zeros, and so a share of 0.
  const Eigen::Map<const Eigen::MatrixXf> q(q_.data(), static_cast<Eigen::Index>(n),
                                            static_cast<Eigen::Index>(rank_));
  Eigen::Map<Eigen::VectorXf> remainder(rest.data(), static_cast<Eigen::Index>(n));
  const Eigen::VectorXf shares = q.transpose() * remainder;
  remainder.noalias() -= q * shares;
  for (std::size_t d = rank_; d-- > 0;) {
    if (!seen_[d]) continue;
    double right = static_cast<double>(shares[static_cast<Eigen::Index>(d)]);
    for (std::size_t e = d + 1; e < rank_; ++e)
      right -= static_cast<double>(r_[e][d]) * static_cast<double>(coordinates[e]);
    coordinates[d] = static_cast<float>(right / static_cast<double>(r_[d][d]));
  }
  fit.residual = std::sqrt(inner(rest.data(), rest.data(), n));
  double left_out = 0;
  for (std::size_t a = 0; a < rows_.size(); ++a) {
    const float* open = open_.data() + a * width_ * width_;
    for (std::size_t i = 0; i < width_; ++i) {
      double off = 0;
      for (std::size_t j = 0; j < width_; ++j)
        off += static_cast<double>(open[i * width_ + j]) * static_cast<double>(rest[a * width_ + j]);
      left_out += off * off;
    }
  }
  fit.left_out = std::sqrt(left_out);
  return fit;
}

void ColumnSpace::combine(std::span<const float> coordinates, std::span<float> out) const {
  std::fill(out.begin(), out.end(), 0.0f);
  for (std::size_t d = 0; d < coordinates.size(); ++d)
    if (coordinates[d] != 0) add_scaled(coordinates[d], basis_.data() + d * length_, out.data(), length_);
}

}  // namespace lumirank::linalg
