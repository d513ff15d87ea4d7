// Row-guided sampling. A sampled row of the matrix is an exact record of which columns matter at its place,
// visibility included. Every receiver draws `samples` columns of its own, from a mixture of the records near
// it; with `candidates`, more first, of which those stay that matter at this very receiver, by what its own
// entries without visibility say (importance resampling: Talbot, Cline and Egbert 2005; with records:
// Georgiev et al., "Importance Caching for Complex Illumination", 2012). So errors are noise that differs
// from receiver to receiver, without any shape that a denoiser or an eye takes for something.
//
// Deviations from Georgiev et al.: one draw from a mixture with fixed shares where they weigh four
// distributions by the α-max heuristic, which needs each distribution's own draws; the bounded distribution
// is that of a group of receivers instead of a record's; records are rows of the picture, half of them where
// places and directions are far from all others', and not refined by error.
//
// Unbiased: records decide probabilities, and every column that has power can be drawn.
#include "methods/row_guided_sampling/row_guided_sampling.h"

#include <algorithm>
#include <numeric>

#include "base/random.h"
#include "matrix/entry_reader.h"
#include "methods/common/exact_rows.h"
#include "methods/common/turns.h"
#include "methods/parameters.h"
#include "methods/row_guided_sampling/light_records.h"
#include "methods/row_guided_sampling/record_draws.h"

namespace lumirank::methods {

namespace {

using matrix::Index;

struct GuidedSettings {
  std::size_t samples = 8;
  std::size_t candidates = 1;
  std::size_t records = 256;
};

const Fields<GuidedSettings> kGuidedFields{
    count_field<GuidedSettings>(
        {"samples", "columns", "That a receiver draws, with a shadow ray each; time is in proportion."},
        &GuidedSettings::samples, 1, kMaxColumns),
    count_field<GuidedSettings>({"candidates", "columns",
                                 "Looked at without visibility for each of the samples, which are drawn from "
                                 "them. 1: none but these."},
                                &GuidedSettings::candidates, 1, 1024),
    count_field<GuidedSettings>({"records", "rows",
                                 "Read whole, to guide the receivers near them, or fewer where receivers are "
                                 "few; 8 bytes for each column of each."},
                                &GuidedSettings::records, 1, 65536)};

constexpr std::size_t kFewestRecords = 16;
// Of a budget what records may take.
constexpr double kRecordsShare = 0.25;
// Receivers whose entries are asked for together: neighbors.
constexpr std::size_t kGuidedTogether = 32;

// By what columns are drawn.
struct Guides {
  const LightRecords& records;
  BoundedColumns columns;
  matrix::RowFeatures rows;
};

struct GuidedWorkspace {
  explicit GuidedWorkspace(const matrix::LightingMatrix& matrix)
      : reader(matrix.reader()), row_ids(matrix.row_features().id) {}
  std::unique_ptr<matrix::EntryReader> reader;
  std::span<const std::uint64_t> row_ids;
  BoundedDistribution bounded;
  std::vector<GuidedColumn> candidates;  // of all rows of a group, as many for each
  std::vector<Index> rows, columns;
  std::vector<Rgb> entries;
  std::vector<float> scale;        // of what is drawn: its entry counts so many times
  std::vector<double> importance;  // of one row's candidates
  std::vector<std::size_t> ends;   // of each row's in `columns`
  matrix::Cost cost;
  double seconds_draws = 0, seconds_candidates = 0, seconds_entries = 0;
};

class RowGuidedSampling final : public Method {
 public:
  explicit RowGuidedSampling(const GuidedSettings& settings) : settings_(settings) {}

