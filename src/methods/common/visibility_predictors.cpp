#include "methods/common/visibility_predictors.h"

// g++ 12 takes the undefined lanes inside its own AVX-512 intrinsics for uninitialized variables.
#include <algorithm>

#include "linalg/least_squares.h"

namespace lumirank::methods {

namespace {
float share_visible(int sum) {
  return sum >= seen::kHidden ? static_cast<float>(sum & 15) / static_cast<float>(sum >> 4) : 0.5f;
}
}  // namespace

float nearest_probability(const SampledNeighbors::Few& nearest, std::span<const std::uint8_t> seen_by_row) {
  int sum = 0;
  for (const std::uint32_t i : nearest)
    if (i != SampledNeighbors::kNone) sum += seen_by_row[i];
  return share_visible(sum);
}

void nearest_probabilities(std::span<const SampledNeighbors::Few> nearest,
                           std::span<const std::uint8_t> seen_by_row, std::span<float> out) {
  // With three samples or more, every point has three neighbors.
  if (nearest.empty() || nearest[0].back() == SampledNeighbors::kNone) {
    for (std::size_t i = 0; i < out.size(); ++i) out[i] = nearest_probability(nearest[i], seen_by_row);
    return;
  }
  std::array<float, 3 * seen::kVisible + 1> share;
  for (std::size_t s = 0; s < share.size(); ++s) share[s] = share_visible(static_cast<int>(s));
  for (std::size_t i = 0; i < out.size(); ++i) {
    const auto& n = nearest[i];
    out[i] = share[static_cast<std::size_t>(seen_by_row[n[0]] + seen_by_row[n[1]] + seen_by_row[n[2]])];
  }
}

SeparatingPlane SeparatingPlane::fit(std::span<const Vec3f> points, const ColumnSamples& samples) {
  PlaneSums sums;
  sums.add(points, samples);
  return sums.fit();
}

void PlaneSums::add(std::span<const Vec3f> points, const ColumnSamples& samples) {
  for (std::size_t k = 0; k < samples.rows.size(); ++k) {
    const Vec3f p = points[samples.rows[k]];
    const float x[4] = {p.x, p.y, p.z, 1};
    const float y = samples.visible[k] ? 1.0f : -1.0f;
    std::size_t at = 0;
    for (std::size_t a = 0; a < 4; ++a) {
      for (std::size_t b = a; b < 4; ++b) square_[at++] += x[a] * x[b];
      right_[a] += y * x[a];
    }
  }
}

SeparatingPlane PlaneSums::fit() const {
  SeparatingPlane plane;
  if (!(square_[9] > 0)) return plane;  // no sample
  plane.w = linalg::solve_regularized4(square_, right_, 1e-3f);
  return plane;
}

void SeparatingPlane::probabilities(std::span<const Vec3f> points, std::span<float> out) const {
  for (std::size_t i = 0; i < out.size(); ++i) out[i] = probability(points[i]);
}

void BayesCounts::reset(std::size_t rows, std::size_t columns) {
  stretches_ = (rows + kStretch - 1) / kStretch;
  columns_ = columns;
  seen_.assign(2 * stretches_ * columns_, 0);
  all_.assign(2 * columns_, 0);
}

void BayesCounts::add(std::size_t column, const ColumnSamples& samples) {
  std::uint16_t* const seen = &seen_[2 * stretches_ * column];
  for (std::size_t k = 0; k < samples.rows.size(); ++k) {
    const std::size_t v = samples.visible[k] ? 1 : 0;
    ++seen[2 * (samples.rows[k] / kStretch) + v];
    ++all_[2 * column + v];
  }
}

float BayesCounts::probability(std::size_t column, std::size_t stretch) const {
  // The five columns around it, fewer at the ends.
  const std::size_t begin = column < kColumns / 2 ? 0 : column - kColumns / 2;
  const std::size_t end = std::min(columns_, column + kColumns / 2 + 1);
  float likely[2];
  for (std::size_t v = 0; v < 2; ++v) {
    std::uint32_t here = 0, all = 0;
    for (std::size_t j = begin; j < end; ++j) {
      here += seen_[2 * (stretches_ * j + stretch) + v];
      all += all_[2 * j + v];
    }
    // The denominator of P(v) is the same for both.
    likely[v] =
        static_cast<float>(all + 1) * static_cast<float>(here + 1) / static_cast<float>(all + stretches_);
  }
  return likely[1] / (likely[0] + likely[1]);
}

void BayesCounts::probabilities(std::size_t column, std::span<float> out) const {
  for (std::size_t b = 0; b < stretches_; ++b) out[b] = probability(column, b);
}

void draw_visibility(std::span<const float> probability, std::uint32_t key, std::span<std::uint8_t> visible) {
  for (std::size_t i = 0; i < visible.size(); ++i) {
    // A 32-bit mix with full avalanche (the finaliser of MurmurHash3).
    auto x = static_cast<std::uint32_t>(i) * 0x9e3779b9u ^ key;
    x = (x ^ (x >> 16)) * 0x85ebca6bu;
    x = (x ^ (x >> 13)) * 0xc2b2ae35u;
    x ^= x >> 16;
    visible[i] = static_cast<float>(static_cast<std::int32_t>(x >> 8)) * 0x1p-24f < probability[i] ? 1 : 0;
  }
}

}  // namespace lumirank::methods
