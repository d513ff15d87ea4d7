#include "methods/row_column/exploration.h"

#include <cmath>

#include "base/parallel.h"

namespace lumirank::methods {

void Exploration::read(const SampledRow& row, std::span<Rgb> values) {
  const KnownRow& known = known_.read(row, values);
  static_assert(sizeof(Rgb) == 3 * sizeof(float));
  sketch_.add_row(row.row, row.weight, {reinterpret_cast<const float*>(values.data()), values.size() * 3});
  const double scalar = parallel_sum(values.size(), 8192, 0.0, [&](std::size_t begin, std::size_t end) {
    double s = 0;
    for (std::size_t j = begin; j < end; ++j) s += static_cast<double>(norm2(values[j]));
    return s;
  });
  const double weighted = static_cast<double>(row.weight) * scalar;
  squared_sum_ += weighted * weighted;
  image_sum_ += known.share * scalar;
}

double Exploration::l1_over_l2() const {
  if (!(image_sum_ > 0)) return kMeanOfNormal;
  double shares = 0, weights = 0;
  for (const KnownRow& row : known_.rows()) {
    shares += row.share;
    weights += static_cast<double>(row.from.weight) * static_cast<double>(row.from.weight);
  }
  return kMeanOfNormal * (shares / image_sum_) * std::sqrt(squared_sum_ / weights);
}

}  // namespace lumirank::methods
