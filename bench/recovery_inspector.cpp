#include "recovery_inspector.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/parallel.h"
#include "base/random.h"

namespace lumirank::bench {

using linalg::Entry;
using matrix::Index;
using matrix::Part;
using methods::RecoverySettings;

RecoveryInspector::RecoveryInspector(const InspectOptions& options, const matrix::LightingMatrix& matrix)
    : options_(options),
      settings_(methods::read_settings("sampling-recovery", methods::recovery_fields(), options.settings)),
      matrix_(matrix),
      tree_(matrix, options.seed),
      slices_(methods::make_slices(matrix.row_features(), matrix.rows(),
                                   methods::max_slice_receivers(matrix, settings_.slice_rows, false))),
      sums_(matrix.rows()),
      pool_([this] {
        return std::make_unique<Workspace>(
            Workspace{methods::SliceRecovery(tree_, matrix_), matrix_.reader(), {}, {}, {}, {}, {}, {}, {}});
      }) {}

// Predictors as the only step.
RecoverySettings RecoveryInspector::alone(std::size_t predictor, bool equal) const {
  RecoverySettings s = settings_;
  s.separation = s.correction = false;
  s.uncertain = 0;
  constexpr std::array kinds{RecoverySettings::Predictors::nearest, RecoverySettings::Predictors::plane,
                             RecoverySettings::Predictors::bayes, RecoverySettings::Predictors::all};
  s.predictors = kinds[predictor];
  if (equal) s.prediction_error = 0, s.rounds = 5;
  return s;
}

void RecoveryInspector::run(const RecoverySettings& settings, std::size_t s, Workspace& w) {
  w.recovery.run(settings, slices_.slice(s), methods::slice_key(options_.seed, s), sums_);
}

void RecoveryInspector::inspect() {
  findings_.resize(slices_.count());
  parallel_for(slices_.count(), 1, [&](std::size_t s, std::size_t) {
    methods::WorkspacePool<Workspace>::Lease lease(pool_);
    inspect_slice(s, *lease);
  });
}

// All visibilities of the reduced matrix, each from where the method would sample; kNothing where E is 0.
void RecoveryInspector::find_truth(Workspace& w) const {
  const auto& entries = w.recovery.entries();
  const std::size_t rows = entries.rows().size(), columns = w.recovery.clusters().size();
  w.truth.assign(rows * columns, kNothing);
  w.reader->set_rows(entries.rows().receivers());
  for (std::size_t c = 0; c < columns; ++c) {
    const auto& cluster = w.recovery.clusters()[c];
    w.places.clear();
    for (std::size_t i = 0; i < rows; ++i)
      if (w.recovery.unoccluded()[c * rows + i] > 0) w.places.push_back(entries.place(cluster.slot, i));
    w.columns.assign(w.places.size(), cluster.column.column);
    w.answers.resize(w.places.size());
    w.reader->entries_at(w.places, w.columns, w.answers, Part::visibility);
    std::size_t k = 0;
    for (std::size_t i = 0; i < rows; ++i)
      if (w.recovery.unoccluded()[c * rows + i] > 0)
        w.truth[c * rows + i] = w.answers[k++].r > 0.5f ? 1.0f : 0.0f;
  }
}

void RecoveryInspector::judge(std::size_t s, Workspace& w, const RecoverySettings& settings, Predicted& out) {
  const auto before = w.recovery.tally();
  run(settings, s, w);
  const auto& after = w.recovery.tally();
  const auto states = w.recovery.states();
  if (states.size() != w.truth.size()) throw InternalError("the clusters depend on the predictor");
  for (std::size_t at = 0; at < states.size(); ++at) {
    if (states[at] == Entry::exact) out.sampled += 1;
    if (states[at] == Entry::exact || states[at] == Entry::free) continue;
    const bool visible = states[at] == Entry::predicted_visible;
    out.wrong.add(visible == (w.truth[at] > 0.5f) ? 0 : 1, w.recovery.unoccluded()[at]);
  }
  for (std::size_t k = 0; k < 3; ++k)
    out.chosen[k] = static_cast<double>(after.prediction.chosen[k] - before.prediction.chosen[k]);
  out.failed = static_cast<double>(after.prediction.failed - before.prediction.failed);
}

// The same separation once more, through all its iterations, and in two other ways.
void RecoveryInspector::separate_endlessly(Workspace& w, Findings& f) const {
  if (!settings_.separation) return;
  linalg::SeparationSettings s;
  s.max_rank = settings_.rank;
  s.iterations = kIterations;
  s.tolerance = s.min_progress = 0;
  s.constraint = settings_.constraint;
  s.fit = settings_.fit;
  const linalg::CorruptedMatrix matrix = w.recovery.corrupted();
  w.endless.run(matrix, s);
  f.endless.assign(w.endless.residuals().begin(), w.endless.residuals().end());
  std::vector<Entry> guessed(matrix.state.begin(), matrix.state.end());
  for (std::size_t at = 0; at < guessed.size(); ++at)
    if (guessed[at] == Entry::exact)
      guessed[at] = matrix.d[at] > 0 ? Entry::predicted_visible : Entry::predicted_hidden;
  w.endless.run({matrix.rows, matrix.columns, matrix.d, guessed, matrix.e}, s);
  f.everywhere.assign(w.endless.residuals().begin(), w.endless.residuals().end());
  s.fit = linalg::SeparationSettings::Fit::exact_only;
  w.endless.run(matrix, s);
  f.printed.assign(w.endless.residuals().begin(), w.endless.residuals().end());
}

// Sums of rows as drawn and as separated against the true ones; guesses against the truth.
void RecoveryInspector::compare_rows(Workspace& w, Findings& f, std::vector<double>& right) const {
  const auto e = w.recovery.unoccluded();
  const std::size_t rows = w.recovery.entries().rows().size();
  const auto states = w.recovery.states();
  w.drawn.assign(rows, 0), w.separated.assign(rows, 0);
  right.assign(rows, 0);
  for (std::size_t at = 0; at < e.size(); ++at) {
    if (states[at] == Entry::free) continue;
    const float v = w.truth[at], recovered = w.recovery.visibility()[at];
    const float guess = states[at] == Entry::exact ? v : states[at] == Entry::predicted_visible ? 1.0f : 0.0f;
    w.drawn[at % rows] += guess * e[at], w.separated[at % rows] += recovered * e[at];
    right[at % rows] += static_cast<double>(v * e[at]);
    if (states[at] == Entry::exact) continue;
    f.drawn.add(static_cast<double>(std::abs(guess - v)), e[at]);
    f.separated.add(static_cast<double>(std::abs(recovered - v)), e[at]);
  }
  for (std::size_t i = 0; i < rows; ++i) {
    f.light += right[i];
    f.error_drawn += std::abs(static_cast<double>(w.drawn[i]) - right[i]);
    f.error_separated += std::abs(static_cast<double>(w.separated[i]) - right[i]);
    f.bias_drawn += static_cast<double>(w.drawn[i]) - right[i];
    f.bias_separated += static_cast<double>(w.separated[i]) - right[i];
  }
}

void RecoveryInspector::inspect_slice(std::size_t s, Workspace& w) {
  Findings& f = findings_[s];
  const auto count = [&] {
    return static_cast<double>(std::ranges::count(w.recovery.states(), Entry::exact));
  };
  RecoverySettings settings = settings_;
  settings.correction = false;
  settings.uncertain = 0;
  run(settings, s, w);
  f.sampled = count();
  settings.uncertain = settings_.uncertain;
  run(settings, s, w);
  f.uncertain = count() - f.sampled;
  find_truth(w);
  const auto e = w.recovery.unoccluded();
  const std::size_t rows = w.recovery.entries().rows().size(), columns = w.recovery.clusters().size();
  f.rows = static_cast<double>(rows), f.columns = static_cast<double>(columns);
  f.all_entries = static_cast<double>(e.size());
  for (std::size_t c = 0; c < columns; ++c) {
    double visible = 0, hidden = 0;
    for (std::size_t at = c * rows; at < (c + 1) * rows; ++at)
      visible += w.truth[at] == 1 ? 1 : 0, hidden += w.truth[at] == 0 ? 1 : 0;
    f.entries += visible + hidden, f.hidden += hidden, f.mixed += std::min(visible, hidden);
  }
  if (settings_.separation) {
    const auto& separation = w.recovery.separation();
    f.rank = static_cast<double>(separation.rank());
    f.iterations = static_cast<double>(separation.iterations());
    f.converged = separation.converged();
    f.residuals.assign(separation.residuals().begin(), separation.residuals().end());
    const auto whole = w.recovery.corrupted().e;
    for (std::size_t at = 0; at < whole.size(); ++at)
      if (whole[at] > 0 && std::abs(separation.sparse()[at]) > 0.5f * whole[at]) f.nonzero += 1;
    separate_endlessly(w, f);
  }
  std::vector<double> right;
  compare_rows(w, f, right);
  for (std::size_t k = 0; k < kPredictors.size(); ++k) {
    judge(s, w, alone(k, false), f.adaptive[k]);
    judge(s, w, alone(k, true), f.equal[k]);
  }
  // Last, so that the sums are the method's own.
  run(settings_, s, w);
  f.corrected = count() - f.sampled - f.uncertain;
  std::fill(w.separated.begin(), w.separated.end(), 0.0f);
  for (std::size_t at = 0; at < e.size(); ++at)
    w.separated[at % rows] += w.recovery.visibility()[at] * w.recovery.unoccluded()[at];
  for (std::size_t i = 0; i < rows; ++i) {
    f.error_final += std::abs(static_cast<double>(w.separated[i]) - right[i]);
    f.bias_final += static_cast<double>(w.separated[i]) - right[i];
  }
}

}  // namespace lumirank::bench
