#include "pipeline/report.h"

#include <sys/resource.h>

#include <nlohmann/json.hpp>

#include "base/version.h"
#include "lumirank/lumirank.h"

namespace lumirank::pipeline {

std::size_t peak_memory_bytes() {
  rusage usage{};
  if (getrusage(RUSAGE_SELF, &usage) != 0) return 0;
  return static_cast<std::size_t>(usage.ru_maxrss) * 1024;
}

std::string make_report(const Setup& setup, const RenderSettings& settings, const methods::MethodInfo& method,
                        const methods::Estimate& estimate, const matrix::Cost& cost,
                        const methods::TimedChoices::Lists& choices, double total_seconds,
                        std::size_t lights_asked) {
  nlohmann::ordered_json json;
  json["method"] = method.name;
  json["version"] = program_version();
  json["seed"] = settings.seed;
  json["seconds.total"] = total_seconds;
  for (const auto& [phase, seconds] : setup.seconds) json["seconds." + phase] = seconds;
  for (const auto& [key, value] : estimate.trace.numbers) json[key] = value;
  for (const auto& [key, value] : estimate.trace.notes) json[key] = value;
  if (json.contains("error.estimate")) json["error.of"] = "the light that columns carry";

  const double entries =
      static_cast<double>(setup.matrix->rows()) * static_cast<double>(setup.matrix->columns());
  const double pixels = static_cast<double>(setup.view.width) * static_cast<double>(setup.view.height);
  json["entries.evaluated"] = cost.entries;
  json["entries.culled"] = cost.culled;
  json["rays.shadow"] = cost.rays;
  json["rays.per_pixel"] = static_cast<double>(cost.rays) / pixels;
  // Some methods know a better one: of their reduced matrices.
  if (!json.contains("sampling_rate"))
    json["sampling_rate"] = entries > 0 ? static_cast<double>(cost.entries) / entries : 0.0;

  json["virtual_lights"] = setup.lights.size();
  json["virtual_lights.asked"] = lights_asked;
  json["virtual_lights.direct"] = setup.lights.direct_count;
  json["virtual_lights.indirect"] = setup.lights.size() - setup.lights.direct_count;
  json["virtual_lights.paths"] = setup.lights.paths;
  json["receivers"] = setup.receivers.size();
  json["pixels"] = pixels;
  if (setup.radius_scale > 0) json["virtual_lights.radius_scale"] = setup.radius_scale;
  json["clamp.removed_fraction"] = matrix::clamped_fraction(cost);
  json["traced_direct.samples"] = setup.direct_samples;
  json["traced_direct.below_roughness"] = setup.traced_direct.empty() ? 0.0 : setup.traced_below;

  json["meshes.left_out"] = setup.world->info().meshes_left_out;
  json["memory.peak_bytes"] = peak_memory_bytes();
  json["memory.scene_bytes"] = setup.world->info().memory_bytes;
  json["memory.receivers_bytes"] = setup.receivers.memory_bytes();
  json["memory.lights_bytes"] = setup.lights.memory_bytes();
  json["memory.matrix_bytes"] = setup.matrix->memory_bytes();
  json["parameters"] = nlohmann::ordered_json::parse(to_json(settings));
  if (!choices.empty()) json["choices"] = choices;
  return json.dump(1) + "\n";
}

}  // namespace lumirank::pipeline
