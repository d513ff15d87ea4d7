#include "linalg/least_squares.h"

#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"
#endif

#include <Eigen/Cholesky>

namespace lumirank::linalg {

std::array<float, 4> solve_regularized4(const std::array<float, 10>& upper, const std::array<float, 4>& right,
                                        float ridge) {
  Eigen::Matrix4f square;
  std::size_t at = 0;
  for (int a = 0; a < 4; ++a)
    for (int b = a; b < 4; ++b) square(a, b) = square(b, a) = upper[at++];
  square.diagonal().array() += ridge * square.trace() / 4;
  const Eigen::Vector4f w = square.ldlt().solve(Eigen::Vector4f(right.data()));
  return {w[0], w[1], w[2], w[3]};
}

}  // namespace lumirank::linalg
