#include "methods/common/reduced_matrix.h"

#include <cmath>

namespace lumirank::methods {

void ReducedMatrix::read(const SampledRow& row, std::span<Rgb> values) {
  const ExactRow& known = known_.read(row, values);
  static_assert(sizeof(Rgb) == 3 * sizeof(float));
  const double weighted = sketch_.add_row(row.row, row.weight,
                                          {reinterpret_cast<const float*>(values.data()), values.size() * 3});
  squared_sum_ += weighted * weighted;
  if (row.weight > 0) image_sum_ += known.share * weighted / static_cast<double>(row.weight);
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
