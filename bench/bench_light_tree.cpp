// Building light trees over made-up lights: seconds, bytes, and how tight the clusters are.
#include <benchmark/benchmark.h>

#include "base/random.h"
#include "base/warp.h"
#include "matrix/lighting_matrix.h"
#include "methods/common/light_tree/light_tree.h"

namespace lumirank {
namespace {

using matrix::ColumnSet;
using matrix::Cost;
using matrix::Index;

// Lights on the walls, the floor and the ceiling of a room, brighter ones fewer, in no order; no entries.
class MadeUpLights final : public matrix::LightingMatrix {
 public:
  explicit MadeUpLights(std::size_t count) {
    Rng rng(1, Stage::test);
    for (std::size_t j = 0; j < count; ++j) {
      const auto axis = static_cast<int>(rng.next_below(3));
      const float side = rng.next_float() < 0.5f ? -1.0f : 1.0f;
      Vec3f p{2 * rng.next_float() - 1, 2 * rng.next_float() - 1, 2 * rng.next_float() - 1}, n;
      p[axis] = side, n[axis] = -side;
      position_.push_back(p);
      normal_.push_back(normalize(n + 0.2f * warp_sphere(rng.next_2d())));
      emitted_.push_back(Rgb(0.1f / (0.1f + rng.next_float())));
    }
  }
  std::size_t rows() const override { return 0; }
  std::size_t columns() const override { return position_.size(); }
  Cost row(Index, std::span<Rgb>, matrix::Part) const override { return {}; }
  Cost column(Index, std::span<Rgb>, matrix::Part) const override { return {}; }
  Cost block(std::span<const Index>, std::span<const Index>, std::span<Rgb>, matrix::Part) const override {
    return {};
  }
  Cost entries(std::span<const Index>, std::span<const Index>, std::span<Rgb>, matrix::Part) const override {
    return {};
  }
  Cost accumulate(std::span<const matrix::ScaledColumn>, std::span<Rgb>, const Sinks&) const override {
    return {};
  }
  ColumnSet column_set(Index j) const override {
    ColumnSet set;
    set.emission = matrix::Emission::oriented;
    set.box.extend(position_[j]);
    set.cone = {normal_[j], 1};
    set.intensity = emitted_[j];
    return set;
  }
  matrix::ColumnFeatures column_features() const override {
    matrix::ColumnFeatures features;
    features.emitted = emitted_;
    return features;
  }

 private:
  std::vector<Vec3f> position_, normal_;
  std::vector<Rgb> emitted_;
};

void build_light_tree(benchmark::State& state) {
  const MadeUpLights lights(static_cast<std::size_t>(state.range(0)));
  for (auto _ : state) {
    const methods::LightTree tree(lights, 1);
    state.counters["bytes per light"] =
        static_cast<double>(tree.memory_bytes()) / static_cast<double>(lights.columns());
    // Walter's measure over the nodes of a cut of a thousand: by intensity the greatest is refined.
    std::vector<methods::LightTree::Node> cut(tree.roots().begin(), tree.roots().end());
    double cost = 0;
    const auto measure = [&](methods::LightTree::Node node) {
      const ColumnSet set = tree.set(node);
      return mean(set.intensity) * (length_squared(set.box.diagonal()) + 3 * square(1 - set.cone.cosine));
    };
    while (cut.size() < 1000) {
      std::size_t best = 0;
      for (std::size_t k = 1; k < cut.size(); ++k)
        if (measure(cut[k]) > measure(cut[best])) best = k;
      const auto node = cut[best];
      cut[best] = tree.left(node), cut.push_back(tree.right(node));
    }
    for (const auto node : cut) cost += static_cast<double>(measure(node));
    state.counters["measure of 1000"] = cost;
  }
}
BENCHMARK(build_light_tree)
    ->Arg(100'000)
    ->Arg(1'000'000)
    ->Arg(10'000'000)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

}  // namespace
}  // namespace lumirank

BENCHMARK_MAIN();
