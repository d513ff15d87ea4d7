#include "methods/common/column_pass.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "methods/common/timed_choices.h"

namespace lumirank::methods {

namespace {

constexpr std::size_t kBlock = 32;
// Against a deadline: a 32nd of the list, and less before anything is timed: one column may take long. By
// these numbers alone, not by the clock, so that a replay has the same blocks.
std::size_t timed_block(std::size_t done, std::size_t size) {
  constexpr std::size_t kMin = 1;
  return std::min(std::clamp(size / 64, kMin, kBlock), std::max(kMin, done));
}
// A single-precision sum of very many small terms stops growing; long lists are summed in two levels.
constexpr std::size_t kTwoLevels = 8192, kLevel = 1024;
constexpr std::size_t kSumGrain = 16384;

void add_and_clear(std::span<Rgb> sums, std::span<Rgb> part) {
  parallel_for(sums.size(), kSumGrain, [&](std::size_t b, std::size_t e) {
    for (std::size_t i = b; i < e; ++i) {
      sums[i] += part[i];
      part[i] = Rgb(0);
    }
  });
}

}  // namespace

PassResult render_columns(const matrix::LightingMatrix& matrix, std::span<const matrix::ScaledColumn> columns,
                          const PassControl& control, std::span<Rgb> sums) {
  PassResult result;
  const double start = control.timer.seconds();
  const bool two_levels = columns.size() > kTwoLevels;
  std::vector<Rgb> part(two_levels ? sums.size() : 0);
  const std::span<Rgb> target = two_levels ? std::span<Rgb>(part) : sums;
  std::size_t next_preview = kBlock;
  TimedChoices* choices = choices_of(control.options);
  const auto earlier =
      choices ? choices->earlier("columns", static_cast<std::int64_t>(columns.size())) : std::nullopt;
  while (result.done < columns.size()) {
    const double now = control.timer.seconds();
    const double per_column = result.done > 0 ? (now - start) / static_cast<double>(result.done) : 0;
    const std::size_t count =
        std::min(control.deadline > 0 ? timed_block(result.done, columns.size()) : kBlock,
                 columns.size() - result.done);
    result.cancelled = control.options.sinks.cancelled();
    if (earlier)
      result.out_of_time = static_cast<std::int64_t>(result.done) >= *earlier;
    else
      result.out_of_time = control.deadline > 0 && result.done > 0 &&
                           now + per_column * static_cast<double>(count) > control.deadline;
    if (result.cancelled || result.out_of_time) break;
    matrix.accumulate(columns.subspan(result.done, count), target);
    result.done += count;
    control.options.sinks.report("columns",
                                 static_cast<double>(result.done) / static_cast<double>(columns.size()));
    // Also without a preview: the sums' bits must not depend on whether somebody watches.
    const bool preview = result.done >= next_preview && result.done < columns.size();
    if (two_levels && (preview || result.done % kLevel < kBlock)) add_and_clear(sums, part);
    if (preview) {
      if (control.on_block) control.on_block(sums, result.done);
      next_preview = std::max(result.done + kBlock, result.done * 5 / 4);
    }
  }
  if (two_levels) add_and_clear(sums, part);
  if (choices) choices->record("columns", static_cast<std::int64_t>(result.done));
  result.seconds = control.timer.seconds() - start;
  return result;
}

void mix_in(std::vector<matrix::ScaledColumn>& combination, std::span<const matrix::ScaledColumn> columns,
            float gain, float share) {
  if (share >= 1) combination.clear();
  for (auto& c : combination) c.scale *= 1 - share;
  combination.reserve(combination.size() + columns.size());
  for (const auto& c : columns) combination.push_back({c.column, c.scale * (gain * share)});
}

std::vector<Rgb> scaled_sums(std::span<const Rgb> sums, float a) {
  std::vector<Rgb> out(sums.size());
  parallel_for(sums.size(), kSumGrain, [&](std::size_t b, std::size_t e) {
    for (std::size_t i = b; i < e; ++i) out[i] = sums[i] * a;
  });
  return out;
}

namespace {
struct DifferenceAndSize {
  double difference = 0, size = 0;
  DifferenceAndSize operator+(const DifferenceAndSize& o) const {
    return {difference + o.difference, size + o.size};
  }
};
// Sums of measure(a − b) and measure(b) over rows and channels.
template <typename Measure>
DifferenceAndSize measured(std::span<const Rgb> a, std::span<const Rgb> b, Measure&& measure) {
  return parallel_sum(a.size(), kSumGrain, DifferenceAndSize{}, [&](std::size_t begin, std::size_t end) {
    DifferenceAndSize s;
    for (std::size_t i = begin; i < end; ++i)
      for (int c = 0; c < 3; ++c) {
        const double x = static_cast<double>(a[i][c]), y = static_cast<double>(b[i][c]);
        s.difference += measure(x - y);
        s.size += measure(y);
      }
    return s;
  });
}
}  // namespace

double relative_difference(std::span<const Rgb> a, std::span<const Rgb> b) {
  const auto p = measured(a, b, [](double x) { return x * x; });
  return p.difference == 0 ? 0 : std::sqrt(p.difference / p.size);
}

double relative_l1_difference(std::span<const Rgb> a, std::span<const Rgb> b) {
  const auto p = measured(a, b, [](double x) { return std::abs(x); });
  return p.difference == 0 ? 0 : p.difference / p.size;
}

}  // namespace lumirank::methods