  Estimate run(const matrix::LightingMatrix& matrix, const RunOptions& options) const override {
    const RunClock timer(options);
    Estimate estimate;
    estimate.sums.assign(matrix.rows(), Rgb(0));
    if (matrix.rows() == 0 || matrix.columns() == 0) {
      describe(estimate.trace, matrix, 0, {});
      if (options.on_estimate) options.on_estimate(estimate.sums);
      return estimate;
    }
    Turns turns(matrix, options, timer, estimate.sums);
    RowsForError known(matrix, options, timer);
    const double before = timer.seconds();
    const LightRecords records = read_records(matrix, options, timer);
    estimate.trace.numbers["seconds.records"] = timer.seconds() - before;
    estimate.interrupted = options.sinks.cancelled();
    matrix::Cost cost = records.cost();
    if (!estimate.interrupted) {
      WorkspacePool<GuidedWorkspace> pool([&] { return std::make_unique<GuidedWorkspace>(matrix); });
      const RowGroups groups = stretches(matrix.rows());
      const Guides guides{records, BoundedColumns(matrix.column_features(), matrix.columns()),
                          matrix.row_features()};
      const TurnMethod method{.entries_per_row =
                                  static_cast<double>(settings_.samples * settings_.candidates)};
      const RowGroupResult pass =
          run_in_turns(turns, groups, {options, timer, 0, "columns"}, method, estimate.sums, pool,
                       [&](std::size_t group, GuidedWorkspace& w, const Turn& turn, std::span<Rgb> sums) {
                         sum_rows(groups[group], guides, options.seed, turn, w, sums);
                       });
      turns.write(estimate.trace);
      note_stop(pass, estimate);
      estimate.trace.numbers["seconds.columns"] = pass.seconds;
      pool.for_each([&](const GuidedWorkspace& w) {
        cost += w.cost;
        estimate.trace.numbers["cpu_seconds.draws"] += w.seconds_draws;
        estimate.trace.numbers["cpu_seconds.candidates"] += w.seconds_candidates;
        estimate.trace.numbers["cpu_seconds.entries"] += w.seconds_entries;
      });
    }
    describe(estimate.trace, matrix, records.size(), cost);
    if (!estimate.interrupted) known.state(estimate.sums, estimate.trace.numbers["columns"], estimate.trace);
    if (options.on_estimate) options.on_estimate(estimate.sums);
    return estimate;
  }

 private:
  // Where there are few receivers, no more than cost twice what these draw.
  std::size_t record_count(const matrix::LightingMatrix& matrix) const {
    const double draws = static_cast<double>(matrix.rows()) * static_cast<double>(settings_.samples);
    const double affordable = 2 * draws / static_cast<double>(matrix.columns());
    return std::min(settings_.records, std::max(kFewestRecords, static_cast<std::size_t>(affordable)));
  }

  // Under a budget no more than a part of it, and what was read is kept for a repetition.
  LightRecords read_records(const matrix::LightingMatrix& matrix, const RunOptions& options,
                            const RunClock& clock) const {
    const std::vector<Index> chosen = choose_records(matrix, {record_count(matrix), options.seed});
    std::vector<Index> order;  // every beginning is spread over the picture
    for (const std::uint32_t k : coarse_to_fine(chosen.size())) order.push_back(chosen[k]);
    const bool timed = options.time_seconds > 0;
    TimedChoices* choices = timed ? choices_of(options) : nullptr;
    const auto earlier =
        choices ? choices->earlier("records", static_cast<std::int64_t>(order.size())) : std::nullopt;
    if (earlier) order.resize(static_cast<std::size_t>(*earlier));
    const double begin = clock.seconds(), part = kRecordsShare * options.time_seconds;
    std::size_t done = 0;
    const auto go_on = [&](std::size_t read) {
      options.sinks.report("records", static_cast<double>(read) / static_cast<double>(order.size()));
      if (options.sinks.cancelled()) return false;
      if (timed && !earlier) {
        const double spent = clock.seconds() - begin;
        if (read > 0 && spent + spent / static_cast<double>(read) > part) return false;
      }
      done = read + 1;
      return true;
    };
    LightRecords records(matrix, order, go_on);
    if (choices) choices->record("records", static_cast<std::int64_t>(done));
    return records;
  }

  static RowGroups stretches(std::size_t rows) {
    std::vector<Index> all(rows);
    std::iota(all.begin(), all.end(), 0u);
    std::vector<std::uint32_t> first;
    for (std::size_t i = 0; i < rows; i += kGuidedTogether) first.push_back(static_cast<std::uint32_t>(i));
    first.push_back(static_cast<std::uint32_t>(rows));
    return {std::move(all), std::move(first)};
  }

