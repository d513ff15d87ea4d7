// What matrix sampling and recovery does inside (Huo et al. 2015, figures 4 to 7): how often each predictor
// is wrong, slice by slice, against all visibilities of the reduced matrices; how fast separations converge;
// and the matrices of two slices. bench/papers/sampling_recovery_2015.py calls it and paints the pictures.
//
//   inspect_recovery scene folder [--size 400x300] [--lights 20000] [--spp 4] [--seed 1] [--threads 0]
//                      [--set key=value …, of sampling-recovery]
//
// Writes results.json and pictures as PFM with numbers in place of colors:
//   image                      what the method renders
//   wrong_P, wrong_equal_P     share of the entries not sampled whose drawn prediction is wrong; P:
//   nearest,
//                              plane, bayes, all. Until the prediction error is met; _equal: all after the
//                              same five rounds. −1 where no receiver is.
//   choice                     share of tested columns: red nearest, green bayes, blue plane
//   few_M, many_M              matrices of two slices, rows along Hilbert's curve, columns along the light
//   tree
// Predictors are judged alone: no separation, no correction, no sampling where a guess would cost much.
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string>

#include "base/error.h"
#include "base/parallel.h"
#include "image/pfm.h"
#include "recovery_inspector.h"
#include "scenedesc/readers.h"
#include "transport/cpu/scene_matrix.h"
#include "transport/lights/virtual_lights.h"
#include "transport/rows/receivers.h"
#include "world/world.h"

namespace {

using namespace lumirank;

// A box filter: good enough to see what is where.
image::Image render(const transport::Receivers& receivers, std::span<const Rgb> sums) {
  image::Image image(receivers.width, receivers.height), count = image;
  std::vector<Rgb> light(receivers.emission);
  for (std::size_t i = 0; i < receivers.size(); ++i)
    light[receivers.sample[i]] += receivers.weight[i] * sums[i];
  for (std::size_t k = 0; k < light.size(); ++k) {
    const int x = std::clamp(static_cast<int>(receivers.film[k].x), 0, image.width - 1);
    const int y = std::clamp(static_cast<int>(receivers.film[k].y), 0, image.height - 1);
    image.at(x, y) += light[k];
    count.at(x, y) += Rgb(1);
  }
  for (std::size_t k = 0; k < image.pixels.size(); ++k)
    image.pixels[k] = image.pixels[k] * (1.0f / std::max(count.pixels[k].r, 1.0f));
  return image;
}

void run(const bench::InspectOptions& options) {
  std::filesystem::create_directories(options.folder);
  scenedesc::SceneDesc desc = scenedesc::read_scene(options.scene);
  desc.sensors.at(0).film.width = options.width;
  desc.sensors.at(0).film.height = options.height;
  std::vector<scenedesc::Warning> warnings;
  const world::World world = world::World::build(desc, {}, warnings);
  const transport::Receivers receivers = transport::trace_receivers(
      world, world::Camera(desc.sensors.at(0)), {.seed = options.seed, .spp = options.spp});
  transport::LightSettings light_settings;
  light_settings.seed = options.seed;
  light_settings.count = options.lights;
  light_settings.receivers = &receivers;
  const transport::VirtualLights lights = transport::trace_virtual_lights(world, light_settings);
  transport::SceneMatrixSettings matrix_settings;
  matrix_settings.seed = options.seed;
  matrix_settings.clamp = 0.03f;  // the renderer's default
  const transport::SceneMatrix matrix(world, receivers, lights, matrix_settings);

  bench::RecoveryInspector inspector(options, matrix);
  inspector.inspect();
  image::write_pfm((std::filesystem::path(options.folder) / "image.pfm").string(),
                   render(receivers, inspector.sums()));
  nlohmann::json report = inspector.summary();
  report["receivers"] = receivers.size();
  report["lights"] = lights.size();
  report["predictors"] = inspector.write_pictures();
  report["few"] = inspector.write_matrices(inspector.slice_at(0.25), "few");
  report["many"] = inspector.write_matrices(inspector.slice_at(0.9), "many");
  std::ofstream file(std::filesystem::path(options.folder) / "results.json");
  file << report.dump(1) << "\n";
  file.close();
  if (!file) throw InputError("results.json cannot be written to " + options.folder);
}

bench::InspectOptions read(int argc, char** argv) {
  bench::InspectOptions o;
  std::vector<std::string> plain;
  for (int k = 1; k < argc; ++k) {
    const std::string name = argv[k];
    if (name.rfind("--", 0) != 0) {
      plain.push_back(name);
      continue;
    }
    if (k + 1 == argc) throw InputError(name + " needs a value");
    const std::string value = argv[++k];
    if (name == "--size") {
      if (std::sscanf(value.c_str(), "%dx%d", &o.width, &o.height) != 2 || o.width < 1 || o.height < 1)
        throw InputError("--size " + value + " is not WIDTHxHEIGHT");
    } else if (name == "--set") {
      const std::size_t at = value.find('=');
      if (at == std::string::npos) throw InputError("--set " + value + " is not key=value");
      o.settings[value.substr(0, at)] = value.substr(at + 1);
    } else {
      std::size_t number = 0;
      if (!methods::parse_count(value, 0, methods::kMaxColumns, number))
        throw InputError(name + " needs a number");
      if (name == "--lights")
        o.lights = number;
      else if (name == "--spp")
        o.spp = static_cast<int>(number);
      else if (name == "--threads")
        o.threads = static_cast<int>(number);
      else if (name == "--seed")
        o.seed = number;
      else
        throw InputError("there is no option " + name);
    }
  }
  if (plain.size() != 2) throw InputError("inspect_recovery scene folder [options]");
  o.scene = plain[0], o.folder = plain[1];
  return o;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    const bench::InspectOptions options = read(argc, argv);
    with_threads(options.threads, [&] { run(options); });
  } catch (const std::exception& error) {
    std::fprintf(stderr, "inspect_recovery: %s\n", error.what());
    return 1;
  }
}
