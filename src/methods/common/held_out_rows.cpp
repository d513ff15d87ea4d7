#include "methods/common/held_out_rows.h"

#include "base/parallel.h"

namespace lumirank::methods {

void HeldOutRows::read(const SampledRow& row, std::span<Rgb> values) {
  const ExactRow& known = known_.read(row, values);
  std::vector<float> scalars(values.size());
  const double sum = parallel_sum(values.size(), 8192, 0.0, [&](std::size_t begin, std::size_t end) {
    double s = 0;
    for (std::size_t j = begin; j < end; ++j) {
      const float scalar = norm2(values[j]);
      scalars[j] = row.weight * scalar;
      s += static_cast<double>(scalar);
    }
    return s;
  });
  entries_.add(scalars);
  image_sum_ += known.share * sum;
}

}  // namespace lumirank::methods
