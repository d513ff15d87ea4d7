#include "methods/row_guided_sampling/light_records.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "methods/common/row_sampler.h"

namespace lumirank::methods {

namespace {

using matrix::Index;

// Of so many candidates for each record that is placed by what it is far from.
constexpr std::size_t kCandidates = 8;

using Point6 = std::array<float, 6>;

}  // namespace

// Places and directions in one space: over `scale` places differ as much as directions at right angles do.
class RecordSpace {
 public:
  RecordSpace(const matrix::LightingMatrix& matrix, std::span<const Index> some)
      : features_(matrix.row_features()) {
    if (features_.position.size() != matrix.rows()) features_.position = {};
    if (features_.normal.size() != matrix.rows()) features_.normal = {};
    if (features_.position.empty() || some.empty()) return;
    // Medians: a floor that goes on to the horizon is not the measure of the room on it.
    const auto median = [](std::vector<float>& v) {
      std::nth_element(v.begin(), v.begin() + static_cast<std::ptrdiff_t>(v.size() / 2), v.end());
      return v[v.size() / 2];
    };
    std::vector<float> along(some.size());
    Vec3f center;
    for (int c = 0; c < 3; ++c) {
      for (std::size_t k = 0; k < some.size(); ++k) along[k] = features_.position[some[k]][c];
      center[c] = median(along);
    }
    for (std::size_t k = 0; k < some.size(); ++k) along[k] = length(features_.position[some[k]] - center);
    const float typical = median(along);
    if (typical > 0) inverse_scale_ = 2 / typical;
  }

  Point6 operator()(Index row) const {
    Point6 point{};
    if (features_.position.empty()) {
      point[0] = static_cast<float>(row);
      return point;
    }
    for (int c = 0; c < 3; ++c)
      point[static_cast<std::size_t>(c)] = features_.position[row][c] * inverse_scale_;
    if (!features_.normal.empty())
      for (int c = 0; c < 3; ++c) point[static_cast<std::size_t>(3 + c)] = features_.normal[row][c];
    return point;
  }

 private:
  matrix::RowFeatures features_;
  float inverse_scale_ = 1;
};

namespace {

float distance_squared(const Point6& a, const Point6& b) {
  float sum = 0;
  for (std::size_t d = 0; d < a.size(); ++d) sum += (a[d] - b[d]) * (a[d] - b[d]);
  return sum;
}

std::vector<Index> indices_of(std::span<const SampledRow> rows) {
  std::vector<Index> out;
  for (const SampledRow& row : rows) out.push_back(row.row);
  return out;
}

}  // namespace

std::vector<Index> choose_records(const matrix::LightingMatrix& matrix, const RecordSettings& settings) {
  const RowSampler sampler(matrix, settings.seed);
  const std::size_t even = (settings.count + 1) / 2;
  // Rounds of their own: rows whose error is stated are others.
  constexpr std::uint64_t kEvenRound = 2, kCandidateRound = 3;
  std::vector<Index> chosen = indices_of(sampler.stratified(even, kEvenRound));
  std::vector<Index> candidates =
      indices_of(sampler.stratified(kCandidates * (settings.count - even), kCandidateRound));
  const RecordSpace space(matrix, candidates);
  std::vector<Point6> at(candidates.size());
  std::vector<float> nearest(candidates.size(), std::numeric_limits<float>::infinity());
  const auto take_in = [&](const Point6& record) {
    for (std::size_t k = 0; k < at.size(); ++k)
      nearest[k] = std::min(nearest[k], distance_squared(at[k], record));
  };
  for (std::size_t k = 0; k < at.size(); ++k) at[k] = space(candidates[k]);
  for (const Index row : chosen) take_in(space(row));
  while (chosen.size() < settings.count && !candidates.empty()) {
    const auto farthest = std::max_element(nearest.begin(), nearest.end());
    if (!(*farthest > 0)) break;
    const auto k = static_cast<std::size_t>(farthest - nearest.begin());
    chosen.push_back(candidates[k]);
    take_in(at[k]);
  }
  std::sort(chosen.begin(), chosen.end());
  chosen.erase(std::unique(chosen.begin(), chosen.end()), chosen.end());
  return chosen;
}

LightRecords::~LightRecords() = default;
LightRecords::LightRecords(LightRecords&&) noexcept = default;

LightRecords::LightRecords(const matrix::LightingMatrix& matrix, std::span<const Index> rows,
                           const std::function<bool(std::size_t)>& go_on)
    : columns_(matrix.columns()), space_(std::make_unique<RecordSpace>(matrix, rows)) {
  std::vector<Rgb> values(columns_);
  std::vector<float> weights(columns_);
  const auto add = [&](Index row, matrix::Part part) {
    cost_ += matrix.row(row, values, part);
    double total = 0;
    for (std::size_t j = 0; j < columns_; ++j)
      total += static_cast<double>(weights[j] = record_brightness(values[j]));
    const bool lit =
        RunningSum::write(weights, sums_.data() + 2 * (columns_ + 1) * count_ + (totals_.size() & 1), 2);
    totals_.push_back(static_cast<float>(total));
    return lit;
  };
  sums_.reserve(2 * rows.size() * (columns_ + 1));
  for (std::size_t read = 0; read < rows.size() && go_on(read); ++read) {
    const Index row = rows[read];
    sums_.resize(2 * (columns_ + 1) * (count_ + 1));
    add(row, matrix::Part::value);
    if (!add(row, matrix::Part::unoccluded)) {
      totals_.resize(totals_.size() - 2);
      continue;
    }
    const Point6 at = (*space_)(row);
    for (std::size_t d = 0; d < at.size(); ++d) places_[d].push_back(at[d]);
    ++count_;
  }
  const matrix::ColumnFeatures features = matrix.column_features();
  weights.assign(columns_, 1.0f);
  if (features.power.size() == columns_) {
    // Whatever a column's power says, no entry may be out of reach: a hundredth is drawn evenly.
    double total = 0;
    for (const float p : features.power) total += static_cast<double>(p);
    const float least = static_cast<float>(0.01 * total / static_cast<double>(columns_));
    if (total > 0)
      for (std::size_t j = 0; j < columns_; ++j) weights[j] = features.power[j] + least;
  }
  power_.resize(columns_ + 1);
  RunningSum::write(weights, power_.data(), 1);
}

LightRecords::Near LightRecords::nearest(Index row) const {
  const Point6 at = (*space_)(row);
  Near near;
  near.fill(kNone);
  std::array<float, kNear> distance;
  distance.fill(std::numeric_limits<float>::infinity());
  // All distances of a stretch first: few of them are among the least.
  constexpr std::size_t kTogether = 64;
  std::array<float, kTogether> of;
  for (std::size_t first = 0; first < count_; first += kTogether) {
    const std::size_t count = std::min(kTogether, count_ - first);
    of.fill(0);
    for (std::size_t c = 0; c < at.size(); ++c) {
      const float* place = places_[c].data() + first;
      for (std::size_t k = 0; k < count; ++k) of[k] += (place[k] - at[c]) * (place[k] - at[c]);
    }
    for (std::size_t k = 0; k < count; ++k) {
      if (!(of[k] < distance.back())) continue;
      std::size_t to = kNear - 1;
      for (; to > 0 && distance[to - 1] > of[k]; --to)
        distance[to] = distance[to - 1], near[to] = near[to - 1];
      distance[to] = of[k], near[to] = static_cast<std::uint32_t>(first + k);
    }
  }
  return near;
}

}  // namespace lumirank::methods
