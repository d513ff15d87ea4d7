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
// Of one set of columns: what their expected square takes, per coordinate.
struct Spread {
  explicit Spread(std::size_t dimension) : sums(dimension, 0.0), squares(dimension, 0.0) {}
  void clear() {
    std::fill(sums.begin(), sums.end(), 0.0), std::fill(squares.begin(), squares.end(), 0.0);
    weight = 0;
  }
  void add(std::span<const float> x, double q) {
    for (std::size_t d = 0; d < sums.size(); ++d) {
      const double v = static_cast<double>(x[d]);
      sums[d] += v, squares[d] += v * v / q;
    }
    weight += q;
  }
  // Of one member drawn in proportion to q.
  double expected_square(std::size_t d) const {
    return std::max(0.0, weight * squares[d] - sums[d] * sums[d]);
  }
  std::vector<double> sums, squares;  // Σx, Σx²/q
  double weight = 0;
};

struct Squares {
  std::vector<double> v;
  Squares operator+(const Squares& o) const {
    Squares s = *this;
    for (std::size_t d = 0; d < s.v.size(); ++d) s.v[d] += o.v[d];
    return s;
  }
};
}  // namespace

std::vector<double> ColumnsKnown::expected_squares(const linalg::Partition& partition,
                                                   const linalg::Points& points) const {
  const Squares zero{std::vector<double>(points.dimension, 0.0)};
  return parallel_sum(partition.clusters(), 32, zero,
                      [&](std::size_t begin, std::size_t end) {
                        Squares all = zero;
                        Spread cluster(points.dimension);
                        for (std::size_t k = begin; k < end; ++k) {
                          cluster.clear();
                          for (std::uint32_t j : partition.members(k))
                            cluster.add(points[j], static_cast<double>(weights_[j]));
                          for (std::size_t d = 0; d < all.v.size(); ++d)
                            all.v[d] += cluster.expected_square(d);
                        }
                        return all;
                      })
      .v;
}

double ColumnsKnown::expected_error(const linalg::Splitter& clusters) const {
  if (exploration_.squared_sum() == 0) return 0;
  double sum = 0;
  for (double square : expected_squares(clusters.partition(), points_)) sum += square;
  return exploration_.l1_over_l2() * std::sqrt(sum / exploration_.squared_sum());
}

double ColumnsKnown::expected_error(const linalg::Splitter& clusters, Exploration& unseen) const {
  if (unseen.image_sum() == 0) return 0;
  const linalg::Points values = unseen.sketch().points();
  std::vector<double> squares = expected_squares(clusters.partition(), values);
  if (!zero_.empty()) {
    const auto power = matrix_.column_features().power;
    Spread all(values.dimension);
    for (matrix::Index j : zero_) {
      const double p = power.empty() ? 1.0 : static_cast<double>(power[j]);
      if (p > 0) all.add(values[j], p);
    }
    const bool ignored = settings_.zero_columns == ZeroColumns::ignore;
    const auto draws = static_cast<double>(std::max<std::size_t>(1, zero_draws(clusters.clusters())));
    for (std::size_t d = 0; d < squares.size(); ++d)
      squares[d] += ignored ? all.sums[d] * all.sums[d] : all.expected_square(d) / draws;
  }
  // Coordinates are rows, times their weights.
  double error = 0;
  for (std::size_t d = 0; d < squares.size(); ++d) {
    const KnownRow& row = unseen.known().rows()[d];
    error += row.share / static_cast<double>(row.from.weight) * std::sqrt(squares[d]);
  }
  return kMeanOfNormal * error / unseen.image_sum();
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
  const RepresentativeSettings choice{settings_.colour, seed_, round,
                                      static_cast<float>(settings_.most_shown)};
  Representatives chosen =
      choose_representatives(clusters.partition(), exploration_.sketch(), weights_, choice);
  add_zero_columns(zero_, matrix_.column_features().power, zero_draws(clusters.clusters()), choice, chosen);
  return chosen;
}

}  // namespace lumirank::methods
