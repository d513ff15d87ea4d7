#include "methods/common/coarse_picture.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/parallel.h"
#include "matrix/entry_reader.h"
#include "methods/common/power_draws.h"
#include "methods/common/row_group_pass.h"
#include "methods/common/timed_choices.h"

namespace lumirank::methods {

using matrix::Index;

namespace {

constexpr std::size_t kStretch = 128;  // rows of a group
// More columns are for the methods to choose; with fewer than the least one sees rather which they are.
constexpr std::size_t kMaxDraws = 64, kMinDraws = 16;
// Of the budget: for all of them, and for the least.
constexpr double kCoarseShare = 0.05, kFewDrawsShare = 0.2;
// Rows that are asked what columns matter, and what part of the budget for all of them.
constexpr std::size_t kTriedRows = 16;
constexpr double kTriedRowsShare = 0.02;
constexpr double kLatest = 0.3;           // of the budget: no stretch of rows is begun after it
constexpr std::uint64_t kRound = 0xc0a5;  // of draws: those of the methods are independent of it

struct CoarseWork {
  std::unique_ptr<matrix::EntryReader> reader;
  std::vector<Rgb> values;
};

RowGroups stretches_of_rows(std::size_t rows) {
  std::vector<Index> all(rows);
  std::iota(all.begin(), all.end(), 0u);
  std::vector<std::uint32_t> first;
  for (std::size_t i = 0; i < rows; i += kStretch) first.push_back(static_cast<std::uint32_t>(i));
  first.push_back(static_cast<std::uint32_t>(rows));
  return {std::move(all), std::move(first)};
}

void sum_stretch(std::span<const Index> rows, std::span<const matrix::ScaledColumn> columns, float gain,
                 CoarseWork& w, std::span<Rgb> sums) {
  w.values.resize(rows.size());
  w.reader->set_rows(rows);
  for (const Index i : rows) sums[i] = Rgb(0);
  for (const matrix::ScaledColumn& c : columns) {
    w.reader->column(c.column, w.values);
    for (std::size_t a = 0; a < rows.size(); ++a) sums[rows[a]] += gain * c.scale * w.values[a];
  }
}

// What to draw columns by: half their power, half what some rows get of them. By power alone nearly all draws
// may be of columns that hardly any row sees: what is outside of a room with a window.
std::vector<float> importance(const matrix::LightingMatrix& matrix, const RunOptions& options,
                              const RunClock& clock) {
  const std::size_t rows = matrix.rows(), columns = matrix.columns();
  const std::size_t max_count = std::min(kTriedRows, rows);
  const std::vector<std::uint32_t> order = coarse_to_fine(max_count);
  std::vector<std::vector<Rgb>> read(max_count);
  std::size_t have = 0;
  const auto read_until = [&](std::size_t end) {
    parallel_for(end - have, 1, [&](std::size_t b, std::size_t e) {
      for (std::size_t k = have + b; k < have + e; ++k) {
        read[k].resize(columns);
        matrix.row(static_cast<Index>((2 * order[k] + 1) * rows / (2 * max_count)), read[k]);
      }
    });
    have = end;
  };
  // One for each thread in any case; they tell what the others take.
  const std::size_t count =
      timed_choice(options, "coarse_rows", static_cast<std::int64_t>(max_count), [&]() -> std::size_t {
        const double begin = clock.seconds();
        while (have < max_count) {
          const std::size_t next = std::min(max_count, have + static_cast<std::size_t>(current_threads()));
          const double took = clock.seconds() - begin;
          if (have > 0 && took * static_cast<double>(next) >
                              kTriedRowsShare * options.time_seconds * static_cast<double>(have))
            break;
          read_until(next);
        }
        return have;
      });
  if (have < count) read_until(count);

  const std::span<const float> power = matrix.column_features().power;
  std::vector<double> seen(columns, 0.0);
  for (std::size_t k = 0; k < have; ++k) {
    double sum = 0;
    for (const Rgb& v : read[k]) sum += static_cast<double>(luminance(v));
    if (!(sum > 0)) continue;
    for (std::size_t j = 0; j < columns; ++j) seen[j] += static_cast<double>(luminance(read[k][j])) / sum;
  }
  const double all_power = std::accumulate(power.begin(), power.end(), 0.0),
               all_seen = std::accumulate(seen.begin(), seen.end(), 0.0);
  std::vector<float> weights(columns);
  for (std::size_t j = 0; j < columns; ++j)
    weights[j] = static_cast<float>((all_power > 0 ? static_cast<double>(power[j]) / all_power : 0) +
                                    (all_seen > 0 ? seen[j] / all_seen : 0));
  return weights;
}

// See the rule of succession above.
void light_dark_rows(std::size_t draws, std::span<Rgb> sums) {
  const float share = 1.0f / static_cast<float>(draws + 2);
  constexpr std::size_t kNone = static_cast<std::size_t>(-1);
  std::vector<std::size_t> before(sums.size(), kNone);
  std::size_t lit = kNone;
  for (std::size_t i = 0; i < sums.size(); ++i) {
    if (!is_black(sums[i])) lit = i;
    before[i] = lit;
  }
  lit = kNone;
  // From the end, so that a row that was given light is not taken for a lit one: `before` knows.
  for (std::size_t i = sums.size(); i-- > 0;) {
    if (before[i] == i) {
      lit = i;
      continue;
    }
    const bool earlier = lit == kNone || (before[i] != kNone && i - before[i] <= lit - i);
    const std::size_t from = earlier ? before[i] : lit;
    if (from != kNone) sums[i] = share * sums[from];
  }
}

// Columns that fit, by a stretch for each thread: first with one column, then, where that is short, with
// some more, which are cheaper by the piece.
std::size_t columns_that_fit(const RowGroups& row_groups, std::span<const matrix::ScaledColumn> drawn,
                             const RunOptions& options, const RunClock& clock,
                             WorkspacePool<CoarseWork>& pool, double& entry_seconds, std::span<Rgb> sums) {
  const std::vector<std::uint32_t> order = coarse_to_fine(row_groups.size());
  const std::size_t tried = std::min(row_groups.size(), static_cast<std::size_t>(current_threads()));
  std::size_t max_count = 1;
  for (const std::size_t count : {std::size_t{1}, std::min<std::size_t>(8, drawn.size())}) {
    if (count > max_count) break;
    // The fastest of three: the first warms caches, and others may be at work on the machine.
    double took = 1e9;
    for (int repeat = 0; repeat < 3; ++repeat) {
      const double begin = clock.seconds();
      parallel_for(tried, 1, [&](std::size_t b, std::size_t e) {
        WorkspacePool<CoarseWork>::Lease w(pool);
        for (std::size_t k = b; k < e; ++k)
          sum_stretch(row_groups[order[k]], drawn.first(count), 1, *w, sums);
      });
      took = std::min(took, clock.seconds() - begin);
    }
    std::size_t read = 0;
    for (std::size_t k = 0; k < tried; ++k) read += row_groups[order[k]].size();
    entry_seconds = took / static_cast<double>(read * count);
    const double column = std::max(entry_seconds * static_cast<double>(sums.size()), 1e-12);
    const double fit = options.time_seconds / column;
    max_count = static_cast<std::size_t>(
        std::clamp(std::max(kCoarseShare * fit, std::min(kFewDrawsShare * fit, double{kMinDraws})), 1.0,
                   static_cast<double>(drawn.size())));
  }
  return max_count;
}

}  // namespace

CoarsePicture make_coarse_picture(const matrix::LightingMatrix& matrix, const RunOptions& options,
                                  const RunClock& clock, std::span<Rgb> sums) {
  CoarsePicture picture;
  const std::size_t rows = matrix.rows();
  if (rows == 0 || matrix.columns() == 0) return picture;
  std::vector<Index> all(matrix.columns());
  std::iota(all.begin(), all.end(), 0u);
  const auto drawn = draw_columns(all, importance(matrix, options, clock),
                                  {kMaxDraws, true, options.seed, Stage::method, kRound});
  const RowGroups row_groups = stretches_of_rows(rows);
  WorkspacePool<CoarseWork> pool([&] {
    auto w = std::make_unique<CoarseWork>();
    w->reader = matrix.reader();
    return w;
  });
  const auto fitting = [&] {
    return columns_that_fit(row_groups, drawn, options, clock, pool, picture.entry_seconds, sums);
  };
  picture.columns = timed_choice(options, "coarse_columns", static_cast<std::int64_t>(drawn.size()), fitting);
  // A prefix of the draws is a fair sample of them.
  picture.columns = std::clamp<std::size_t>(picture.columns, 1, drawn.size());
  const float gain = static_cast<float>(drawn.size()) / static_cast<float>(picture.columns);
  const RowGroupResult pass =
      run_row_groups(row_groups, {options, clock, kLatest * options.time_seconds, "coarse picture"}, sums,
                     pool, [&](std::size_t group, CoarseWork& w) {
                       sum_stretch(row_groups[group], std::span(drawn).first(picture.columns), gain, w, sums);
                     });
  picture.all_rows_read = pass.done == row_groups.size();
  if (pass.done == 0) picture.columns = 0;
  // Where these columns light nothing, which is seldom, the others for some rows tell how bright rows are.
  if (pass.done > 0 && std::ranges::all_of(sums, [](Rgb v) { return is_black(v); })) {
    WorkspacePool<CoarseWork>::Lease w(pool);
    picture.columns = drawn.size();
    sum_stretch(row_groups[coarse_to_fine(row_groups.size())[0]], drawn, 1, *w, sums);
  }
  light_dark_rows(picture.columns, sums);
  if (options.on_estimate && picture.columns > 0) options.on_estimate(sums);
  return picture;
}

}  // namespace lumirank::methods
