#include "linalg/svd.h"

// g++ 12 takes the undefined lanes inside its own AVX-512 intrinsics for uninitialized variables.
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"
#endif

#include <Eigen/Dense>
#include <algorithm>

#include "base/error.h"
#include "base/random.h"

namespace lumirank::linalg {

namespace {

using RowMajor = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
using Dense = Eigen::MatrixXd;

Dense in_double(std::span<const float> matrix, std::size_t rows, std::size_t columns) {
  if (matrix.size() != rows * columns) throw InternalError("svd: wrong number of entries");
  return Eigen::Map<const RowMajor>(matrix.data(), static_cast<Eigen::Index>(rows),
                                    static_cast<Eigen::Index>(columns))
      .cast<double>();
}

Dense orthonormal(const Dense& a) {
  const Eigen::HouseholderQR<Dense> qr(a);
  return qr.householderQ() * Dense::Identity(a.rows(), a.cols());
}

std::vector<float> row_major(const Dense& a) {
  std::vector<float> out(static_cast<std::size_t>(a.size()));
  Eigen::Map<RowMajor>(out.data(), a.rows(), a.cols()) = a.cast<float>();
  return out;
}

}  // namespace

std::vector<double> singular_values(std::span<const float> matrix, std::size_t rows, std::size_t columns) {
  if (rows == 0 || columns == 0) return {};
  const Eigen::BDCSVD<Dense> svd(in_double(matrix, rows, columns));
  const auto& s = svd.singularValues();
  return {s.data(), s.data() + s.size()};
}

TruncatedSvd randomized_svd(std::span<const float> matrix, std::size_t rows, std::size_t columns,
                            const RandomizedSvdSettings& settings) {
  TruncatedSvd result;
  const std::size_t smaller = std::min(rows, columns);
  if (smaller == 0) return result;
  const Dense a = in_double(matrix, rows, columns);
  const auto rank = static_cast<Eigen::Index>(std::min(settings.rank, smaller));
  const auto width = static_cast<Eigen::Index>(std::min(settings.rank + settings.oversampling, smaller));
  Rng rng(settings.seed, Stage::projection, 0x535644);
  const Dense gaussian = Dense::NullaryExpr(a.cols(), width, [&] { return rng.next_gaussian(); });
  Dense q = orthonormal(a * gaussian);
  for (std::size_t step = 0; step < settings.power_steps; ++step) {
    const Dense z = orthonormal(a.transpose() * q);
    q = orthonormal(a * z);
  }
  const Dense small = q.transpose() * a;  // width × columns
  const Eigen::BDCSVD<Dense> svd(small, Eigen::ComputeThinU | Eigen::ComputeThinV);
  const auto& s = svd.singularValues();
  result.values.assign(s.data(), s.data() + rank);
  result.u = row_major(q * svd.matrixU().leftCols(rank));
  result.v = row_major(svd.matrixV().leftCols(rank));
  return result;
}

}  // namespace lumirank::linalg
