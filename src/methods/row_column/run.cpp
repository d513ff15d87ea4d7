#include "methods/row_column/run.h"

#include <algorithm>
#include <cmath>

#include "methods/common/all_columns.h"
#include "methods/common/timed_choices.h"

namespace lumirank::methods {

namespace {
linalg::ColumnSketch::Shape sketch_shape(std::size_t columns, const RowColumnSettings& settings) {
  // Fewer rows than projected dimensions are better kept as they are.
  const bool few = settings.rows > 0 && settings.rows <= settings.projection;
  if (few || settings.projection == 0) return {columns, settings.rows, false};
  return {columns, settings.projection, true};
}
}  // namespace

RowColumnRun::RowColumnRun(const matrix::LightingMatrix& matrix, const RunOptions& options,
                           const RowColumnSettings& settings)
    : matrix_(matrix),
      options_(options),
      settings_(settings),
      timer_(options),
      target_(options.target_error),
      rows_(matrix.rows()),
      columns_(matrix.columns()),
      sampler_(matrix, options.seed),
      seen_(matrix, sketch_shape(matrix.columns(), settings), options.seed, settings.row_weights),
      unseen_(matrix),
      row_(matrix.columns()),
      afterwards_(matrix) {}

Estimate RowColumnRun::fixed() {
  explore(sampler_.stratified(settings_.rows), 0, 0);
  if (!stopped()) {
    const double start = timer_.seconds();
    const ColumnClusters known(matrix_, seen_, settings_, options_.seed);
    const linalg::Splitter clusters = known.cluster(settings_.columns, settings_.clustering);
    trace_.numbers["seconds.clustering"] += timer_.seconds() - start;
    pass(known, clusters, known.expected_error(clusters));
  }
  return finish();
}

void RowColumnRun::explore(const std::vector<SampledRow>& rows, std::size_t hold_out, double until) {
  // Enough held-out rows for the error to expect; they are kept as they are, so their number is bounded.
  constexpr std::size_t kMaxHeldOut = 64;
  // Fewer are a poor choice of columns, and still a picture.
  constexpr std::size_t kMinRows = 8;
  constexpr double kMuchLater = 1.5;
  const double start = timer_.seconds();
  TimedChoices* choices = choices_of(options_);
  const auto earlier =
      choices ? choices->earlier("rows", static_cast<std::int64_t>(rows.size())) : std::nullopt;
  std::size_t k = 0;
  for (; k < rows.size(); ++k) {
    cancelled_ = cancelled_ || options_.sinks.cancelled();
    const bool enough = earlier ? static_cast<std::int64_t>(k) >= *earlier
                                : until > 0 && ((timer_.seconds() > until && rows_read() >= kMinRows) ||
                                                (timer_.seconds() > kMuchLater * until && rows_read() >= 2));
    if (cancelled_ || enough) break;
    const bool apart = hold_out > 0 && k % hold_out == hold_out / 2 && unseen_.rows() < kMaxHeldOut;
    if (apart)
      unseen_.read(rows[k], row_);
    else
      seen_.read(rows[k], row_);
    options_.sinks.report("rows", static_cast<double>(k + 1) / static_cast<double>(rows.size()));
  }
  if (choices) choices->record("rows", static_cast<std::int64_t>(k));
  trace_.numbers["seconds.rows"] += timer_.seconds() - start;
}

bool RowColumnRun::pass(const ColumnClusters& known, const linalg::Splitter& clusters,
                        double expected_error) {
  const double start = timer_.seconds();
  const Representatives chosen = known.choose(clusters, passes_);
  trace_.numbers["seconds.clustering"] += timer_.seconds() - start;

  double total = 0;
  for (double e : chosen.energy) total += e;
  // The part that is done stands for all, by energy; its error is taken to fall with the number of columns.
  const auto gain_of = [&](std::size_t done) {
    double energy = 0;
    for (std::size_t k = 0; k < done; ++k) energy += chosen.energy[k];
    return energy > 0 ? static_cast<float>(total / energy) : 1.0f;
  };
  const auto error_of = [&](std::size_t done) {
    return std::max(expected_error, 1e-4) * static_cast<double>(chosen.columns.size()) /
           static_cast<double>(done);
  };
  const auto so_far = [&](std::span<const Rgb> sums, std::size_t done) {
    return blend_.with(scaled_sums(sums, gain_of(done)), error_of(done));
  };
  std::vector<Rgb> sums(rows_, Rgb(0));
  PassControl control{options_, timer_, deadline_of(options_), {}};
  if (options_.on_estimate)
    control.on_block = [&](std::span<const Rgb> part, std::size_t done) {
      options_.on_estimate(so_far(part, done));
    };
  const PassResult result = render_columns(matrix_, chosen.columns, control, sums);

  trace_.numbers["seconds.columns"] += result.seconds;
  trace_.numbers["clusters"] = static_cast<double>(clusters.clusters());
  trace_.numbers["zero_columns"] = static_cast<double>(known.zero().size());
  trace_.numbers["zero_columns_drawn"] += static_cast<double>(chosen.zero_columns);
  trace_.numbers["power_share"] = known.power_share();
  trace_.numbers["predicted_error_seen"] = known.expected_error(clusters);
  for (std::size_t k = 0; k < result.done; ++k) rendered_.insert(chosen.columns[k].column);
  rendered_count_ += result.done;
  cancelled_ = cancelled_ || result.cancelled;
  out_of_time_ = out_of_time_ || result.out_of_time;
  const std::span<const matrix::ScaledColumn> done(chosen.columns.data(), result.done);
  if (result.done == chosen.columns.size()) {
    mix_in(combination_, done, 1, static_cast<float>(blend_.share_of(expected_error)));
    blend_.add(sums, expected_error);
    ++passes_;
  } else if (result.done > 0) {
    mix_in(combination_, done, gain_of(result.done),
           static_cast<float>(blend_.share_of(error_of(result.done))));
    blend_.sums() = so_far(sums, result.done);
  }
  if (options_.on_estimate && !blend_.sums().empty()) options_.on_estimate(blend_.sums());
  return !stopped();
}

void RowColumnRun::pass_over_all_columns() {
  RunOptions rest = options_;
  if (options_.time_seconds > 0) rest.time_seconds = std::max(time_left(), 1e-9);
  Estimate all = brute_force(matrix_, rest);
  const auto done = static_cast<std::size_t>(all.trace.numbers.at("columns"));
  const bool whole = done == columns_;
  rendered_count_ += done;
  trace_.numbers["seconds.columns"] += all.trace.numbers.at("seconds.columns");
  cancelled_ = cancelled_ || all.interrupted;
  out_of_time_ = out_of_time_ || all.trace.notes.contains("stopped");
  // Columns in their own order, cut short, are a worse estimate than any pass over representatives.
  if (!whole && passes_ > 0) return;
  combination_ = std::move(all.combination);
  for (const matrix::ScaledColumn& c : combination_) rendered_.insert(c.column);
  blend_ = Blend();
  blend_.add(all.sums, whole ? 0 : 1);
  ++passes_;
}

double RowColumnRun::time_left() const {
  return options_.time_seconds > 0 ? options_.time_seconds - timer_.seconds() : 1e9;
}

Costs RowColumnRun::costs() const {
  const Costs entries{static_cast<double>(columns_), static_cast<double>(rows_)};
  const double rows = static_cast<double>(rows_read()), columns = static_cast<double>(rendered_count_);
  if (options_.time_seconds <= 0 || rows == 0) return entries;
  const double row = trace_.numbers.at("seconds.rows") / rows;
  // Until a column is timed its entries are taken to cost what a row's do.
  return {row,
          columns > 0 ? trace_.numbers.at("seconds.columns") / columns : row * entries.column / entries.row};
}

ErrorParts RowColumnRun::errors() const {
  ExactRows all = seen_.known(), unseen = unseen_.known();
  unseen.append(afterwards_);
  all.append(unseen);
  const bool rendered = !blend_.sums().empty();
  return {rendered ? unseen.sampling(blend_.sums()) : ErrorPart{}, all.lights(), all.clamping()};
}

void RowColumnRun::report_errors() {
  if (rows_read() == 0) {  // all columns were summed without reading rows
    if (options_.time_seconds <= 0)
      RowsForError(matrix_, options_, timer_)
          .state(blend_.sums(), static_cast<double>(rendered_count_), trace_);
    return;
  }
  // With given rows none are held out; a stated error is worth some more.
  constexpr std::size_t kRowsAfterwards = 64;
  if (unseen_.rows() == 0 && options_.target_error > 0 && options_.time_seconds <= 0 && !stopped())
    afterwards_ = read_rows(matrix_, kRowsAfterwards, options_.seed);
  const ErrorParts parts = errors();
  trace_.numbers["sampled_rows_error"] = seen_.known().sampling(blend_.sums()).value;
  if (unseen_.rows() > 0) trace_.numbers["heldout_error"] = unseen_.known().sampling(blend_.sums()).value;
  if (!seen_.known().lit()) return;
  trace_.numbers["error.rows"] = static_cast<double>(unseen_.rows() + afterwards_.size());
  if (unseen_.known().lit() || afterwards_.lit())
    write_error(parts, trace_);
  else
    write_error_of_lights(parts, trace_);
}

Estimate RowColumnRun::finish() {
  Estimate estimate;
  auto& numbers = trace_.numbers;
  if (!blend_.sums().empty()) report_errors();
  numbers["memory.sketch_bytes"] = static_cast<double>(seen_.sketch().memory_bytes());
  numbers["memory.held_out_bytes"] =
      static_cast<double>(unseen_.entries().memory_bytes() + seen_.kept().entries().memory_bytes());
  numbers["predicted_error"] = blend_.expected_error();
  numbers["rows"] = static_cast<double>(rows_read());
  numbers["rows_held_out"] = static_cast<double>(unseen_.rows());
  numbers["columns"] = static_cast<double>(rendered_.size());
  numbers["passes"] = static_cast<double>(passes_);
  numbers["sampling_rate"] =
      static_cast<double>(rows_read()) / static_cast<double>(std::max<std::size_t>(rows_, 1)) +
      static_cast<double>(rendered_count_) / static_cast<double>(std::max<std::size_t>(columns_, 1));
  if (options_.time_seconds > 0) {
    numbers["budget.coarse_share"] = 0;  // every row has all columns that were rendered
    const double normal = options_.target_error > 0 ? options_.target_error : kUnaskedTarget;
    if (settings_.columns == 0 && blend_.expected_error() > normal)
      numbers["budget.seconds_wanted"] =
          timer_.seconds() *
          std::min(blend_.expected_error() / normal * blend_.expected_error() / normal, 1e4);
  }
  if (cancelled_) trace_.notes["stopped"] = "cancelled";
  if (out_of_time_ && !cancelled_) trace_.notes["stopped"] = "time budget";
  estimate.sums = blend_.sums().empty() ? std::vector<Rgb>(rows_, Rgb(0)) : std::move(blend_.sums());
  estimate.combination = std::move(combination_);
  estimate.trace = std::move(trace_);
  estimate.interrupted = cancelled_;
  return estimate;
}

}  // namespace lumirank::methods
