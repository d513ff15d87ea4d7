#include "methods/row_column/exploration.h"

#include <cmath>

#include "base/parallel.h"

namespace lumirank::methods {

void Exploration::read(const SampledRow& row) {
  matrix_.row(row.row, buffer_);
  static_assert(sizeof(Rgb) == 3 * sizeof(float));
  sketch_.add_row(row.row, row.weight, {reinterpret_cast<const float*>(buffer_.data()), buffer_.size() * 3});
  struct Sum {
    double r = 0, g = 0, b = 0, scalar = 0;
    Sum operator+(const Sum& o) const { return {r + o.r, g + o.g, b + o.b, scalar + o.scalar}; }
  };
  const Sum sum = parallel_sum(buffer_.size(), 8192, Sum{}, [&](std::size_t begin, std::size_t end) {
    Sum s;
    for (std::size_t j = begin; j < end; ++j) {
      const Rgb v = buffer_[j];
      s = s + Sum{static_cast<double>(v.r), static_cast<double>(v.g), static_cast<double>(v.b),
                  static_cast<double>(norm2(v))};
    }
    return s;
  });
  rows_.push_back(row);
  exact_.push_back({static_cast<float>(sum.r), static_cast<float>(sum.g), static_cast<float>(sum.b)});
  const double weighted = static_cast<double>(row.weight) * sum.scalar;
  squared_sum_ += weighted * weighted;
}

double Exploration::measured_error(std::span<const Rgb> sums) const {
  double difference = 0, size = 0;
  for (std::size_t k = 0; k < rows_.size(); ++k) {
    const double w2 = static_cast<double>(rows_[k].weight) * static_cast<double>(rows_[k].weight);
    for (int c = 0; c < 3; ++c) {
      const double truth = static_cast<double>(exact_[k][c]);
      const double d = static_cast<double>(sums[rows_[k].row][c]) - truth;
      difference += w2 * d * d;
      size += w2 * truth * truth;
    }
  }
  return difference == 0 ? 0 : std::sqrt(difference / size);
}

}  // namespace lumirank::methods
