#include "methods/common/reduced_matrix.h"

#include <cmath>

namespace lumirank::methods {

namespace {
constexpr std::size_t kRowsForMean = 8;
constexpr double kLittleLight = 0.1;  // of the mean
constexpr std::size_t kKeptOneIn = 3, kMostKept = 32;
}  // namespace

void ReducedMatrix::read(const SampledRow& row, std::span<Rgb> values) {
  const ExactRow& known = known_.read(row, values);
  if (!by_eye_ || mean_ > 0) {
    take(known, values);
    return;
  }
  waiting_.push_back({known, {values.begin(), values.end()}});
  if (waiting_.size() >= kRowsForMean) settle();
}

void ReducedMatrix::settle() {
  if (waiting_.empty()) return;
  double light = 0;
  for (const ExactRow& row : known_.rows()) light += static_cast<double>(norm2(row.sum));
  mean_ = light / static_cast<double>(known_.size());
  for (const Waiting& w : waiting_) take(w.row, w.values);
  waiting_.clear();
}

void ReducedMatrix::take(const ExactRow& row, std::span<const Rgb> values) {
  static_assert(sizeof(Rgb) == 3 * sizeof(float));
  double counts = 1;  // where a row has the mean light as well
  if (mean_ > 0)
    counts = (1 + kLittleLight) * mean_ / (static_cast<double>(norm2(row.sum)) + kLittleLight * mean_);
  const double weight = static_cast<double>(row.from.weight) * counts;
  const double weighted = sketch_.add_row(row.from.row, static_cast<float>(weight),
                                          {reinterpret_cast<const float*>(values.data()), values.size() * 3});
  squared_sum_ += weighted * weighted;
  if (weight > 0) image_sum_ += row.share * weighted / weight;
  if (by_eye_ && taken_++ % kKeptOneIn == 0 && kept_.rows() < kMostKept) kept_.add(row, values);
}

double ReducedMatrix::l1_over_l2() const {
  if (!(image_sum_ > 0)) return kMeanOfNormal;
  double shares = 0, weights = 0;
  for (const ExactRow& row : known_.rows()) {
    shares += row.share;
    weights += static_cast<double>(row.from.weight) * static_cast<double>(row.from.weight);
  }
  return kMeanOfNormal * (shares / image_sum_) * std::sqrt(squared_sum_ / weights);
}

}  // namespace lumirank::methods
