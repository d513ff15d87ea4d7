#include "methods/sampling_recovery/slice_recovery.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace lumirank::methods {

using linalg::Entry;
using matrix::Index;

RecoveryTally& RecoveryTally::operator+=(const RecoveryTally& o) {
  SliceTally::operator+=(o);
  seconds_separation += o.seconds_separation, seconds_correction += o.seconds_correction;
  corrected += o.corrected, uncertain += o.uncertain;
  rank += o.rank, iterations += o.iterations, converged += o.converged;
  converged_after.resize(std::max(converged_after.size(), o.converged_after.size()));
  for (std::size_t k = 0; k < o.converged_after.size(); ++k) converged_after[k] += o.converged_after[k];
  residual.resize(std::max(residual.size(), o.residual.size()));
  for (std::size_t k = 0; k < o.residual.size(); ++k) residual[k] += o.residual[k];
  prediction += o.prediction;
  return *this;
}

namespace {
bool guessed(Entry e) { return e == Entry::predicted_visible || e == Entry::predicted_hidden; }
}  // namespace

// The scalar reduced matrix, as if all were visible.
void SliceRecovery::assemble() {
  const std::size_t rows = entries().rows().size(), columns = clusters().size();
  e_.resize(rows * columns);
  for (std::size_t c = 0; c < columns; ++c) {
    const auto scalars = entries().scalars(clusters()[c].slot);
    const float scale = mean(clusters()[c].column.scale);
    float* const out = &e_[c * rows];
    for (std::size_t i = 0; i < rows; ++i) out[i] = scale * scalars[i];
  }
}

// Columns whose samples all agree are left as they are predicted: they tell nothing about the others.
void SliceRecovery::choose_separated() {
  separated_.clear();
  for (std::size_t c = 0; c < clusters().size(); ++c)
    if (prediction_.mixed(c)) separated_.push_back(static_cast<std::uint32_t>(c));
}

void SliceRecovery::separate() {
  if (!settings_.separation) return;
  choose_separated();
  const std::size_t rows = entries().rows().size(), columns = separated_.size();
  const bool shading = settings_.separated == RecoverySettings::Separated::shading;
  d_.resize(rows * columns);
  whole_.resize(rows * columns);
  separated_state_.resize(rows * columns);
  for (std::size_t k = 0; k < columns; ++k) {
    const std::size_t c = separated_[k];
    const auto known = slice_.entries().seen(clusters()[c].slot);
    const Entry* const state = &state_[c * rows];
    const float* const e = &e_[c * rows];
    for (std::size_t i = 0; i < rows; ++i) {
      const std::size_t at = k * rows + i;
      const bool visible =
          state[i] == Entry::exact ? known[i] == seen::kVisible : state[i] == Entry::predicted_visible;
      const float whole = shading ? e[i] : e[i] > 0 ? 1.0f : 0.0f;
      d_[at] = visible ? whole : 0.0f;
      whole_[at] = whole;
      separated_state_[at] = state[i];
    }
  }
  linalg::SeparationSettings s;
  s.max_rank = settings_.rank;
  s.iterations = settings_.iterations;
  s.constraint = settings_.constraint;
  s.fit = settings_.fit;
  separation_.run({rows, columns, d_, separated_state_, whole_}, s);
  tally_separation();
}

void SliceRecovery::tally_separation() {
  tally_.rank += separation_.rank();
  tally_.iterations += separation_.iterations();
  tally_.converged += separation_.converged() ? 1 : 0;
  const auto history = separation_.residuals();
  if (tally_.converged_after.size() <= settings_.iterations)
    tally_.converged_after.resize(settings_.iterations + 1);
  tally_.residual.resize(std::max(tally_.residual.size(), settings_.iterations));
  ++tally_.converged_after[history.size()];
  for (std::size_t k = 0; k < settings_.iterations && !history.empty(); ++k)
    tally_.residual[k] += history[std::min(k, history.size() - 1)];
}

// Entries whose neighborhood is full of errors that the separation found (section 6.2).
void SliceRecovery::request_where_dense() {
  if (!settings_.separation || !settings_.correction) return;
  const std::size_t rows = entries().rows().size(), columns = separated_.size();
  // Z ≠ 0, up to the rounding of equation 12: an error is all of an entry or nothing, so it counts from half
  // of one on. (What the soft threshold leaves of small differences would make five times as many entries
  // dense.)
  wrong_.resize(d_.size());
  const auto z = separation_.sparse();
  const float *const sparse = z.data(), *const all = whole_.data();
  const Entry* const state = separated_state_.data();
  std::uint8_t* const wrong = wrong_.data();
  for (std::size_t at = 0; at < wrong_.size(); ++at)
    wrong[at] =
        static_cast<std::uint8_t>((std::abs(sparse[at]) > 0.5f * all[at]) & (state[at] != Entry::free));
  density_.build(wrong_, rows, columns);
  const auto density = density_.density();
  const auto min_density = static_cast<float>(settings_.density);
  chosen_.resize(rows);
  for (std::size_t k = 0; k < columns; ++k) {
    const float* const dense = &density[k * rows];
    for (std::size_t i = 0; i < rows; ++i) chosen_[i] = dense[i] > min_density ? 1 : 0;
    request_chosen(separated_[k]);
  }
}

