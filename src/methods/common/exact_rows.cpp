#include "methods/common/exact_rows.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "base/random.h"
#include "methods/common/row_group_pass.h"
#include "methods/common/row_sampler.h"
#include "methods/common/timed_choices.h"

namespace lumirank::methods {

namespace {

constexpr std::size_t kGroups = 16;
// 97.5 % of Student's t with so many degrees of freedom, and one less than groups of 16 leave.
constexpr double kStudent[kGroups] = {0,     12.71, 4.303, 3.182, 2.776, 2.571, 2.447, 2.365,
                                      2.306, 2.262, 2.228, 2.201, 2.179, 2.160, 2.145, 2.131};
constexpr std::size_t kRowsAsked = 64, kMinUnderBudget = 8;
constexpr double kShareOfTime = 1.0 / 16;
// Of the interval for heavy tails: groups of rows, resamples of them, and which of their t values it takes.
constexpr std::size_t kResampled = 64, kResamples = 499;
constexpr double kLowT = 0.025, kHighT = 0.99;
constexpr double kMinShare = 0.25;

struct Triple {
  double r = 0, g = 0, b = 0;
  Triple operator+(const Triple& o) const { return {r + o.r, g + o.g, b + o.b}; }
  void add(Rgb v, double s) {
    r += s * static_cast<double>(v.r), g += s * static_cast<double>(v.g), b += s * static_cast<double>(v.b);
  }
};
struct RowSums {
  Triple all, difference;
  RowSums operator+(const RowSums& o) const { return {all + o.all, difference + o.difference}; }
};

// What rows err by and how much light they have, by group; `t` of a resample of them.
struct ErrorSums {
  std::vector<double> off, size;
  struct Ratio {
    double value, deviation;
  };
  // Of the groups that pick(k) names.
  template <typename Pick>
  Ratio ratio(Pick&& pick) const {
    const std::size_t n = off.size();
    double e = 0, s = 0, squares = 0;
    for (std::size_t k = 0; k < n; ++k) e += off[pick(k)], s += size[pick(k)];
    if (!(s > 0)) return {0, 0};
    for (std::size_t k = 0; k < n; ++k) {
      const double d = off[pick(k)] - e / s * size[pick(k)];
      squares += d * d;
    }
    const double count = static_cast<double>(n);
    return {e / s, std::sqrt(squares * count / std::max(count - 1, 1.0)) / s};
  }
};

// See ErrorPart. Its random numbers are the same for all data, so the interval is a function of these alone.
void write_interval(const ErrorSums& sums, ErrorPart& part) {
  part.low = part.high = part.value;
  const std::size_t n = sums.off.size();
  const auto own = sums.ratio([](std::size_t k) { return k; });
  if (n < 2 || !(own.deviation > 0)) return;
  std::vector<double> t;
  t.reserve(kResamples);
  std::vector<std::size_t> picks(n);
  for (std::size_t b = 0; b < kResamples; ++b) {
    Rng rng(1, Stage::rows, 0x7453, b);
    for (std::size_t& pick : picks) pick = rng.next_below(n);
    const auto r = sums.ratio([&](std::size_t k) { return picks[k]; });
    // All picks alike: no deviation, and nothing to learn.
    if (r.deviation > 1e-3 * own.deviation) t.push_back((r.value - own.value) / r.deviation);
  }
  if (t.empty()) return;
  std::sort(t.begin(), t.end());
  const auto quantile = [&](double q) {
    return t[std::min(t.size() - 1, static_cast<std::size_t>(q * static_cast<double>(t.size())))];
  };
  part.low = std::max(0.0, std::min(part.value, own.value - quantile(1 - kLowT) * own.deviation));
  part.high = std::max(part.value, own.value - quantile(1 - kHighT) * own.deviation);
}

double brightness(Rgb v) {
  return static_cast<double>(v.r) + static_cast<double>(v.g) + static_cast<double>(v.b);
}

}  // namespace

ErrorPart ErrorParts::total() const {
  const double noise = std::hypot(sampling.value, lights.value);
  const auto part = [&](const ErrorPart& p) { return noise > 0 ? p.value / noise * p.half_width : 0.0; };
  ErrorPart sum{noise + clamping.value,
                std::sqrt(part(sampling) * part(sampling) + part(lights) * part(lights) +
                          clamping.half_width * clamping.half_width)};
  // Each part's distance to the end of its interval, added as half widths are.
  const auto reach = [&](double ErrorPart::*end) {
    const auto of = [&](const ErrorPart& p) {
      return noise > 0 ? p.value / noise * (p.*end - p.value) : p.*end - p.value;
    };
    const double c = clamping.*end - clamping.value;
    return std::sqrt(of(sampling) * of(sampling) + of(lights) * of(lights) + c * c);
  };
  sum.low = std::max(0.0, sum.value - reach(&ErrorPart::low));
  sum.high = sum.value + reach(&ErrorPart::high);
  return sum;
}

const ExactRow& ExactRows::read(const SampledRow& row, std::span<Rgb> values) {
  const matrix::Cost cost = matrix_->row(row.row, values);
  const auto half = matrix_->column_features().half;
  const auto weight = matrix_->row_features().weight;
  const RowSums s = parallel_sum(values.size(), 8192, RowSums{}, [&](std::size_t begin, std::size_t end) {
    RowSums part;
    for (std::size_t j = begin; j < end; ++j) {
      part.all.add(values[j], 1);
      if (!half.empty() && half[j] != 0) part.difference.add(values[j], half[j] == 1 ? 1.0 : -1.0);
    }
    return part;
  });
  const double w = static_cast<double>(row.weight);
  const auto rgb = [](double r, double g, double b) {
    return Rgb(static_cast<float>(r), static_cast<float>(g), static_cast<float>(b));
  };
  rows_.push_back({row, w * w * (weight.empty() ? 1.0 : static_cast<double>(weight[row.row])),
                   rgb(s.all.r, s.all.g, s.all.b),
                   rgb(std::abs(s.difference.r), std::abs(s.difference.g), std::abs(s.difference.b)),
                   cost.lost});
  return rows_.back();
}

void ExactRows::append(const ExactRows& others) {
  rows_.insert(rows_.end(), others.rows_.begin(), others.rows_.end());
}

bool ExactRows::lit() const {
  return std::ranges::any_of(rows_, [](const ExactRow& r) { return brightness(r.sum) + r.clamped > 0; });
}

template <typename Error>
ErrorPart ExactRows::relative(Error&& error) const {
  // Interleaved groups: each is spread over the whole image.
  double over = 0, under = 0, group_over[kGroups] = {}, group_under[kGroups] = {};
  const std::size_t groups = std::min(kGroups, rows_.size()), resampled = std::min(kResampled, rows_.size());
  ErrorSums sums{std::vector<double>(resampled, 0.0), std::vector<double>(resampled, 0.0)};
  for (std::size_t k = 0; k < rows_.size(); ++k) {
    const ExactRow& row = rows_[k];
    const double e = row.share * error(row), size = row.share * (brightness(row.sum) + row.clamped);
    over += e, group_over[k % kGroups] += e;
    under += size, group_under[k % kGroups] += size;
    sums.off[k % resampled] += e, sums.size[k % resampled] += size;
  }
  if (!(under > 0)) return {};
  ErrorPart part;
  part.value = over / under;
  double squares = 0;
  for (std::size_t g = 0; g < groups; ++g) {
    const double rest = under - group_under[g];
    const double without = rest > 0 ? (over - group_over[g]) / rest : part.value;
    squares += (without - part.value) * (without - part.value);
  }
  const double count = static_cast<double>(groups);
  part.half_width = kStudent[groups - 1] * std::sqrt(squares * (count - 1) / count);
  write_interval(sums, part);
  return part;
}

ErrorPart ExactRows::lights() const {
  return relative([](const ExactRow& row) { return brightness(row.half_difference); });
}

ErrorPart ExactRows::clamping() const {
  return relative([](const ExactRow& row) { return row.clamped; });
}

ErrorPart ExactRows::sampling(std::span<const Rgb> sums) const {
  return relative([&](const ExactRow& row) {
    double difference = 0;
    for (int c = 0; c < 3; ++c)
      difference += std::abs(static_cast<double>(sums[row.from.row][c]) - static_cast<double>(row.sum[c]));
    return difference;
  });
}

void write_error(const ErrorParts& parts, Trace& trace) {
  auto& numbers = trace.numbers;
  numbers["error.sampling"] = parts.sampling.value;
  numbers["error.sampling_half_width"] = parts.sampling.half_width;
  numbers["error.estimate"] = parts.total().value;
  numbers["error.estimate_half_width"] = parts.total().half_width;
  numbers["error.estimate.low"] = parts.total().low;
  numbers["error.estimate.high"] = parts.total().high;
  numbers["error.estimate.confidence"] = kErrorConfidence;
  write_error_of_lights(parts, trace);
}

void write_error_of_lights(const ErrorParts& parts, Trace& trace) {
  auto& numbers = trace.numbers;
  numbers["error.lights"] = parts.lights.value;
  numbers["error.lights_half_width"] = parts.lights.half_width;
  numbers["error.clamping"] = parts.clamping.value;
  numbers["error.clamping_half_width"] = parts.clamping.half_width;
}

double target_for_sampling(double target, double lights, double clamping) {
  const double noise = target - clamping;
  const double left = noise > lights ? std::sqrt(noise * noise - lights * lights) : 0.0;
  return left >= kMinShare * target ? left : 0.5 * target;
}

ExactRows read_rows(const matrix::LightingMatrix& matrix, std::size_t count, std::uint64_t seed) {
  ExactRows known(matrix);
  std::vector<Rgb> values(matrix.columns());
  constexpr std::uint64_t kOwnRound = 1;  // round 0 is row-column sampling's
  for (const SampledRow& row : RowSampler(matrix, seed).stratified(count, kOwnRound)) known.read(row, values);
  return known;
}

RowsForError::RowsForError(const matrix::LightingMatrix& matrix, const RunOptions& options,
                           const RunClock& clock)
    : matrix_(matrix), options_(options), known_(matrix) {
  if (options.time_seconds <= 0 || matrix.rows() == 0 || matrix.columns() == 0) return;
  const auto rows = RowSampler(matrix, options.seed).stratified(kRowsAsked, 1);
  const auto earlier =
      choices_of(options) ? choices_of(options)->earlier("exact_rows", static_cast<std::int64_t>(rows.size()))
                          : std::nullopt;
  std::vector<Rgb> values(matrix.columns());
  const double begin = clock.seconds(), end = begin + kShareOfTime * options.time_seconds;
  // A beginning of them is spread over the picture as all are.
  for (const std::uint32_t k : coarse_to_fine(rows.size())) {
    const std::size_t read = known_.size();
    if (options.sinks.cancelled()) break;
    const double now = clock.seconds();
    const double row = read > 0 ? (now - begin) / static_cast<double>(read) : 0;
    const bool enough = earlier ? read >= static_cast<std::size_t>(*earlier)
                                : now + row > end || row * kMinUnderBudget > end - begin;
    if (enough) break;
    known_.read(rows[k], values);
  }
  if (known_.size() > 0) row_seconds_ = (clock.seconds() - begin) / static_cast<double>(known_.size());
  if (choices_of(options))
    choices_of(options)->record("exact_rows", static_cast<std::int64_t>(known_.size()));
}

void RowsForError::state(std::span<const Rgb> sums, double columns_spent, const Share& share, Trace& trace) {
  const auto rows = static_cast<double>(matrix_.rows()), columns = static_cast<double>(matrix_.columns());
  if (rows == 0 || columns == 0 || options_.sinks.cancelled()) return;
  if (options_.time_seconds <= 0) {
    const double affordable = std::floor(share.of_cost * columns_spent * rows / columns);
    const bool asked = options_.target_error > 0;
    if (!asked && affordable < static_cast<double>(share.fewest)) return;
    const double count = asked ? static_cast<double>(kRowsAsked) : std::min<double>(kRowsAsked, affordable);
    known_ = read_rows(matrix_, static_cast<std::size_t>(count), options_.seed);
  } else if (known_.size() < std::min(kMinUnderBudget, matrix_.rows())) {
    return;
  }
  if (!known_.lit()) return;
  trace.numbers["error.rows"] = static_cast<double>(known_.size());
  write_error({known_.sampling(sums), known_.lights(), known_.clamping()}, trace);
}

}  // namespace lumirank::methods
