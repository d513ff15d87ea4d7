// What columns of spherical lights cost over columns of point lights: the same receivers, lights and columns,
// alternating in one run. Also how much noise the integrals themselves leave in the receivers' sums, over
// seeds.
//
//   bench_spheres [scene file]
//   environment: BENCH_LIGHTS (60000), BENCH_STRIDE (5: every fifth column), BENCH_WIDTH (200), BENCH_HEIGHT
//   (150), BENCH_SPP (4), BENCH_THREADS (all), BENCH_SCALE (0: automatic), BENCH_ROUNDS (7), BENCH_SEEDS (8)
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <string>

#include "base/parallel.h"
#include "base/random.h"
#include "bench_scene.h"
#include "methods/method.h"
#include "transport/cpu/scene_matrix.h"
#include "transport/lights/sphere_lights.h"

namespace {

using namespace lumirank;
using bench::setting;

transport::SceneMatrixSettings with_seed(int seed) {
  transport::SceneMatrixSettings settings;
  settings.seed = static_cast<std::uint64_t>(seed);
  return settings;
}

// The columns that a render would add up, 2000 of them, and their weights; a few of them, evenly chosen.
std::vector<matrix::ScaledColumn> pick_columns(const transport::SceneMatrix& matrix) {
  const auto method =
      methods::find_method("row-column-sampling").make({{"rows", "300"}, {"columns", "2000"}});
  const auto all = method->run(matrix, {}).combination;
  std::vector<matrix::ScaledColumn> some;
  const auto stride = static_cast<std::size_t>(setting("BENCH_STRIDE", 5));
  for (std::size_t k = 0; k < all.size(); k += stride) some.push_back(all[k]);
  return some;
}

void run(const std::string& file) {
  const bench::BenchScene scene(file, 200, 150);
  const world::World& world = scene.world;
  const transport::Receivers& receivers = scene.receivers;
  transport::LightSettings indirect;
  indirect.direct = false;
  const transport::VirtualLights points = scene.lights(60000, indirect);
  transport::VirtualLights spheres = points;
  make_spherical(spheres, world, {static_cast<float>(setting("BENCH_SCALE", 0))});

  const auto columns = pick_columns({world, receivers, points, {}});
  std::vector<Rgb> sums(receivers.size());

  double best[2] = {1e30, 1e30}, rays[2];
  std::vector<double> ratios;
  {
    const transport::SceneMatrix matrices[2] = {{world, receivers, points, {}},
                                                {world, receivers, spheres, {}}};
    for (int round = 0; round < setting("BENCH_ROUNDS", 7); ++round) {
      double seconds[2];
      for (const int kind : {0, 1}) {
        const std::clock_t start = std::clock();  // of all threads: others' programs do not count
        const matrix::Cost cost = matrices[kind].accumulate(columns, sums, {});
        seconds[kind] = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
        best[kind] = std::min(best[kind], seconds[kind]);
        rays[kind] = static_cast<double>(cost.rays);
      }
      ratios.push_back(seconds[1] / seconds[0]);
    }
  }
  std::sort(ratios.begin(), ratios.end());
  std::printf(
      "%s: points %.3f, spheres %.3f ms of CPU time a column, ratio of the least %.3f, median ratio %.3f; "
      "%.3f "
      "as many rays\n",
      file.c_str(), 1e3 * best[0] / static_cast<double>(columns.size()),
      1e3 * best[1] / static_cast<double>(columns.size()), best[1] / best[0], ratios[ratios.size() / 2],
      rays[1] / rays[0]);

  const int seeds = setting("BENCH_SEEDS", 8);
  if (seeds < 2) return;
  std::vector<double> sum(receivers.size()), sum2(receivers.size());
  for (int seed = 1; seed <= seeds; ++seed) {
    std::fill(sums.begin(), sums.end(), Rgb(0));
    transport::SceneMatrix(world, receivers, spheres, with_seed(seed)).accumulate(columns, sums, {});
    for (std::size_t i = 0; i < sums.size(); ++i) {
      const double v = mean(sums[i]);
      sum[i] += v, sum2[i] += v * v;
    }
  }
  double variance = 0, deviation = 0, square_of_mean = 0, total = 0;
  for (std::size_t i = 0; i < sum.size(); ++i) {
    const double mean = sum[i] / seeds;
    const double own = std::max(0.0, sum2[i] / seeds - mean * mean) * seeds / (seeds - 1);
    variance += own, deviation += std::sqrt(own);
    square_of_mean += mean * mean, total += mean;
  }
  std::printf(
      "  noise of the integrals: %.2f %% of the root mean square, deviations %.2f %% of the mean; mean "
      "%.6g\n",
      100 * std::sqrt(variance / square_of_mean), 100 * deviation / total,
      total / static_cast<double>(sum.size()));
}

}  // namespace

int main(int argc, char** argv) {
  const std::string file = argc > 1 ? argv[1] : std::string(LUMIRANK_EXAMPLES) + "/interior.xml";
  lumirank::with_threads(setting("BENCH_THREADS", 0), [&] { run(file); });
}
