#include "methods/common/held_out_rows.h"

#include "base/parallel.h"

namespace lumirank::methods {

void HeldOutRows::read(const SampledRow& row, std::span<Rgb> values) {
  keep(known_.read(row, values), values);
}

void HeldOutRows::add(const ExactRow& row, std::span<const Rgb> values) {
  known_.add(row);
  keep(row, values);
}

void HeldOutRows::keep(const ExactRow& row, std::span<const Rgb> values) {
  std::vector<float> scalars(values.size());
  const double sum = parallel_sum(values.size(), 8192, 0.0, [&](std::size_t begin, std::size_t end) {
    double s = 0;
    for (std::size_t j = begin; j < end; ++j) {
      const float scalar = norm2(values[j]);
      scalars[j] = row.from.weight * scalar;
      s += static_cast<double>(scalar);
    }
    return s;
  });
  entries_.add(scalars);
  image_sum_ += row.share * sum;
}

}  // namespace lumirank::methods
