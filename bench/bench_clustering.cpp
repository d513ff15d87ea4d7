// Seconds of everything in row-column sampling that is neither a row nor a column: taking rows in,
// clustering, and choosing representatives. Lights and receivers on the walls of a box stand for a scene;
// visibility is a random half-space per light.
//   bench_clustering --benchmark_filter=.*
#include <benchmark/benchmark.h>

#include <numeric>
#include <vector>

#include "base/parallel.h"
#include "base/random.h"
#include "linalg/clustering.h"
#include "linalg/column_sketch.h"
#include "linalg/multiset_sampling.h"
#include "methods/common/representatives.h"

namespace {

using namespace lumirank;

struct WallPoint {
  Vec3f position, normal;
};

WallPoint on_wall(Rng& rng) {
  const int axis = static_cast<int>(rng.next_below(3));
  const bool far_side = rng.next_float() < 0.5f;
  WallPoint p;
  for (int a = 0; a < 3; ++a) p.position[a] = rng.next_float();
  p.position[axis] = far_side ? 1.0f : 0.0f;
  p.normal[axis] = far_side ? -1.0f : 1.0f;
  return p;
}

std::vector<float> wall_row(std::uint64_t receiver, std::size_t lights) {
  Rng receiver_rng(1, Stage::benchmark, 0, receiver);
  const WallPoint x = on_wall(receiver_rng);
  std::vector<float> row(lights * 3);
  parallel_for(lights, 4096, [&](std::size_t begin, std::size_t end) {
    for (std::size_t j = begin; j < end; ++j) {
      Rng rng(1, Stage::benchmark, 1, j);
      const WallPoint y = on_wall(rng);
      const Vec3f d = y.position - x.position;
      const float squared = std::max(length_squared(d), 1e-3f);
      const float cosines = std::max(0.0f, dot(d, x.normal)) * std::max(0.0f, -dot(d, y.normal)) / squared;
      const Vec3f blocker{rng.next_float() - 0.5f, rng.next_float() - 0.5f, rng.next_float() - 0.5f};
      const float visible =
          dot(x.position - Vec3f{0.5f, 0.5f, 0.5f}, blocker) > -0.3f * length(blocker) ? 1.0f : 0.0f;
      for (int c = 0; c < 3; ++c)
        row[j * 3 + static_cast<std::size_t>(c)] = visible * (0.2f + rng.next_float()) * cosines / squared;
    }
  });
  return row;
}

linalg::ColumnSketch& explored(std::size_t lights, std::size_t rows) {
  static std::size_t last = 0;
  static std::unique_ptr<linalg::ColumnSketch> sketch;
  if (last != lights) {
    last = lights;
    sketch.reset();
    sketch = std::make_unique<linalg::ColumnSketch>(linalg::ColumnSketch::Shape{lights, 50}, 1);
    for (std::size_t i = 0; i < rows; ++i) sketch->add_row(i, 1, wall_row(i, lights));
    sketch->points();
  }
  return *sketch;
}

void take_rows(benchmark::State& state) {
  const auto lights = static_cast<std::size_t>(state.range(0));
  const auto row = wall_row(0, lights);
  for (auto _ : state) {
    linalg::ColumnSketch sketch({lights, 50}, 1);
    for (std::uint64_t i = 0; i < 300; ++i) sketch.add_row(i, 1, row);
    benchmark::DoNotOptimize(sketch.points().units);
  }
}

void cluster_columns(benchmark::State& state) {
  const auto lights = static_cast<std::size_t>(state.range(0));
  auto& sketch = explored(lights, 300);
  const linalg::ClusteringSettings settings{static_cast<linalg::ClusteringAlgorithm>(state.range(2)),
                                            static_cast<std::size_t>(state.range(1)), 1};
  double cost = 0;
  for (auto _ : state) {
    const auto points = sketch.points();
    const auto norms = linalg::own_norms(points);
    std::vector<std::uint32_t> lit;
    for (std::uint32_t j = 0; j < lights; ++j)
      if (!sketch.is_zero(j)) lit.push_back(j);
    const auto splitter = linalg::cluster(points, norms, lit, {}, settings);
    const auto chosen = methods::choose_representatives(splitter.partition(), sketch,
                                                        methods::selection_weights(lit, sketch, {}, 0.1), {});
    benchmark::DoNotOptimize(chosen.columns.data());
    cost = splitter.cost();
  }
  const auto points = sketch.points();
  linalg::PointSum sum(points.dimension);
  linalg::PointReader reader(points);
  for (std::size_t j = 0; j < lights; ++j) sum.add(reader[j], 0);
  state.counters["relative_error"] = std::sqrt(cost / sum.squared_length());
}

BENCHMARK(take_rows)->Arg(100000)->Arg(1000000)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(cluster_columns)
    ->ArgNames({"lights", "columns", "algorithm"})
    ->ArgsProduct({{100000}, {300, 900, 3000}, {0, 1, 2}})
    ->ArgsProduct({{1000000}, {900}, {0, 1, 2}})
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

}  // namespace

BENCHMARK_MAIN();