// Where a guess may cost much: it is expected to be wrong by 2p(1 − p)E.
void SliceRecovery::request_where_uncertain() {
  if (!settings_.prediction || settings_.uncertain <= 0) return;
  const std::size_t rows = entries().rows().size(), columns = clusters().size();
  const auto p = prediction_.probabilities();
  row_sums_.assign(rows, 0.0f);
  for (std::size_t c = 0; c < columns; ++c)
    for (std::size_t i = 0; i < rows; ++i) row_sums_[i] += e_[c * rows + i] * p[c * rows + i];
  for (float& sum : row_sums_) sum *= 0.5f * static_cast<float>(settings_.uncertain);
  chosen_.resize(rows);
  for (std::size_t c = 0; c < columns; ++c) {
    const float *const pc = &p[c * rows], *const e = &e_[c * rows], *const sums = row_sums_.data();
    for (std::size_t i = 0; i < rows; ++i) chosen_[i] = pc[i] * (1 - pc[i]) * e[i] > sums[i] ? 1 : 0;
    request_chosen(c);
  }
}

// Those of a column's guesses that are chosen_.
void SliceRecovery::request_chosen(std::size_t c) {
  const std::size_t rows = chosen_.size();
  const std::uint8_t* const first = chosen_.data();
  const auto from = [&](std::size_t i) {
    const void* const found = i < rows ? std::memchr(first + i, 1, rows - i) : nullptr;
    return found ? static_cast<std::size_t>(static_cast<const std::uint8_t*>(found) - first) : rows;
  };
  for (std::size_t i = from(0); i < rows; i = from(i + 1)) {
    const std::size_t at = c * rows + i;
    if (guessed(state_[at]) && slice_.entries().request(clusters()[c].slot, i))
      requested_.push_back(static_cast<std::uint32_t>(at));
  }
}

void SliceRecovery::resolve() {
  slice_.entries().resolve();
  for (const std::uint32_t at : requested_) state_[at] = Entry::exact;
  requested_.clear();
}

// What is known, and for the rest L/E; without separation the prediction.
void SliceRecovery::recover_visibility() {
  const std::size_t rows = entries().rows().size(), columns = clusters().size();
  const bool drawn = !settings_.separation && settings_.draw != RecoverySettings::Draw::mean;
  visibility_.resize(rows * columns);
  const auto p = prediction_.probabilities();
  std::size_t next = 0;  // of those that were separated
  for (std::size_t c = 0; c < columns; ++c) {
    const auto known = slice_.entries().seen(clusters()[c].slot);
    const std::size_t begin = c * rows;
    const Entry* const state = &state_[begin];
    const float* const predicted = &p[begin];
    float* const out = &visibility_[begin];
    if (settings_.separation && next < separated_.size() && separated_[next] == c) {
      const float *const e = &whole_[next * rows], *const l = &separation_.low_rank()[next * rows];
      for (std::size_t i = 0; i < rows; ++i) {
        const float share = l[i] / std::max(e[i], 1e-37f);
        out[i] = share < 0 ? 0.0f : share > 1 ? 1.0f : share;
      }
      ++next;
    } else if (drawn) {
      for (std::size_t i = 0; i < rows; ++i) out[i] = state[i] == Entry::predicted_visible ? 1.0f : 0.0f;
    } else {
      std::copy_n(predicted, rows, out);
    }
    for (std::size_t i = 0; i < rows; ++i) {
      const float exact = known[i] == seen::kVisible ? 1.0f : 0.0f;
      out[i] = state[i] == Entry::exact ? exact : state[i] == Entry::free ? predicted[i] : out[i];
    }
  }
}

void SliceRecovery::run(const RecoverySettings& settings, std::span<const Index> slice, std::uint64_t key,
                        std::span<Rgb> sums) {
  settings_ = settings;
  drawings_.run(settings_, slice, key, slice_, tally_, [&] { recover(key, sums); });
}

void SliceRecovery::recover(std::uint64_t key, std::span<Rgb> sums) {
  StepTimer timer;
  slice_.evaluate();
  tally_.seconds_splitting += timer.step();
  assemble();
  state_.resize(e_.size());
  prediction_.run(settings_, clusters(), e_, key, slice_.entries(), state_);
  request_where_uncertain();
  tally_.uncertain += requested_.size();
  resolve();
  tally_.prediction += prediction_.tally();
  tally_.seconds_visibility += timer.step();
  separate();
  tally_.seconds_separation += timer.step();
  request_where_dense();
  tally_.corrected += requested_.size();
  resolve();
  tally_.seconds_correction += timer.step();
  recover_visibility();
  slice_.gather(visibility_, sums);
  tally_.seconds_gather += timer.step();
  tally_.add(slice_);
}

}  // namespace lumirank::methods
