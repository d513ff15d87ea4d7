#include "study/sampled_truth.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "base/error.h"
#include "base/random.h"

namespace lumirank::study {
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

SampledTruth::SampledTruth(const matrix::LightingMatrix& matrix, const Film& film, std::size_t count,
                           std::uint64_t seed, const Sinks& sinks) {
  const std::size_t n = matrix.rows();
  count = std::min(count, n);
  if (count == 0)
    throw InputError("no receiver is seen, so there is nothing to compare", "check the scene's camera");
  // Rows in the order of pixels: in media those of a pixel are not all in a stretch.
  const auto pixel_of = [&](matrix::Index row) { return film.samples[row] / film.per_pixel; };
  std::vector<matrix::Index> order(n);
  std::iota(order.begin(), order.end(), matrix::Index{0});
  std::ranges::stable_sort(order, {}, pixel_of);
  const auto pixel = [&](std::size_t i) { return pixel_of(order[i]); };
  std::vector<Rgb> row(matrix.columns());
  Rng rng(seed, Stage::benchmark, 3);
  const std::size_t strata = (count + film.per_pixel - 1) / film.per_pixel;
  std::size_t next = 0;  // first row after the last pixel taken
  for (std::size_t k = 0; k < strata; ++k) {
    const double at = (static_cast<double>(k) + rng.next_double()) / static_cast<double>(strata);
    auto i = std::min(n - 1, static_cast<std::size_t>(at * static_cast<double>(n)));
    while (i > 0 && pixel(i - 1) == pixel(i)) --i;
    if (i < next) continue;  // its pixel is known by now
    double sum[3] = {0, 0, 0};
    first_.push_back(static_cast<std::uint32_t>(rows_.size()));
    for (next = i; next < n && pixel(next) == pixel(i); ++next) {
      if (sinks.cancelled()) throw Cancelled();
      matrix.row(order[next], row);
      const Rgb weight = film.weights[order[next]];
      for (const Rgb& a : row)
        for (int c = 0; c < 3; ++c) sum[c] += static_cast<double>(a[c]) * static_cast<double>(weight[c]);
      rows_.push_back(order[next]);
      weights_.push_back(weight);
    }
    truth_.push_back({static_cast<float>(sum[0]), static_cast<float>(sum[1]), static_cast<float>(sum[2])});
    sinks.report("reference", static_cast<double>(k + 1) / static_cast<double>(strata));
  }
  first_.push_back(static_cast<std::uint32_t>(rows_.size()));
}

SampledTruth::Error SampledTruth::error_of(std::span<const Rgb> sums) const {
  // Interleaved groups: each is spread over the whole image.
  constexpr std::size_t kGroups = 32;
  Moments all, groups[kGroups];
  double relative_squared = 0, mean = 0;
  for (const Rgb& t : truth_) mean += static_cast<double>(t.r) + t.g + t.b;
  mean /= 3.0 * static_cast<double>(truth_.size());
  for (std::size_t k = 0; k < truth_.size(); ++k) {
    Moments m;
    for (int c = 0; c < 3; ++c) {
      const double truth = truth_[k][c];
      double difference = -truth;
      for (std::uint32_t i = first_[k]; i < first_[k + 1]; ++i)
        difference += static_cast<double>(sums[rows_[i]][c]) * static_cast<double>(weights_[i][c]);
      m.absolute += std::abs(difference), m.difference += difference, m.squared += difference * difference;
      m.total += truth, m.total_squared += truth * truth;
      relative_squared += difference * difference / (truth * truth + 1e-4 * mean * mean);
    }
    for (Moments* into : {&all, &groups[k % kGroups]}) {
      into->absolute += m.absolute, into->difference += m.difference, into->squared += m.squared;
      into->total += m.total, into->total_squared += m.total_squared;
    }
  }
  const double entries = 3.0 * static_cast<double>(truth_.size());
  Error error;
  error.metrics.relative_l1 = all.l1();
  error.metrics.relative_l2 = all.l2();
  error.metrics.rmse = std::sqrt(all.squared / entries);
  error.metrics.relmse = relative_squared / entries;
  error.metrics.bias = all.difference / all.total;
  error.metrics.flip = std::numeric_limits<double>::quiet_NaN();  // it is of pictures, not of single pixels
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

}  // namespace lumirank::study
