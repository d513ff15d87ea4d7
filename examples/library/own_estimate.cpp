// An estimator of one's own on the lighting matrix: columns drawn in proportion to their power, each scaled
// by one over the expected number of its draws. Its mean is what all columns add up to.
//   own_estimate PICTURE
#include <cmath>
#include <cstdio>
#include <random>

#include "lumirank/session.h"
#include "room.h"

namespace {

double sum_of(const std::vector<lumirank::Rgb>& sums) {
  double sum = 0;
  for (const auto& s : sums)
    sum += static_cast<double>(s.r) + static_cast<double>(s.g) + static_cast<double>(s.b);
  return sum;
}

std::vector<lumirank::WeightedColumn> draw(const lumirank::Matrix& matrix, int count, unsigned seed) {
  const auto power = matrix.column_features().power;
  std::mt19937 random(seed);
  std::discrete_distribution<lumirank::Index> choose(power.begin(), power.end());
  const std::vector<double> probability = choose.probabilities();
  std::vector<lumirank::WeightedColumn> columns;
  for (int k = 0; k < count; ++k) {
    const lumirank::Index j = choose(random);
    columns.push_back({j, lumirank::Rgb(static_cast<float>(1 / (count * probability[j])))});
  }
  return columns;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) return std::fprintf(stderr, "own_estimate PICTURE\n"), 2;
  try {
    lumirank::RenderSettings settings;
    settings.lights.count = 3000;
    settings.view.spp = 1;
    const lumirank::Prepared prepared = lumirank::prepare(room().build(), settings);
    const lumirank::Matrix matrix = prepared.matrix();

    // What all columns add up to, from the matrix itself.
    std::vector<lumirank::WeightedColumn> all(matrix.columns());
    for (std::size_t j = 0; j < all.size(); ++j) all[j].column = static_cast<lumirank::Index>(j);
    std::vector<lumirank::Rgb> exact(matrix.rows());
    matrix.accumulate(all, exact);

    constexpr int kRuns = 64, kColumns = 100;
    double mean = 0, squares = 0;
    lumirank::Estimate estimate;
    for (unsigned seed = 0; seed < kRuns; ++seed) {
      estimate.sums.assign(matrix.rows(), {});
      matrix.accumulate(draw(matrix, kColumns, seed), estimate.sums);
      const double ratio = sum_of(estimate.sums) / sum_of(exact);
      mean += ratio / kRuns, squares += ratio * ratio / kRuns;
    }
    const double deviation = std::sqrt((squares - mean * mean) / kRuns);
    std::printf("mean over %d runs of %d columns: %.4f ± %.4f of what all %zu columns add up to\n", kRuns,
                kColumns, mean, deviation, matrix.columns());
    lumirank::write_picture(argv[1], lumirank::develop(prepared, estimate));
    return std::abs(mean - 1) < 4 * deviation ? 0 : 1;
  } catch (const lumirank::InputError& error) {
    return std::fprintf(stderr, "%s\n", error.what()), 2;
  }
}
