#include "methods/row_column/columns_known.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"

namespace lumirank::methods {

ColumnsKnown::ColumnsKnown(const matrix::LightingMatrix& matrix, Exploration& exploration,
                           const RowColumnSettings& settings, std::uint64_t seed)
    : matrix_(matrix),
      exploration_(exploration),
      settings_(settings),
      seed_(seed),
      points_(exploration.sketch().points()),
      power_share_(settings.power_share) {
  for (std::size_t j = 0; j < matrix.columns(); ++j)
    (exploration.sketch().is_zero(j) ? zero_ : lit_).push_back(static_cast<matrix::Index>(j));
  norms_ = linalg::own_norms(points_);
  weights_ =
      selection_weights(lit_, exploration.sketch(), matrix.column_features().power, settings.power_share);
}

linalg::Splitter ColumnsKnown::cluster(std::size_t columns, linalg::ClusteringAlgorithm algorithm) const {
  return linalg::cluster(points_, norms_, lit_, matrix_.column_features().group, {algorithm, columns, seed_});
}

namespace {
double square_of(std::span<const float> x) {
  double s = 0;
  for (float v : x) s += static_cast<double>(v) * static_cast<double>(v);
  return s;
}
}  // namespace

double ColumnsKnown::expected_square(const linalg::Partition& partition, const linalg::Points& points) const {
  return parallel_sum(partition.clusters(), 8, 0.0, [&](std::size_t begin, std::size_t end) {
    double sum = 0;
    for (std::size_t k = begin; k < end; ++k) {
      linalg::PointSum all(points.dimension);
      double squares_over_weights = 0;
      for (std::uint32_t j : partition.members(k)) {
        const double q = static_cast<double>(weights_[j]);
        all.add(points[j], q);
        squares_over_weights += square_of(points[j]) / q;
      }
      sum += std::max(0.0, all.weight * squares_over_weights - all.squared_length());
    }
    return sum;
  });
}

double ColumnsKnown::expected_error(const linalg::Splitter& clusters) const {
  if (exploration_.squared_sum() == 0) return 0;
  return std::sqrt(expected_square(clusters.partition(), points_) / exploration_.squared_sum());
}

double ColumnsKnown::expected_error(const linalg::Splitter& clusters, Exploration& unseen) const {
  if (unseen.squared_sum() == 0) return 0;
  const linalg::Points values = unseen.sketch().points();
  double error = expected_square(clusters.partition(), values);
  if (!zero_.empty()) {
    const auto power = matrix_.column_features().power;
    linalg::PointSum all(values.dimension);
    double total = 0, squares_over_powers = 0;
    for (matrix::Index j : zero_) {
      const double p = power.empty() ? 1.0 : static_cast<double>(power[j]);
      if (p <= 0) continue;
      total += p;
      all.add(values[j], 0);
      squares_over_powers += square_of(values[j]) / p;
    }
    if (settings_.zero_columns == ZeroColumns::ignore)
      error += all.squared_length();
    else
      error += std::max(0.0, total * squares_over_powers - all.squared_length()) /
               static_cast<double>(zero_draws(clusters.clusters()));
  }
  return std::sqrt(error / unseen.squared_sum());
}

void ColumnsKnown::tune_power_share(const linalg::Splitter& clusters, Exploration& unseen) {
  const auto power = matrix_.column_features().power;
  double least = expected_error(clusters, unseen);
  std::vector<float> best = weights_;
  for (double share : {0.0, 0.1, 0.3, 0.6}) {
    weights_ = selection_weights(lit_, exploration_.sketch(), power, share);
    const double error = expected_error(clusters, unseen);
    // Held-out rows are few: a gain must be clear to be one.
    if (error < 0.97 * least) {
      least = error;
      power_share_ = share;
      best = weights_;
    }
  }
  weights_ = std::move(best);
}

std::size_t ColumnsKnown::zero_draws(std::size_t columns) const {
  if (settings_.zero_columns == ZeroColumns::ignore) return 0;
  const auto wanted =
      static_cast<std::size_t>(std::llround(settings_.zero_share * static_cast<double>(columns)));
  return std::clamp<std::size_t>(wanted, std::min<std::size_t>(1, zero_.size()), zero_.size());
}

Representatives ColumnsKnown::choose(const linalg::Splitter& clusters, std::uint64_t round) const {
  const RepresentativeSettings choice{settings_.colour, seed_, round};
  Representatives chosen =
      choose_representatives(clusters.partition(), exploration_.sketch(), weights_, choice);
  add_zero_columns(zero_, matrix_.column_features().power, zero_draws(clusters.clusters()), choice, chosen);
  return chosen;
}

}  // namespace lumirank::methods
