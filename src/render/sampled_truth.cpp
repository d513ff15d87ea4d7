#include "render/sampled_truth.h"

#include <cmath>

#include "base/error.h"
#include "base/random.h"

namespace lumirank::rendering {
namespace {

// The sums that all metrics are made of.
struct Moments {
  double absolute = 0, difference = 0, squared = 0, total = 0, total_squared = 0;
  friend Moments operator-(const Moments& a, const Moments& b) {
    return {a.absolute - b.absolute, a.difference - b.difference, a.squared - b.squared, a.total - b.total,
            a.total_squared - b.total_squared};
  }
  double l1() const { return absolute / total; }
  double l2() const { return std::sqrt(squared / total_squared); }
};

}  // namespace

SampledTruth::SampledTruth(const matrix::LightingMatrix& matrix, std::span<const Rgb> weights,
                           std::size_t count, std::uint64_t seed, const Sinks& sinks) {
  count = std::min(count, matrix.rows());
  if (count == 0)
    throw InputError("no receiver is seen, so there is nothing to compare", "look at the scene's camera");
  std::vector<Rgb> row(matrix.columns());
  Rng rng(seed, Stage::benchmark, 3);
  for (std::size_t k = 0; k < count; ++k) {
    if (sinks.cancelled()) throw Cancelled();
    const double at = (static_cast<double>(k) + rng.next_double()) / static_cast<double>(count);
    const auto i =
        std::min(matrix.rows() - 1, static_cast<std::size_t>(at * static_cast<double>(matrix.rows())));
    matrix.row(static_cast<matrix::Index>(i), row);
    double r = 0, g = 0, b = 0;
    for (const Rgb& a : row) r += a.r, g += a.g, b += a.b;
    rows_.push_back(static_cast<matrix::Index>(i));
    weights_.push_back(weights[i]);
    truth_.push_back(Rgb(static_cast<float>(r), static_cast<float>(g), static_cast<float>(b)) * weights[i]);
    sinks.report("reference", static_cast<double>(k + 1) / static_cast<double>(count));
  }
}

SampledTruth::Error SampledTruth::error_of(std::span<const Rgb> sums) const {
  // Interleaved groups: each is spread over the whole image.
  constexpr std::size_t kGroups = 32;
  Moments all, groups[kGroups];
  double relative_squared = 0, mean = 0;
  for (const Rgb& t : truth_) mean += static_cast<double>(t.r) + t.g + t.b;
  mean /= 3.0 * static_cast<double>(truth_.size());
  for (std::size_t k = 0; k < rows_.size(); ++k) {
    Moments m;
    for (int c = 0; c < 3; ++c) {
      const double truth = truth_[k][c];
      const double difference = static_cast<double>(sums[rows_[k]][c]) * weights_[k][c] - truth;
      m.absolute += std::abs(difference), m.difference += difference, m.squared += difference * difference;
      m.total += truth, m.total_squared += truth * truth;
      relative_squared += difference * difference / (truth * truth + 1e-4 * mean * mean);
    }
    for (Moments* into : {&all, &groups[k % kGroups]}) {
      into->absolute += m.absolute, into->difference += m.difference, into->squared += m.squared;
      into->total += m.total, into->total_squared += m.total_squared;
    }
  }
  const double entries = 3.0 * static_cast<double>(rows_.size());
  Error error;
  error.metrics.relative_l1 = all.l1();
  error.metrics.relative_l2 = all.l2();
  error.metrics.rmse = std::sqrt(all.squared / entries);
  error.metrics.relmse = relative_squared / entries;
  error.metrics.bias = all.difference / all.total;
  double v1 = 0, v2 = 0;
  for (const Moments& group : groups) {
    const Moments without = all - group;
    v1 += (without.l1() - all.l1()) * (without.l1() - all.l1());
    v2 += (without.l2() - all.l2()) * (without.l2() - all.l2());
  }
  const double factor = (kGroups - 1.0) / kGroups;
  error.l1_half_width = 1.96 * std::sqrt(factor * v1);
  error.l2_half_width = 1.96 * std::sqrt(factor * v2);
  return error;
}

}  // namespace lumirank::rendering
