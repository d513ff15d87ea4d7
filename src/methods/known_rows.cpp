#include "methods/known_rows.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "methods/row_column/row_sampler.h"

namespace lumirank::methods {

namespace {

constexpr std::size_t kGroups = 16;
constexpr double kStudent = 2.131;  // 97.5 % of Student's t with 15 degrees of freedom
constexpr std::size_t kRowsAsked = 64, kFewestRows = 16;
constexpr double kShareOfCost = 0.01;
constexpr double kLeastShare = 0.25;

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

double brightness(Rgb v) {
  return static_cast<double>(v.r) + static_cast<double>(v.g) + static_cast<double>(v.b);
}

}  // namespace

ErrorPart ErrorParts::total() const {
  const double noise = std::hypot(sampling.value, lights.value);
  const auto part = [&](const ErrorPart& p) { return noise > 0 ? p.value / noise * p.half_width : 0.0; };
  return {noise + clamping.value, std::sqrt(part(sampling) * part(sampling) + part(lights) * part(lights) +
                                            clamping.half_width * clamping.half_width)};
}

const KnownRow& KnownRows::read(const SampledRow& row, std::span<Rgb> values) {
  const double clamped_before = matrix_->clamped_energy();
  matrix_->row(row.row, values);
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
                   matrix_->clamped_energy() - clamped_before});
  return rows_.back();
}

void KnownRows::append(const KnownRows& others) {
  rows_.insert(rows_.end(), others.rows_.begin(), others.rows_.end());
}

template <typename Error>
ErrorPart KnownRows::relative(Error&& error) const {
  // Interleaved groups: each is spread over the whole image.
  double over = 0, under = 0, group_over[kGroups] = {}, group_under[kGroups] = {};
  for (std::size_t k = 0; k < rows_.size(); ++k) {
    const KnownRow& row = rows_[k];
    const double e = row.share * error(row), size = row.share * (brightness(row.sum) + row.clamped);
    over += e, group_over[k % kGroups] += e;
    under += size, group_under[k % kGroups] += size;
  }
  if (!(under > 0)) return {};
  ErrorPart part;
  part.value = over / under;
  double squares = 0;
  for (std::size_t g = 0; g < kGroups; ++g) {
    const double rest = under - group_under[g];
    const double without = rest > 0 ? (over - group_over[g]) / rest : part.value;
    squares += (without - part.value) * (without - part.value);
  }
  part.half_width = kStudent * std::sqrt(squares * (kGroups - 1.0) / kGroups);
  return part;
}

ErrorPart KnownRows::lights() const {
  return relative([](const KnownRow& row) { return brightness(row.half_difference); });
}

ErrorPart KnownRows::clamping() const {
  return relative([](const KnownRow& row) { return row.clamped; });
}

ErrorPart KnownRows::sampling(std::span<const Rgb> sums) const {
  return relative([&](const KnownRow& row) {
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
  return left >= kLeastShare * target ? left : 0.5 * target;
}

KnownRows read_rows(const matrix::LightingMatrix& matrix, std::size_t count, std::uint64_t seed) {
  KnownRows known(matrix);
  std::vector<Rgb> values(matrix.columns());
  constexpr std::uint64_t kRound = 1;  // round 0 is row-column sampling's
  for (const SampledRow& row : RowSampler(matrix, seed).stratified(count, kRound)) known.read(row, values);
  return known;
}

void look_at_rows(const matrix::LightingMatrix& matrix, const RunOptions& options, std::span<const Rgb> sums,
                  double columns_spent, Trace& trace) {
  const auto rows = static_cast<double>(matrix.rows()), columns = static_cast<double>(matrix.columns());
  if (rows == 0 || columns == 0 || options.sinks.cancelled()) return;
  const double affordable = std::floor(kShareOfCost * columns_spent * rows / columns);
  const bool asked = options.target_error > 0;
  if (!asked && affordable < static_cast<double>(kFewestRows)) return;
  const double count = asked ? static_cast<double>(kRowsAsked) : std::min<double>(kRowsAsked, affordable);
  const KnownRows known = read_rows(matrix, static_cast<std::size_t>(count), options.seed);
  write_error({known.sampling(sums), known.lights(), known.clamping()}, trace);
}

}  // namespace lumirank::methods
