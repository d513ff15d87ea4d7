#include "methods/common/slices/slice_lights.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/parallel.h"
#include "base/random.h"
#include "methods/common/column_clusters.h"
#include "methods/common/power_draws.h"
#include "methods/common/slices/slice_budget.h"
#include "methods/common/slices/slice_fields.h"
#include "methods/common/timed_choices.h"

namespace lumirank::methods {

using matrix::Index;
using matrix::ScaledColumn;

namespace {

constexpr std::size_t kSliceStretch = 4096;      // columns decoded at a time
constexpr float kMinEntry = 1e-17f;              // its square is a number still
constexpr float kNoSliceColor = 1e-3f;           // of the scalar norm: no color to scale
constexpr std::uint64_t kDrawings = 0x64726177;  // of keys
constexpr float kMaxSliceGain = 4;               // of a channel over the scalar factor

linalg::ColumnSketch::Shape sketch_shape(std::size_t columns, std::size_t slices, std::size_t projection) {
  if (projection == 0 || slices <= projection) return {columns, slices, false};
  return {columns, projection, true};
}

}  // namespace

const Fields<SliceLightSettings>& slice_light_fields() {
  using S = SliceLightSettings;
  static const Fields<S> fields{
      count_field<S>({"columns", "columns",
                      "Columns of a slice: clusters, each with one representative. Costs one entry per "
                      "receiver each; as many as there are columns is exact."},
                     &S::columns, 1, kMaxColumns),
      count_field<S>({"slice-rows", "rows",
                      "Receivers of a slice, at most; 0: as many as cost a slice's columns as much as its "
                      "row, one entry per column."},
                     &S::slice_rows, 0, kMaxRows),
      count_field<S>({"initial-clusters", "clusters",
                      "Of all columns by the rows of all slices, before slices split them further; 0: three "
                      "tenths of `columns`."},
                     &S::initial_clusters, 0, kMaxColumns),
      count_field<S>({"neighbors", "slices",
                      "Slices by whose rows one splits its clusters: the nearest, itself among them. Time of "
                      "the clustering is in proportion."},
                     &S::neighbors, 1, 1000),
      count_field<S>({"projection", "dimensions",
                      "Dimensions to which columns are projected for the clusters of all slices; 0: none."},
                     &S::projection, 0, 1000),
      choice_field<S>(
          {"color", "",
           "averaged: the representative gets its cluster's total color; scalar: one factor for all "
           "channels (unbiased)."},
          &S::color, {"averaged", "scalar"}),
      choice_field<S>({"zero-columns", "",
                       "Columns that are zero on all rows that a slice reads. sample: a few drawn by "
                       "power, unbiased; ignore: taken as zero in the slice (biased, less noise)."},
                      &S::zero_columns, {"sample", "ignore"}),
      number_field<S>(
          {"zero-share", "of columns", "How many of them are drawn, as a share of `columns`; at least one."},
          &S::zero_share, 0, 1),
      number_field<S>({"global-share", "",
                       "Share of the choice of representatives that goes by the rows of all slices "
                       "instead of by the slice's own few."},
                      &S::global_share, 0, 1),
      number_field<S>({"max-sum-share", "of the sum",
                       "A representative may not add more to a receiver than this share of the "
                       "greatest sum among the rows that its slice reads. Keeps specks away, and takes light "
                       "from receivers that are much brighter than those; 0: no bound, unbiased."},
                      &S::max_sum_share, 0, 1e9),
      slice_overlap_field<S>(&S::overlap)};
  return fields;
}

SliceLights::SliceLights(const matrix::LightingMatrix& matrix, const RunOptions& options,
                         const RunClock& clock, double row_seconds, const SliceLightSettings& settings,
                         std::span<Rgb> row_sum)
    : matrix_(matrix),
      settings_(with_slice_rows(settings, matrix, options, clock, row_seconds)),
      ids_(matrix.column_features().id),
      seed_(options.seed),
      turn_seed_(options.seed),
      slices_(make_slices(matrix.row_features(), matrix.rows(), settings_.slice_rows,
                          {static_cast<float>(settings.overlap), options.seed})),
      reduced_(matrix, sketch_shape(matrix.columns(), slices_.count(), settings.projection), options.seed),
      rows_(slices_.count(), matrix.columns()) {
  const double begin = clock.seconds();
  const bool all = read_rows(options, clock, row_sum);
  seconds_rows_ = clock.seconds() - begin;
  if (!all) return;
  find_neighbors();
  cluster();
  seconds_clustering_ = clock.seconds() - begin - seconds_rows_;
  ready_ = true;
}

bool SliceLights::read_rows(const RunOptions& options, const RunClock& clock, std::span<Rgb> row_sum) {
  std::vector<Rgb> values(matrix_.columns());
  std::vector<float> scalars(matrix_.columns());
  Rgb last(0);
  TimedChoices* choices = choices_of(options);
  const auto earlier =
      choices ? choices->earlier("slice_rows", static_cast<std::int64_t>(slices_.count())) : std::nullopt;
  std::size_t read = 0;
  for (std::size_t s = 0; s < slices_.count(); ++s) {
    const auto slice = slices_.slice(s);
    const bool late = earlier ? read >= static_cast<std::size_t>(*earlier)
                              : options.time_seconds > 0 && clock.seconds() > deadline_of(options);
    if (!late && !options.sinks.cancelled()) {
      ++read;
      Rng rng(seed_, Stage::method, 1, s);
      const double share = static_cast<double>(slice.size()) * static_cast<double>(slices_.count()) /
                           static_cast<double>(matrix_.rows());
      reduced_.read({slice[rng.next_below(slice.size())], static_cast<float>(std::sqrt(share))}, values);
      parallel_for(values.size(), kSliceStretch, [&](std::size_t begin, std::size_t end) {
        for (std::size_t j = begin; j < end; ++j) scalars[j] = norm2(values[j]);
      });
      rows_.set(s, scalars);
      last = reduced_.known().rows().back().sum;
      options.sinks.report("rows", static_cast<double>(s + 1) / static_cast<double>(slices_.count()));
    }
    for (const Index i : slice) row_sum[i] = last;
  }
  if (choices) choices->record("slice_rows", static_cast<std::int64_t>(read));
  return read == slices_.count() && !options.sinks.cancelled();
}

// Slices are few thousands: all pairs.
void SliceLights::find_neighbors() {
  const std::size_t count = slices_.count();
  const SlicePoints points(matrix_.row_features(), matrix_.rows());
  std::vector<SlicePoints::Point> center(count);
  parallel_for(count, 16, [&](std::size_t begin, std::size_t end) {
    for (std::size_t s = begin; s < end; ++s) {
      std::array<double, 6> sum{};
      for (const Index i : slices_.slice(s))
        for (std::size_t d = 0; d < sum.size(); ++d) sum[d] += static_cast<double>(points[i][d]);
      for (std::size_t d = 0; d < sum.size(); ++d)
        center[s][d] = static_cast<float>(sum[d] / static_cast<double>(slices_.slice(s).size()));
    }
  });
  neighbor_count_ = std::min(settings_.neighbors, count);
  neighbors_.resize(count * neighbor_count_);
  parallel_for(count, 16, [&](std::size_t begin, std::size_t end) {
    std::vector<std::pair<float, std::uint32_t>> near(count);
    for (std::size_t s = begin; s < end; ++s) {
      for (std::size_t t = 0; t < count; ++t) {
        float squared = 0;
        for (std::size_t d = 0; d < 6; ++d) squared += square(center[s][d] - center[t][d]);
        near[t] = {t == s ? -1.0f : squared, static_cast<std::uint32_t>(t)};
      }
      const auto last = near.begin() + static_cast<std::ptrdiff_t>(neighbor_count_);
      std::partial_sort(near.begin(), last, near.end());
      for (std::size_t k = 0; k < neighbor_count_; ++k) neighbors_[s * neighbor_count_ + k] = near[k].second;
    }
  });
}

void SliceLights::cluster() {
  const ClusterSettings settings;
  const ColumnClusters columns(matrix_, reduced_, settings, seed_);
  const std::size_t clusters = settings_.initial_clusters > 0
                                   ? std::min(settings_.initial_clusters, settings_.columns)
                                   : std::max<std::size_t>(settings_.columns * 3 / 10, 1);
  if (!columns.lit().empty())
    initial_ = columns.cluster(clusters, linalg::ClusteringAlgorithm::combined).partition();
  dark_.assign(columns.zero().begin(), columns.zero().end());
  rows_.permute(initial_.order);
  const linalg::ColumnSketch& sketch = reduced_.sketch();
  norms_.resize(matrix_.columns());
  parallel_for(norms_.size(), kSliceStretch, [&](std::size_t begin, std::size_t end) {
    for (std::size_t j = begin; j < end; ++j) {
      Norms& n = norms_[j];
      n.all = sketch.norm(j);
      for (std::size_t c = 0; c < 3; ++c) n.channel[c] = n.all > 0 ? sketch.channel_norm(j, c) / n.all : 0.0f;
    }
  });
}

// The columns as the slice's rows see them, cluster by cluster; apart from them those that are zero there.
void SliceLights::gather(std::size_t slice, Workspace& w) const {
  const std::size_t rows = neighbor_count_;
  w.splitter.clear(rows);
  w.zero.assign(dark_.begin(), dark_.end());
  w.entries.resize(rows * kSliceStretch);
  w.point.resize(rows);
  std::size_t cluster = 0;
  for (std::size_t begin = 0; begin < initial_.order.size(); begin += kSliceStretch) {
    const std::size_t size = std::min(kSliceStretch, initial_.order.size() - begin);
    for (std::size_t r = 0; r < rows; ++r)
      rows_.read(neighbors_[slice * rows + r], begin, std::span(w.entries).subspan(r * kSliceStretch, size));
    for (std::size_t k = 0; k < size; ++k) {
      if (begin + k == initial_.starts[cluster]) {
        w.splitter.begin_cluster();
        ++cluster;
      }
      float max_entry = 0;
      for (std::size_t r = 0; r < rows; ++r) {
        w.point[r] = w.entries[r * kSliceStretch + k] / static_cast<float>(r + 1);
        max_entry = std::max(max_entry, w.point[r]);
      }
      if (max_entry > kMinEntry)
        w.splitter.add(initial_.order[begin + k], w.point.data());
      else
        w.zero.push_back(initial_.order[begin + k]);
    }
  }
}

// q_j = (1 − share)·‖x_j‖/Σ‖x‖ + share·‖ρ_j‖/Σ‖ρ‖, x over the slice's rows and ρ over all; the sums are over
// all lit columns of the slice.
ScaledColumn SliceLights::draw(std::uint64_t key, std::size_t cluster, Workspace& w) const {
  const auto members = w.splitter.members(cluster);
  const auto norms = w.splitter.norms(cluster);
  const auto local = static_cast<float>((1 - settings_.global_share) / w.local_sum);
  const auto global = static_cast<float>(settings_.global_share / w.global_sum);
  w.chance.resize(members.size());
  double s = 0, energy = 0, channels[3] = {};
  for (std::size_t k = 0; k < members.size(); ++k) {
    const Norms& n = norms_[members[k]];
    w.chance[k] = local * norms[k] + global * n.all;
    s += static_cast<double>(w.chance[k]);
    energy += static_cast<double>(norms[k]);
    for (std::size_t c = 0; c < 3; ++c) channels[c] += static_cast<double>(norms[k] * n.channel[c]);
  }
  // The first of exponential arrivals, each keyed by its light: the same one in whatever order the members
  // are.
  double first = std::numeric_limits<double>::infinity();
  std::size_t chosen = members.size() - 1;
  for (std::size_t k = 0; k < members.size(); ++k) {
    if (!(w.chance[k] > 0)) continue;
    const double u = unit_double(mix64(key ^ mix64(matrix::id_of(ids_, members[k]))));
    const double arrival = -std::log1p(-u) / static_cast<double>(w.chance[k]);
    if (arrival < first) first = arrival, chosen = k;
  }
  const auto factor = static_cast<float>(s / static_cast<double>(w.chance[chosen]));
  ScaledColumn column{members[chosen], Rgb(factor)};
  if (settings_.color == ColorMode::averaged)
    for (std::size_t c = 0; c < 3; ++c) {
      const float own = norms_[members[chosen]].channel[c];
      if (own > kNoSliceColor)
        column.scale[static_cast<int>(c)] *=
            std::min(static_cast<float>(channels[c] / energy) / own, kMaxSliceGain);
    }
  return column;
}

void SliceLights::set_turn(std::size_t columns, std::uint64_t turn) {
  settings_.columns = std::max(columns, min_columns());
  turn_seed_ = turn == 0 ? seed_ : hash_ids(seed_, Stage::representatives, turn);
}

void SliceLights::choose(std::size_t slice, Workspace& w) const {
  w.chosen.clear();
  float max_sum = 0;
  for (std::size_t r = 0; r < neighbor_count_; ++r)
    max_sum = std::max(max_sum, norm2(known().rows()[neighbors_[slice * neighbor_count_ + r]].sum));
  w.max_added = static_cast<float>(settings_.max_sum_share) * max_sum;
  if (settings_.columns >= matrix_.columns()) {
    for (std::size_t j = 0; j < matrix_.columns(); ++j) w.chosen.push_back({static_cast<Index>(j)});
    return;
  }
  gather(slice, w);
  std::size_t& draws = w.zero_draws;
  draws = 0;
  if (settings_.zero_columns == ZeroColumns::sample && !w.zero.empty()) {
    draws =
        static_cast<std::size_t>(std::llround(settings_.zero_share * static_cast<double>(settings_.columns)));
    draws = std::clamp<std::size_t>(draws, 1, w.zero.size());
  }
  w.splitter.split_to(settings_.columns > draws ? settings_.columns - draws : 1, settings_.enough);
  w.local_sum = w.global_sum = 0;
  for (std::size_t k = 0; k < w.splitter.clusters(); ++k) {
    for (const float n : w.splitter.norms(k)) w.local_sum += static_cast<double>(n);
    for (const std::uint32_t j : w.splitter.members(k)) w.global_sum += static_cast<double>(norms_[j].all);
  }
  redraw(slice, 0, w);
}

void SliceLights::redraw(std::size_t slice, std::uint64_t drawing, Workspace& w) const {
  if (settings_.columns >= matrix_.columns()) return;  // all of them
  const std::uint64_t seed =
      drawing == 0 ? turn_seed_ : hash_ids(turn_seed_, Stage::representatives, kDrawings, drawing);
  const std::uint64_t key = hash_ids(seed, Stage::representatives, slice);
  w.chosen.clear();
  for (std::size_t k = 0; k < w.splitter.clusters(); ++k) w.chosen.push_back(draw(key, k, w));
  if (w.zero_draws == 0) return;
  const auto zero = draw_columns(w.zero, matrix_.column_features().power,
                                 {w.zero_draws, true, seed, Stage::zero_columns, slice});
  w.chosen.insert(w.chosen.end(), zero.begin(), zero.end());
}

std::size_t SliceLights::memory_bytes() const {
  return rows_.memory_bytes() + norms_.size() * sizeof(Norms) + initial_.order.size() * sizeof(std::uint32_t);
}

}  // namespace lumirank::methods
