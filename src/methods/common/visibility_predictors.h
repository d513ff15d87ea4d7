// Guesses of a column's visibility from few samples of it (Huo et al. 2015, section 5.1). All give the
// probability that a point is visible; drawing from it keeps the errors without structure.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "base/vec.h"
#include "methods/common/hilbert_neighbors.h"

namespace lumirank::methods {

// Samples of one column: which rows, and whether each is visible.
struct ColumnSamples {
  std::span<const std::uint32_t> rows;
  std::span<const std::uint8_t> visible;
};

// What a byte says of a row's visibility. A sum of up to 15 of them tells how many are known (its upper four
// bits) and how many are visible (its lower).
namespace seen {
inline constexpr std::uint8_t kUnknown = 0, kHidden = 16, kVisible = 17;
}

// k nearest neighbors: one of the nearest sampled points, drawn at random, has the answer; so the
// probability is the mean of those that are known, ½ if none is.
float nearest_probability(const SampledNeighbors::Few& nearest, std::span<const std::uint8_t> seen_by_row);
void nearest_probabilities(std::span<const SampledNeighbors::Few> nearest,
                           std::span<const std::uint8_t> seen_by_row, std::span<float> out);

// A plane through space between what is lit and what is not: least squares of ±1 over homogeneous
// coordinates, with 10⁻³ of their mean square as regularization, because points may all lie in a plane.
// (Equation 9 should read W = (XᵀX)⁻¹XᵀY, and equation 10 P(V = 1) = clamp(½ + f/2, 0, 1), for then f = 1
// means surely visible.)
struct SeparatingPlane {
  std::array<float, 4> w{};

  // `points` in units in which they spread about 1 around 0.
  static SeparatingPlane fit(std::span<const Vec3f> points, const ColumnSamples& samples);
  float probability(Vec3f p) const {
    const float f = w[0] * p.x + w[1] * p.y + w[2] * p.z + w[3];
    const float half = 0.5f + 0.5f * f;
    return half < 0 ? 0.0f : half > 1 ? 1.0f : half;
  }
  void probabilities(std::span<const Vec3f> points, std::span<float> out) const;
};

// The same as samples come: sums of products, so that each sample is read once.
class PlaneSums {
 public:
  void add(std::span<const Vec3f> points, const ColumnSamples& samples);
  SeparatingPlane fit() const;

 private:
  std::array<float, 10> square_{};  // upper triangle of XᵀX, row after row
  std::array<float, 4> right_{};    // XᵀY
};

// Naive Bayes over five columns side by side: P(v | i) ∝ P(v) P(i | v), where the feature i is the stretch of
// 16 rows that row i lies in (rows must be in an order in which neighbors are near); Laplace-smoothed.
class BayesCounts {
 public:
  static constexpr std::size_t kStretch = 16, kColumns = 5;

  void reset(std::size_t rows, std::size_t columns);
  void add(std::size_t column, const ColumnSamples& samples);
  // P(v = 1) in a stretch, from the samples of the columns around `column`.
  float probability(std::size_t column, std::size_t stretch) const;
  // The same for all stretches.
  void probabilities(std::size_t column, std::span<float> out) const;
  std::size_t stretches() const { return stretches_; }

 private:
  std::size_t stretches_ = 0, columns_ = 0;
  std::vector<std::uint16_t> seen_;  // columns × stretches × {hidden, visible}
  std::vector<std::uint32_t> all_;   // columns × {hidden, visible}
};

// visible[i] = u(i) < probability[i], u uniform by a hash of (key, i).
void draw_visibility(std::span<const float> probability, std::uint32_t key, std::span<std::uint8_t> visible);

}  // namespace lumirank::methods
