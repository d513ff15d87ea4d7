#include "methods/sampling_recovery/prediction.h"

#include <algorithm>
#include <cmath>

#include "base/random.h"
#include "linalg/fixed_sums.h"

namespace lumirank::methods {

using linalg::Entry;

namespace {
constexpr std::size_t kRoundsWithoutPrediction = 5;
}

PredictionTally& PredictionTally::operator+=(const PredictionTally& o) {
  for (std::size_t k = 0; k < chosen.size(); ++k) chosen[k] += o.chosen[k];
  failed += o.failed;
  error += o.error;
  rounds += o.rounds;
  return *this;
}

// Column c's predictors learn of samples begin … end − 1 of its pattern, where they are known.
void Prediction::learn(std::size_t c, std::size_t begin, std::size_t end, SliceEntries& entries) {
  Column& column = columns_[c];
  const auto order = entries.patterns().order(entries.slot(column.slot).pattern);
  const auto known = entries.seen(column.slot);
  sample_rows_.clear();
  sample_visible_.clear();
  for (std::size_t k = begin; k < end; ++k) {
    if (known[order[k]] == seen::kUnknown) continue;
    sample_rows_.push_back(order[k]);
    sample_visible_.push_back(known[order[k]] == seen::kVisible ? 1 : 0);
  }
  column.known += static_cast<std::uint32_t>(sample_rows_.size());
  for (const std::uint8_t v : sample_visible_) column.visible += v;
  counts_.add(c, {sample_rows_, sample_visible_});
  column.plane.add(entries.rows().points(), {sample_rows_, sample_visible_});
}

// Tests what was trained on the first samples of column c by those that came since. True if the best
// predictor is good enough.
bool Prediction::validate(const RecoverySettings& settings, std::size_t c, std::span<const float> e,
                          SliceEntries& entries) {
  using Predictors = RecoverySettings::Predictors;
  Column& column = columns_[c];
  const SliceEntries::Slot& slot = entries.slot(column.slot);
  const auto order = entries.patterns().order(slot.pattern);
  const auto known = entries.seen(column.slot);
  const auto neighbors =
      entries.patterns().nearest_of_next(slot.pattern, column.trained, slot.sampled - column.trained);
  const SeparatingPlane fitted = column.plane.fit();
  std::array<float, 3> wrong{};
  column.tested = Calibration::kind_of(column.known, column.visible);
  float tests = 0;
  for (std::size_t k = column.trained; k < slot.sampled; ++k) {
    const std::uint32_t row = order[k];
    if (known[row] == seen::kUnknown) continue;
    const float v = known[row] == seen::kVisible ? 1.0f : 0.0f;
    const std::array<float, 3> p{nearest_probability(neighbors[k - column.trained], known),
                                 fitted.probability(entries.rows().points()[row]),
                                 counts_.probability(c, row / BayesCounts::kStretch)};
    const double light = static_cast<double>(e[c * entries.rows().size() + row]) /
                         static_cast<double>(slot.sampled - column.trained);
    for (std::size_t kind = 0; kind < p.size(); ++kind) {
      wrong[kind] += std::abs(v - p[kind]);
      calibration_.add(kind, column.tested, p[kind], v > 0, light);
    }
    ++tests;
  }
  const bool whole = slot.sampled == order.size();
  if (tests == 0) return whole;
  if (settings.predictors == Predictors::all)
    column.best = static_cast<Kind>(std::min_element(wrong.begin(), wrong.end()) - wrong.begin());
  else
    column.best = static_cast<Kind>(static_cast<std::size_t>(settings.predictors) - 1);
  column.error = wrong[column.best] / tests;
  return whole || column.error < column.allowed;
}

// By the column's predictor, trained on all its samples.
void Prediction::predict(std::size_t c, SliceEntries& entries, std::span<float> out) {
  const Column& column = columns_[c];
  const SliceEntries::Slot& slot = entries.slot(column.slot);
  switch (column.best) {
    case nearest:
      nearest_probabilities(entries.patterns().nearest(slot.pattern, slot.sampled), entries.seen(column.slot),
                            out);
      break;
    case plane:
      column.plane.fit().probabilities(entries.rows().points(), out);
      break;
    case bayes:
      counts_.probabilities(c, stretch_probability_);
      for (std::size_t i = 0; i < out.size(); ++i) out[i] = stretch_probability_[i / BayesCounts::kStretch];
      break;
  }
}

void Prediction::fill(const RecoverySettings& settings, std::uint64_t key, std::span<const float> e,
                      SliceEntries& entries, std::span<Entry> state) {
  const std::size_t rows = entries.rows().size();
  probabilities_.resize(rows * columns_.size());
  drawn_.resize(rows);
  for (std::size_t c = 0; c < columns_.size(); ++c) {
    const auto known = entries.seen(columns_[c].slot);
    const auto probability = std::span(probabilities_).subspan(c * rows, rows);
    if (!settings.prediction) {
      std::ranges::fill(probability, 1.0f);
      std::ranges::fill(drawn_, std::uint8_t{1});
    } else {
      predict(c, entries, probability);
      if (settings.calibration) calibration_.apply(columns_[c].best, columns_[c].tested, probability);
      if (settings.draw == RecoverySettings::Draw::likely)
        for (std::size_t i = 0; i < rows; ++i) drawn_[i] = probability[i] > 0.5f ? 1 : 0;
      else
        draw_visibility(
            probability,
            static_cast<std::uint32_t>(mix64(key ^ entries.bits(entries.slot(columns_[c].slot).column))),
            drawn_);
    }
    const float* const reach = &e[c * rows];
    Entry* const out = &state[c * rows];
    for (std::size_t i = 0; i < rows; ++i) {
      const Entry guess = drawn_[i] ? Entry::predicted_visible : Entry::predicted_hidden;
      const Entry known_or_guess = known[i] != seen::kUnknown ? Entry::exact : guess;
      out[i] = reach[i] > 0 ? known_or_guess : Entry::free;
      if (known[i] != seen::kUnknown) probability[i] = known[i] == seen::kVisible ? 1.0f : 0.0f;
    }
  }
}

void Prediction::run(const RecoverySettings& settings, std::span<const ReducedColumn> clusters,
                     std::span<const float> e, std::uint64_t key, SliceEntries& entries,
                     std::span<Entry> state) {
  const std::size_t rows = entries.rows().size();
  const std::size_t samples = settings.samples(rows);
  tally_ = {};
  calibration_.reset();
  counts_.reset(rows, clusters.size());
  stretch_probability_.resize(counts_.stretches());
  columns_.clear();
  active_.clear();
  // A wrong entry of a bright column costs more: so that all columns may bring as much error, the brighter
  // ones may be wrong so much less often.
  double sum = 0;
  column_sums_.resize(clusters.size());
  for (std::size_t c = 0; c < clusters.size(); ++c) {
    column_sums_[c] = static_cast<double>(linalg::fixed_sum(&e[c * rows], rows));
    sum += column_sums_[c];
  }
  for (std::size_t c = 0; c < clusters.size(); ++c) {
    columns_.push_back({clusters[c].slot});
    Column& column = columns_.back();
    const double own = column_sums_[c];
    const double brighter = sum > 0 ? own / sum * static_cast<double>(clusters.size()) : 0;
    column.allowed =
        static_cast<float>(settings.prediction_error / (settings.weighted ? std::max(brighter, 1.0) : 1.0));
    const bool whole = settings.bright > 0 && own > settings.bright * sum;
    if (whole) entries.sample_all(column.slot);
    column.trained = entries.slot(column.slot).sampled;
    learn(c, 0, column.trained, entries);
    if (!whole) active_.push_back(static_cast<std::uint32_t>(c));
  }
  const std::size_t rounds = settings.prediction ? settings.rounds : kRoundsWithoutPrediction;
  for (std::size_t round = 0; round < rounds && !active_.empty(); ++round) {
    for (const std::uint32_t c : active_) entries.request_next(columns_[c].slot, samples);
    entries.resolve();
    tally_.rounds += active_.size();
    still_active_.clear();
    if (settings.prediction) {
      for (const std::uint32_t c : active_)
        if (!validate(settings, c, e, entries)) still_active_.push_back(c);
    } else {
      still_active_ = active_;
    }
    // All have been tested on what this round brought; now they learn from it.
    for (const std::uint32_t c : active_) {
      Column& column = columns_[c];
      learn(c, column.trained, entries.slot(column.slot).sampled, entries);
      column.trained = entries.slot(column.slot).sampled;
    }
    std::swap(active_, still_active_);
  }
  if (settings.prediction) {
    tally_.failed = active_.size();
    for (const Column& column : columns_)
      ++tally_.chosen[column.best], tally_.error += static_cast<double>(column.error);
  }
  calibration_.finish();
  fill(settings, key, e, entries, state);
}

}  // namespace lumirank::methods
