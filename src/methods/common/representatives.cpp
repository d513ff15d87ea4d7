#include "methods/common/representatives.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "base/parallel.h"
#include "base/random.h"
#include "methods/common/power_draws.h"

namespace lumirank::methods {

namespace {

constexpr double kNoColor = 1e-3;  // of the scalar norm: less than that is no color to scale
constexpr double kMaxGain = 4;     // of a channel over the scalar factor

// The cluster's color over the representative's, per channel.
Rgb color_gain(const linalg::ColumnSketch& sketch, std::span<const std::uint32_t> members, std::uint32_t j) {
  const double own = static_cast<double>(sketch.norm(j));
  double all = 0;
  for (std::uint32_t k : members) all += static_cast<double>(sketch.norm(k));
  Rgb gain(1);
  for (std::size_t c = 0; c < 3; ++c) {
    const double own_channel = static_cast<double>(sketch.channel_norm(j, c));
    if (own_channel <= kNoColor * own) continue;
    double all_channel = 0;
    for (std::uint32_t k : members) all_channel += static_cast<double>(sketch.channel_norm(k, c));
    gain[static_cast<int>(c)] =
        static_cast<float>(std::min((all_channel / own_channel) / (all / own), kMaxGain));
  }
  return gain;
}

template <typename T>
void permute(std::vector<T>& values, const std::vector<std::uint32_t>& order) {
  std::vector<T> next;
  next.reserve(values.size());
  for (std::uint32_t k : order) next.push_back(values[k]);
  values = std::move(next);
}

}  // namespace

std::vector<float> selection_weights(std::span<const matrix::Index> lit, const linalg::ColumnSketch& sketch,
                                     std::span<const float> power, double share) {
  std::vector<float> weights(sketch.columns(), 0.0f);
  double norms = 0, powers = 0;
  const auto power_of = [&](matrix::Index j) { return power.empty() ? 1.0 : static_cast<double>(power[j]); };
  for (matrix::Index j : lit) {
    norms += static_cast<double>(sketch.norm(j));
    powers += power_of(j);
  }
  if (powers == 0) share = 0;
  for (matrix::Index j : lit) {
    const double by_power = share > 0 ? share * power_of(j) / powers : 0.0;
    weights[j] = static_cast<float>((1 - share) * static_cast<double>(sketch.norm(j)) / norms + by_power);
  }
  return weights;
}

Representatives choose_representatives(const linalg::Partition& clusters, const linalg::ColumnSketch& sketch,
                                       std::span<const float> weights,
                                       const RepresentativeSettings& settings) {
  Representatives r;
  r.columns.resize(clusters.clusters());
  r.energy.resize(clusters.clusters());
  parallel_for(clusters.clusters(), 16, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      const auto members = clusters.members(k);
      double s = 0, energy = 0;
      for (std::uint32_t j : members) {
        s += static_cast<double>(weights[j]);
        energy += static_cast<double>(sketch.norm(j));
      }
      const std::uint64_t key = hash_ids(settings.seed, Stage::representatives, settings.round);
      double first = std::numeric_limits<double>::infinity();
      std::uint32_t chosen = members.back();
      for (std::uint32_t j : members) {
        if (!(weights[j] > 0)) continue;
        const double u = unit_double(mix64(key ^ mix64(matrix::id_of(settings.ids, j))));
        const double arrival = -std::log1p(-u) / static_cast<double>(weights[j]);
        if (arrival < first) first = arrival, chosen = j;
      }
      r.energy[k] = energy;
      const auto scalar = static_cast<float>(s / static_cast<double>(weights[chosen]));
      r.columns[k] = {
          chosen,
          settings.color == ColorMode::scalar ? Rgb(scalar) : color_gain(sketch, members, chosen) * scalar,
          settings.max_contribution};
    }
  });
  std::vector<std::uint32_t> order(r.columns.size());
  std::iota(order.begin(), order.end(), 0u);
  Rng rng(settings.seed, Stage::representatives, settings.round, ~std::uint64_t{0});
  for (std::size_t k = order.size(); k > 1; --k) std::swap(order[k - 1], order[rng.next_below(k)]);
  permute(r.columns, order);
  permute(r.energy, order);
  return r;
}

void add_zero_columns(std::span<const matrix::Index> zero, std::span<const float> power, std::size_t count,
                      const RepresentativeSettings& settings, Representatives& representatives) {
  auto drawn = draw_columns(
      zero, power, {std::min(count, zero.size()), true, settings.seed, Stage::zero_columns, settings.round});
  for (matrix::ScaledColumn& c : drawn) c.max_contribution = settings.max_contribution;
  representatives.columns.insert(representatives.columns.end(), drawn.begin(), drawn.end());
  representatives.energy.resize(representatives.columns.size(), 0.0);
  representatives.zero_columns += drawn.size();
}

}  // namespace lumirank::methods
