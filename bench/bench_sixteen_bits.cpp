// What 16-bit columns cost a clustering of real lights: the expected error of the estimate at receivers that
// no clustering has seen, computed from all of their entries, once with clusters of 16-bit points and once
// with those of single precision (the same projection, the same seeds). Prints both and their ratio.
//
//   bench_sixteen_bits scene.xml …
//   environment: BENCH_LIGHTS (20000), BENCH_ROWS (300), BENCH_COLUMNS (900), BENCH_SEEDS (8),
//   BENCH_UNSEEN (400), BENCH_WIDTH (200), BENCH_HEIGHT (150)
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <numeric>

#include "base/parallel.h"
#include "base/random.h"
#include "linalg/blas.h"
#include "linalg/clustering.h"
#include "linalg/column_sketch.h"
#include "methods/common/row_sampler.h"
#include "scenedesc/readers.h"
#include "transport/cpu/scene_matrix.h"
#include "transport/lights/virtual_lights.h"
#include "transport/rows/receivers.h"
#include "world/world.h"

namespace {

using namespace lumirank;

std::size_t setting(const char* name, std::size_t otherwise) {
  const char* text = std::getenv(name);
  return text ? static_cast<std::size_t>(std::atoll(text)) : otherwise;
}

constexpr std::size_t kDimension = 50;

// Scalar entries of some rows, times their weights; row-major.
struct Rows {
  std::vector<methods::SampledRow> which;
  std::vector<float> scalars;
};

Rows read(const matrix::LightingMatrix& matrix, std::vector<methods::SampledRow> which,
          linalg::ColumnSketch* sketch) {
  const std::size_t n = matrix.columns();
  Rows rows{std::move(which), {}};
  rows.scalars.resize(rows.which.size() * n);
  std::vector<Rgb> values(n);
  for (std::size_t i = 0; i < rows.which.size(); ++i) {
    const methods::SampledRow& row = rows.which[i];
    matrix.row(row.row, values, matrix::Part::value);
    for (std::size_t j = 0; j < n; ++j) rows.scalars[i * n + j] = row.weight * norm2(values[j]);
    if (sketch) sketch->add_row(row.row, row.weight, {reinterpret_cast<const float*>(values.data()), n * 3});
  }
  return rows;
}

std::vector<float> projected(const Rows& rows, std::size_t n, std::uint64_t seed) {
  const std::size_t r = rows.which.size();
  std::vector<float> gaussian(r * kDimension), points(n * kDimension);
  for (std::size_t i = 0; i < r; ++i) {
    Rng rng(seed, Stage::projection, rows.which[i].row);
    for (std::size_t d = 0; d < kDimension; ++d)
      gaussian[i * kDimension + d] =
          static_cast<float>(rng.next_gaussian() / std::sqrt(static_cast<double>(kDimension)));
  }
  linalg::gemm({n, kDimension, r, true}, rows.scalars.data(), n, gaussian.data(), kDimension, points.data(),
               kDimension);
  return points;
}

// Relative L1, as ReducedMatrix expects it: Σ over rows of the standard deviation of the estimate, with
// representatives drawn by their norm.
double expected_error(const Rows& rows, std::size_t n, const linalg::Partition& clusters,
                      const linalg::ColumnSketch& sketch) {
  struct Sums {
    double deviation = 0, light = 0;
    Sums operator+(const Sums& o) const { return {deviation + o.deviation, light + o.light}; }
  };
  const Sums sums = parallel_sum(rows.which.size(), 1, Sums{}, [&](std::size_t i, std::size_t) {
    const float* row = rows.scalars.data() + i * n;
    double variance = 0;
    for (std::size_t k = 0; k < clusters.clusters(); ++k) {
      double s = 0, sum = 0, squares = 0;
      for (std::uint32_t j : clusters.members(k)) {
        const double x = static_cast<double>(row[j]), q = static_cast<double>(sketch.norm(j));
        s += q, sum += x, squares += x * x / q;
      }
      variance += std::max(0.0, s * squares - sum * sum);
    }
    return Sums{std::sqrt(variance), std::accumulate(row, row + n, 0.0)};
  });
  return 0.79788456 * sums.deviation / sums.light;
}

void compare(const char* file) {
  const scenedesc::SceneDesc desc = scenedesc::read_scene(file, {});
  std::vector<scenedesc::Warning> warnings;
  const world::World world = world::World::build(desc, {}, warnings);
  auto sensor = desc.sensors.at(0);
  sensor.film.width = static_cast<int>(setting("BENCH_WIDTH", 200));
  sensor.film.height = static_cast<int>(setting("BENCH_HEIGHT", 150));
  const auto receivers = transport::trace_receivers(world, world::Camera(sensor), {});
  transport::LightSettings ls;
  ls.count = setting("BENCH_LIGHTS", 20000);
  ls.receivers = &receivers;
  const auto lights = transport::trace_virtual_lights(world, ls);
  transport::SceneMatrixSettings ms;
  ms.clamp = 0.03f;
  const transport::SceneMatrix matrix(world, receivers, lights, ms);
  const std::size_t n = matrix.columns(), seeds = setting("BENCH_SEEDS", 8);
  const Rows unseen =
      read(matrix, methods::RowSampler(matrix, 1).stratified(setting("BENCH_UNSEEN", 400), 99), nullptr);

  double sum = 0, squares = 0, error_short = 0, error_float = 0;
  for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
    linalg::ColumnSketch sketch({n, kDimension}, seed);
    const Rows seen =
        read(matrix, methods::RowSampler(matrix, seed).stratified(setting("BENCH_ROWS", 300)), &sketch);
    const std::vector<float> floats = projected(seen, n, seed);
    std::vector<std::uint32_t> lit;
    for (std::uint32_t j = 0; j < n; ++j)
      if (!sketch.is_zero(j)) lit.push_back(j);
    const auto error = [&](const linalg::Points& points) {
      const auto norms = linalg::own_norms(points);
      const auto clusters =
          linalg::cluster(points, norms, lit, {},
                          {linalg::ClusteringAlgorithm::combined, setting("BENCH_COLUMNS", 900), seed});
      return expected_error(unseen, n, clusters.partition(), sketch);
    };
    const double in_short = error(sketch.points()), in_float = error({floats.data(), n, kDimension});
    const double ratio = in_short / in_float;
    sum += ratio, squares += ratio * ratio;
    error_short += in_short, error_float += in_float;
  }
  const double count = static_cast<double>(seeds), mean = sum / count;
  const double deviation = std::sqrt(std::max(0.0, squares / count - mean * mean) / (count - 1));
  std::printf("%s: expected error %.4f in 16 bits, %.4f in single precision; ratio %.4f ± %.4f (%zu seeds)\n",
              file, error_short / count, error_float / count, mean, deviation, seeds);
}

}  // namespace

int main(int argc, char** argv) {
  for (int a = 1; a < argc; ++a) compare(argv[a]);
}
