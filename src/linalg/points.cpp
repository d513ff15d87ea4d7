#include "linalg/points.h"

#include <cmath>

#include "base/parallel.h"

namespace lumirank::linalg {

std::vector<double> own_norms(const Points& points) {
  std::vector<double> norms(points.count);
  parallel_for(points.count, 4096, [&](std::size_t begin, std::size_t end) {
    for (std::size_t j = begin; j < end; ++j) {
      double s = 0;
      for (float v : points[j]) s += static_cast<double>(v) * static_cast<double>(v);
      norms[j] = std::sqrt(s);
    }
  });
  return norms;
}

}  // namespace lumirank::linalg
