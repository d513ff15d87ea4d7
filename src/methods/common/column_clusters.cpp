#include "methods/common/column_clusters.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"

namespace lumirank::methods {

ColumnClusters::ColumnClusters(const matrix::LightingMatrix& matrix, ReducedMatrix& reduced,
                               const ClusterSettings& settings, std::uint64_t seed)
    : matrix_(matrix),
      reduced_(reduced),
      settings_(settings),
      seed_(seed),
      points_(reduced.sketch().points()),
      power_share_(settings.power_share) {
  std::size_t lit = 0;
  for (std::size_t j = 0; j < matrix.columns(); ++j) lit += !reduced.sketch().is_zero(j);
  lit_.reserve(lit);
  zero_.reserve(matrix.columns() - lit);
  for (std::size_t j = 0; j < matrix.columns(); ++j)
    (reduced.sketch().is_zero(j) ? zero_ : lit_).push_back(static_cast<matrix::Index>(j));
  norms_ = linalg::own_norms(points_);
  weights_ = selection_weights(lit_, reduced.sketch(), matrix.column_features().power, settings.power_share);
}

linalg::Splitter ColumnClusters::cluster(std::size_t columns, linalg::ClusteringAlgorithm algorithm) const {
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
    const double inverse = 1 / q;
    for (std::size_t d = 0; d < sums.size(); ++d) {
      const double v = static_cast<double>(x[d]);
      sums[d] += v, squares[d] += v * v * inverse;
    }
    weight += q;
  }
  friend Spread operator+(Spread a, const Spread& b) {
    for (std::size_t d = 0; d < a.sums.size(); ++d) a.sums[d] += b.sums[d], a.squares[d] += b.squares[d];
    a.weight += b.weight;
    return a;
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

template <typename Reader>
std::vector<double> ColumnClusters::expected_squares(const linalg::Partition& partition,
                                                     std::size_t dimension, const Reader& reader) const {
  const Squares zero{std::vector<double>(dimension, 0.0)};
  return parallel_sum(partition.clusters(), 32, zero,
                      [&](std::size_t begin, std::size_t end) {
                        Squares all = zero;
                        Spread cluster(dimension);
                        std::vector<float> x(dimension);
                        for (std::size_t k = begin; k < end; ++k) {
                          cluster.clear();
                          for (std::uint32_t j : partition.members(k)) {
                            reader(j, x.data());
                            cluster.add(x, static_cast<double>(weights_[j]));
                          }
                          for (std::size_t d = 0; d < dimension; ++d) all.v[d] += cluster.expected_square(d);
                        }
                        return all;
                      })
      .v;
}

template <typename Reader>
void ColumnClusters::add_zero_squares(std::size_t draws, std::size_t dimension, const Reader& reader,
                                      std::vector<double>& squares) const {
  const auto power = matrix_.column_features().power;
  const Spread all =
      parallel_sum(zero_.size(), 8192, Spread(dimension), [&](std::size_t begin, std::size_t end) {
        Spread some(dimension);
        std::vector<float> x(dimension);
        for (std::size_t k = begin; k < end; ++k) {
          const double p = power.empty() ? 1.0 : static_cast<double>(power[zero_[k]]);
          if (!(p > 0)) continue;
          reader(zero_[k], x.data());
          some.add(x, p);
        }
        return some;
      });
  const bool ignored = settings_.zero_columns == ZeroColumns::ignore;
  const auto count = static_cast<double>(std::max<std::size_t>(1, draws));
  for (std::size_t d = 0; d < dimension; ++d)
    squares[d] += ignored ? all.sums[d] * all.sums[d] : all.expected_square(d) / count;
}

double ColumnClusters::expected_error(const linalg::Splitter& clusters) const {
  if (reduced_.squared_sum() == 0) return 0;
  if (reduced_.kept().rows() > 0) return expected_error(clusters, reduced_.kept());
  const linalg::PointReader points(points_);
  double sum = 0;
  for (double square : expected_squares(clusters.partition(), points_.dimension,
                                        [&](std::uint32_t j, float*out) { points.read(j, out); }))
    sum += square;
  return reduced_.l1_over_l2() * std::sqrt(sum / reduced_.squared_sum());
}

double ColumnClusters::expected_error(const linalg::Splitter& clusters, const HeldOutRows& unseen) const {
  if (unseen.image_sum() == 0) return 0;
  constexpr std::size_t kRows = linalg::SampledRows::kBlockRows;
  const linalg::Partition partition = clusters.partition();
  std::vector<double> squares;
  for (std::size_t block = 0; block < unseen.entries().blocks(); ++block) {
    const auto reader = [&](std::uint32_t j, float* out) { unseen.entries().read(block, j, out); };
    std::vector<double> some = expected_squares(partition, kRows, reader);
    if (!zero_.empty()) add_zero_squares(zero_draws(clusters.clusters()), kRows, reader, some);
    squares.insert(squares.end(), some.begin(), some.end());
  }
  squares.resize(unseen.rows());
  // Coordinates are rows, times their weights.
  double error = 0;
  for (std::size_t d = 0; d < squares.size(); ++d) {
    const ExactRow& row = unseen.known().rows()[d];
    error += row.share / static_cast<double>(row.from.weight) * std::sqrt(squares[d]);
  }
  return kMeanOfNormal * error / unseen.image_sum();
}

void ColumnClusters::tune_power_share(const linalg::Splitter& clusters, const HeldOutRows& unseen) {
  const auto power = matrix_.column_features().power;
  double min_error = expected_error(clusters, unseen);
  for (double share : {0.0, 0.1, 0.3, 0.6}) {
    weights_ = selection_weights(lit_, reduced_.sketch(), power, share);
    const double error = expected_error(clusters, unseen);
    // Held-out rows are few: a gain must be clear to be one.
    if (error < 0.97 * min_error) {
      min_error = error;
      power_share_ = share;
    }
  }
  weights_ = selection_weights(lit_, reduced_.sketch(), power, power_share_);
}

std::size_t ColumnClusters::zero_draws(std::size_t columns) const {
  if (settings_.zero_columns == ZeroColumns::ignore) return 0;
  const auto wanted =
      static_cast<std::size_t>(std::llround(settings_.zero_share * static_cast<double>(columns)));
  return std::clamp<std::size_t>(wanted, std::min<std::size_t>(1, zero_.size()), zero_.size());
}

Representatives ColumnClusters::choose(const linalg::Splitter& clusters, std::uint64_t round) const {
  const RepresentativeSettings choice{settings_.color, seed_, round,
                                      static_cast<float>(settings_.max_contribution),
                                      matrix_.column_features().id};
  Representatives chosen = choose_representatives(clusters.partition(), reduced_.sketch(), weights_, choice);
  add_zero_columns(zero_, matrix_.column_features().power, zero_draws(clusters.clusters()), choice, chosen);
  return chosen;
}

}  // namespace lumirank::methods
