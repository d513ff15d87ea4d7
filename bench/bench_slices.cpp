// What entries cost by the way they are asked for, in nanoseconds of one core: whole columns, the columns of
// slices, of these E alone, and single visibilities here and there in a slice. The last is what sampling a
// slice costs per ray, the third what knowing E everywhere costs: a method that predicts visibility pays if
// both together, and its own arithmetic, are less than the second.
//
//   bench_slices [scene file]
//   environment: BENCH_LIGHTS (100000), BENCH_COLUMNS (100), BENCH_WIDTH (800), BENCH_HEIGHT (600), BENCH_SPP
//   (4), BENCH_SHARE (3: per cent of a slice's entries that are single), BENCH_ROUNDS (5),
//   BENCH_ONLY (0: all ways)
#include <algorithm>
#include <cstdio>
#include <ctime>
#include <functional>
#include <string>

#include "base/parallel.h"
#include "base/random.h"
#include "bench_scene.h"
#include "matrix/entry_reader.h"
#include "matrix/metered_matrix.h"
#include "methods/common/slices/slices.h"
#include "transport/cpu/scene_matrix.h"

namespace {

using namespace lumirank;
using bench::setting;
using matrix::Index;
using matrix::Part;

// Each slice on one thread.
void for_slices(const matrix::LightingMatrix& matrix, const methods::Slices& slices,
                const std::function<void(matrix::EntryReader&, std::span<const Index>)>& body) {
  parallel_for(slices.count(), 1, [&](std::size_t s, std::size_t) {
    const auto reader = matrix.reader();
    body(*reader, slices.slice(s));
  });
}

void run(const std::string& file) {
  const bench::BenchScene scene(file, 800, 600);
  const transport::VirtualLights lights = scene.lights(100000);
  const transport::SceneMatrix scene_matrix(scene.world, scene.receivers, lights, {});
  const matrix::MeteredMatrix matrix(scene_matrix);
  const methods::Slices slices = methods::make_slices(matrix.row_features(), matrix.rows());

  Rng rng(1, Stage::benchmark);
  std::vector<matrix::ScaledColumn> columns(static_cast<std::size_t>(setting("BENCH_COLUMNS", 100)));
  for (auto& c : columns) c.column = static_cast<Index>(rng.next_below(lights.size()));
  std::vector<Rgb> sums(matrix.rows());

  const auto slice_columns = [&](Part part) {
    for_slices(matrix, slices, [&](matrix::EntryReader& reader, std::span<const Index> rows) {
      std::vector<Rgb> out(rows.size());
      reader.set_rows(rows);
      for (const auto& c : columns) reader.column(c.column, out, part);
    });
  };
  const auto singles = [&] {
    for_slices(matrix, slices, [&](matrix::EntryReader& reader, std::span<const Index> rows) {
      Rng random(2, Stage::benchmark, rows.front());
      const std::size_t each =
          std::max<std::size_t>(1, rows.size() * static_cast<std::size_t>(setting("BENCH_SHARE", 3)) / 100);
      std::vector<std::uint32_t> i;
      std::vector<Index> j;
      for (const auto& c : columns)
        for (std::size_t k = 0; k < each; ++k)
          i.push_back(static_cast<std::uint32_t>(random.next_below(rows.size()))), j.push_back(c.column);
      std::vector<Rgb> out(i.size());
      reader.set_rows(rows);
      reader.entries_at(i, j, out, Part::visibility);
    });
  };
  const struct {
    const char* name;
    std::function<void()> go;
  } ways[] = {{"whole columns", [&] { matrix.accumulate(columns, sums, {}); }},
              {"columns of slices", [&] { slice_columns(Part::value); }},
              {"columns of slices, E alone", [&] { slice_columns(Part::unoccluded); }},
              {"single visibilities in slices", singles}};
  std::printf("%s: %zu receivers in %zu slices, %zu lights, %zu columns\n", file.c_str(), matrix.rows(),
              slices.count(), lights.size(), columns.size());
  int number = 0;
  for (const auto& way : ways) {
    if (const int only = setting("BENCH_ONLY", 0); ++number != only && only != 0) continue;
    double best_entry = 1e30, best_ray = 1e30, culled = 0;
    for (int round = 0; round < setting("BENCH_ROUNDS", 5); ++round) {
      const matrix::Cost before = matrix.total();
      const std::clock_t start = std::clock();  // of all threads: others' programs do not count
      way.go();
      const double ns = 1e9 * static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
      const matrix::Cost after = matrix.total();
      const auto entries = static_cast<double>(after.entries - before.entries);
      best_entry = std::min(best_entry, ns / entries);
      if (after.rays > before.rays)
        best_ray = std::min(best_ray, ns / static_cast<double>(after.rays - before.rays));
      culled = static_cast<double>(after.culled - before.culled) / entries;
    }
    std::printf("%-32s %7.1f ns per entry", way.name, best_entry);
    if (best_ray < 1e30) std::printf(", %7.1f ns per ray", best_ray);
    std::printf(", %.0f %% culled\n", 100 * culled);
  }
}

}  // namespace

int main(int argc, char** argv) {
  run(argc > 1 ? argv[1] : std::string(LUMIRANK_EXAMPLES) + "/interior.xml");
}
