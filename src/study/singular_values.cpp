#include "study/singular_values.h"

#include <algorithm>

#include "base/random.h"
#include "linalg/svd.h"

namespace lumirank::study {
namespace {

// One from each of `count` strata.
std::vector<matrix::Index> stratified_indices(std::size_t count, std::size_t of, std::uint64_t seed,
                                              std::uint64_t stream) {
  count = std::min(count, of);
  std::vector<matrix::Index> chosen(count);
  Rng rng(seed, Stage::benchmark, stream);
  for (std::size_t k = 0; k < count; ++k)
    chosen[k] = static_cast<matrix::Index>((static_cast<double>(k) + rng.next_double()) *
                                           static_cast<double>(of) / static_cast<double>(count));
  return chosen;
}

}  // namespace

std::vector<double> singular_values_of(const matrix::LightingMatrix& matrix, std::uint64_t seed) {
  constexpr std::size_t kRows = 1200, kColumns = 1000;
  const auto rows = stratified_indices(kRows, matrix.rows(), seed, 1);
  const auto columns = stratified_indices(kColumns, matrix.columns(), seed, 2);
  std::vector<Rgb> block(rows.size() * columns.size());
  matrix.block(rows, columns, block, matrix::Part::value);
  std::vector<float> scalar(block.size());
  for (std::size_t k = 0; k < block.size(); ++k) scalar[k] = norm2(block[k]);
  return linalg::singular_values(scalar, rows.size(), columns.size());
}

}  // namespace lumirank::study
