// How unevenly the light of a scene is shared out among its virtual lights: single heavy ones make colored
// glows where they stand near a surface.
//
//   bench_light_powers scene [--size 320x180] [--lights 100000] [--seed 1] [--receivers 512]
//
// Prints, of the particles' lights: how many there are and on how many paths; how many of the receivers'
// lights they are worth, (Σc)²/Σc², where c is what a light sends to all receivers together; power over the
// mean power of those that reach a receiver, as quantiles; and the part of the receivers' indirect light that
// comes from the one strongest light of each.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "base/error.h"
#include "base/timer.h"
#include "pipeline/prepared.h"
#include "scenedesc/readers.h"
#include "transport/cpu/scene_matrix.h"

namespace {

using namespace lumirank;

struct Options {
  std::string scene;
  int width = 320, height = 180;
  std::size_t lights = 100000, receivers = 512;
  std::uint64_t seed = 1;
};

Options read_options(int argc, char** argv) {
  Options o;
  for (int k = 1; k < argc; ++k) {
    const std::string name = argv[k];
    if (name.rfind("--", 0) != 0) {
      o.scene = name;
      continue;
    }
    if (++k == argc) throw InputError(name + " needs a value");
    if (name == "--size") {
      if (std::sscanf(argv[k], "%dx%d", &o.width, &o.height) != 2) throw InputError("--size WIDTHxHEIGHT");
    } else if (name == "--lights") {
      o.lights = std::stoul(argv[k]);
    } else if (name == "--seed") {
      o.seed = std::stoul(argv[k]);
    } else if (name == "--receivers") {
      o.receivers = std::stoul(argv[k]);
    } else {
      throw InputError(name + " is unknown");
    }
  }
  if (o.scene.empty()) throw InputError("which scene?");
  return o;
}

double quantile(const std::vector<double>& sorted, double q) {
  if (sorted.empty()) return 0;
  return sorted[std::min(sorted.size() - 1,
                         static_cast<std::size_t>(q * static_cast<double>(sorted.size())))];
}

void run(const Options& options) {
  const scenedesc::SceneDesc desc = scenedesc::read_scene(options.scene);
  std::vector<scenedesc::Warning> warnings;
  const auto world = std::make_shared<world::World>(world::World::build(desc, {}, warnings));
  RenderSettings settings;
  settings.view.width = options.width, settings.view.height = options.height;
  settings.view.spp = 1, settings.seed = options.seed;
  const world::View view = pipeline::make_view(desc, settings.view);
  const auto prepared =
      pipeline::prepare(world, view, pipeline::make_recipe(settings, view), options.lights, {}, {});
  const double seconds = prepared->seconds.at("lights");
  const transport::VirtualLights& lights = prepared->lights();
  const matrix::LightingMatrix& matrix = *prepared->matrix;

  std::vector<double> column(lights.size(), 0.0);
  std::vector<Rgb> row(lights.size());
  double total = 0, strongest = 0, strongest_of_one = 0;
  const std::size_t step = std::max<std::size_t>(1, matrix.rows() / options.receivers);
  for (std::size_t i = 0; i < matrix.rows(); i += step) {
    matrix.row(static_cast<matrix::Index>(i), row, matrix::Part::value);
    const float weight = max_component(prepared->receivers().weight[i]);
    double sum = 0, max_value = 0;
    for (std::size_t j = 0; j < lights.size(); ++j) {
      if (lights.kind[j] != transport::LightKind::surface) continue;
      const double value = static_cast<double>(weight) * max_component(row[j]);
      column[j] += value, sum += value, max_value = std::max(max_value, value);
    }
    total += sum, strongest += max_value;
    strongest_of_one = std::max(strongest_of_one, max_value);
  }
  std::vector<double> powers;
  double sum = 0, squares = 0, max_value = 0, mean_power = 0;
  for (std::size_t j = 0; j < lights.size(); ++j) {
    if (!(column[j] > 0)) continue;
    sum += column[j], squares += column[j] * column[j], max_value = std::max(max_value, column[j]);
    powers.push_back(
        max_component(lights.power[j] * scatter::albedo(lights.closure_at(j), lights.incoming[j])));
    mean_power += powers.back();
  }
  std::sort(powers.begin(), powers.end());
  mean_power /= static_cast<double>(std::max<std::size_t>(1, powers.size()));
  std::printf("lights %zu (emitter samples %zu), paths %zu, %.2f s\n", lights.size(), lights.direct_count,
              lights.paths, seconds);
  std::printf("reach a receiver %zu, worth %.0f; strongest column %.2f %% of all indirect light\n",
              powers.size(), squares > 0 ? sum * sum / squares : 0.0,
              100 * max_value / std::max(sum, 1e-300));
  std::printf("power / mean: 10 %% %.3g, 50 %% %.3g, 90 %% %.3g, 99 %% %.3g, 99.9 %% %.3g, greatest %.3g\n",
              quantile(powers, 0.1) / mean_power, quantile(powers, 0.5) / mean_power,
              quantile(powers, 0.9) / mean_power, quantile(powers, 0.99) / mean_power,
              quantile(powers, 0.999) / mean_power, quantile(powers, 1) / mean_power);
  std::printf("strongest light of each receiver: %.2f %% of its indirect light; strongest entry %.3g %%\n",
              100 * strongest / std::max(total, 1e-300), 100 * strongest_of_one / std::max(total, 1e-300));
}

}  // namespace

int main(int argc, char** argv) {
  try {
    run(read_options(argc, argv));
  } catch (const std::exception& e) {
    std::fprintf(stderr, "%s\n", e.what());
    return 2;
  }
  return 0;
}