  void sum_rows(std::span<const Index> rows, const Guides& guides, std::uint64_t seed, const Turn& turn,
                GuidedWorkspace& w, std::span<Rgb> sums) const {
    const std::size_t samples = turn.scaled(settings_.samples), count = samples * settings_.candidates;
    const Timer timer;
    const std::uint64_t scramble = hash_ids(seed, Stage::method, turn.number);
    w.bounded.update(guides.columns, guides.rows, rows);
    w.candidates.resize(rows.size() * count);
    for (std::size_t r = 0; r < rows.size(); ++r)
      RecordMixture(guides.records, w.bounded, rows[r])
          .draw(spread_fraction(rows[r], scramble), std::span(w.candidates).subspan(r * count, count));
    const double drawn = timer.seconds();
    w.rows.clear(), w.columns.clear(), w.scale.clear(), w.ends.clear();
    if (settings_.candidates > 1)
      resample(rows, {samples, count, seed, turn.number}, w);
    else
      take_all(rows, count, w);
    const double resampled = timer.seconds();
    w.entries.resize(w.columns.size());
    w.cost += w.reader->entries(w.rows, w.columns, w.entries);
    std::size_t k = 0;
    for (std::size_t r = 0; r < rows.size(); ++r) {
      Rgb sum(0);
      for (; k < w.ends[r]; ++k) sum += w.scale[k] * w.entries[k];
      sums[rows[r]] = sum;
    }
    w.seconds_draws += drawn, w.seconds_candidates += resampled - drawn;
    w.seconds_entries += timer.seconds() - resampled;
  }

  static void take_all(std::span<const Index> rows, std::size_t count, GuidedWorkspace& w) {
    for (std::size_t k = 0; k < w.candidates.size(); ++k) {
      const GuidedColumn& c = w.candidates[k];
      w.rows.push_back(rows[k / count]), w.columns.push_back(c.column);
      w.scale.push_back(1 / (c.probability * static_cast<float>(count)));
      if ((k + 1) % count == 0) w.ends.push_back(k + 1);
    }
  }

  struct Draws {
    std::size_t samples, candidates;  // for each row
    std::uint64_t seed, turn;
  };
  // Of each row's candidates draws `samples` in proportion to what they are thought to bring.
  static void resample(std::span<const Index> rows, const Draws& draws, GuidedWorkspace& w) {
    for (std::size_t k = 0; k < w.candidates.size(); ++k)
      w.rows.push_back(rows[k / draws.candidates]), w.columns.push_back(w.candidates[k].column);
    w.entries.resize(w.columns.size());
    w.cost += w.reader->entries(w.rows, w.columns, w.entries, matrix::Part::unoccluded);
    w.rows.clear(), w.columns.clear();
    w.importance.resize(draws.candidates);
    for (std::size_t r = 0; r < rows.size(); ++r) {
      const std::size_t first = r * draws.candidates;
      double total = 0;
      for (std::size_t m = 0; m < draws.candidates; ++m) {
        const GuidedColumn& c = w.candidates[first + m];
        const float target = c.visible * record_brightness(w.entries[first + m]);
        total += w.importance[m] = static_cast<double>(target) / static_cast<double>(c.probability);
      }
      if (total > 0) {
        Rng rng(draws.seed, Stage::method, matrix::id_of(w.row_ids, rows[r]), ~draws.turn);
        const double step = total / static_cast<double>(draws.samples);
        double next = step * rng.next_double(), sum = 0;
        for (std::size_t m = 0; m < draws.candidates; ++m) {
          sum += w.importance[m];
          std::size_t times = 0;
          for (; next < sum; next += step) ++times;
          if (times == 0) continue;
          // times · (total / samples) / (candidates · target)
          const GuidedColumn& c = w.candidates[first + m];
          w.rows.push_back(rows[r]), w.columns.push_back(c.column);
          w.scale.push_back(static_cast<float>(static_cast<double>(times) * step /
                                               (static_cast<double>(draws.candidates) * w.importance[m] *
                                                static_cast<double>(c.probability))));
        }
      }
      w.ends.push_back(w.columns.size());
    }
  }

  void describe(Trace& trace, const matrix::LightingMatrix& matrix, std::size_t records,
                const matrix::Cost& cost) const {
    trace.numbers["rows"] = static_cast<double>(records);
    trace.numbers["columns"] = static_cast<double>(settings_.samples);
    const double all = static_cast<double>(matrix.rows()) * static_cast<double>(matrix.columns());
    trace.numbers["sampling_rate"] = all > 0 ? static_cast<double>(cost.entries) / all : 1.0;
  }

  GuidedSettings settings_;
};

}  // namespace

MethodInfo row_guided_sampling_info() {
  return method_info<RowGuidedSampling>(
      {"row-guided-sampling",
       "For each receiver a few columns of its own, drawn as rows near it that were read whole say.",
       "Georgiev, Křivánek, Popov, Slusallek 2012, Importance Caching for Complex Illumination",
       "samples",
       {}},
      kGuidedFields);
}

}  // namespace lumirank::methods
