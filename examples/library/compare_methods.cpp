// Two methods at two numbers of columns, each with two seeds, against the sum of all columns; the page with
// the pictures is written too. Then what there is to choose from.
//   compare_methods out
#include <cstdio>

#include "lumirank/compare.h"
#include "room.h"

int main(int argc, char** argv) {
  if (argc != 2) return std::fprintf(stderr, "usage: %s FOLDER\n", argv[0]), 2;
  try {
    const lumirank::Scene scene = room().build();
    lumirank::CompareSettings settings;
    settings.base.lights.count = 3000;
    settings.base.view.spp = 1;
    settings.methods = {"power-sampling", "row-column-sampling"};
    settings.reference.kind = lumirank::ComparisonReference::Kind::brute_force;
    for (const std::string& method : settings.methods)
      settings.sweeps.push_back({.method = method, .keys = {"columns"}, .values = {{"50"}, {"400"}}});
    settings.seeds = 2;
    settings.equal = lumirank::EqualCost::rays;
    const lumirank::Comparison comparison = lumirank::compare(scene, settings, argv[1]);

    for (const lumirank::ComparisonRun& run : comparison.runs)
      std::printf("%-36s seed %llu: %5.1f %% error, %.0f rays\n", run.label.c_str(),
                  static_cast<unsigned long long>(run.seed), 100 * run.error.relative_l1, run.rays);
    for (const std::string& note : comparison.notes) std::printf("%s\n", note.c_str());
    bool falls = comparison.runs.size() == 8;
    for (std::size_t k = 0; falls && k < 8; k += 4)  // few columns with two seeds, then many
      falls = comparison.runs[k + 2].error.relative_l2 < comparison.runs[k].error.relative_l2;

    const lumirank::SceneInfo info = scene.info();
    std::printf("%llu triangles, %zu emitters; %zu methods\n",
                static_cast<unsigned long long>(info.triangles), info.emitters.size(),
                lumirank::list_methods().size());
    return falls && info.emitters.size() == 2 ? 0 : 1;
  } catch (const lumirank::InputError& error) {
    return std::fprintf(stderr, "%s\n", error.what()), 2;
  }
}
