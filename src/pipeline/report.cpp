#include "pipeline/report.h"

#include <sys/resource.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "base/version.h"

namespace lumirank {

std::optional<double> Report::stated_error() const {
  for (const char* key : {"error.estimate", "error.relative_l1"})
    if (const auto found = numbers.find(key); found != numbers.end()) return found->second;
  return {};
}

std::string Report::json() const {
  nlohmann::ordered_json json;
  json["method"] = method;
  json["version"] = version;
  json["seed"] = seed;
  for (const auto& [stage, value] : seconds) json["seconds." + stage] = value;
  for (const auto& [key, value] : numbers) {
    // Whole numbers as such.
    if (std::abs(value) < 1e15 && value == std::floor(value) && !key.starts_with("seconds."))
      json[key] = static_cast<std::int64_t>(value);
    else
      json[key] = value;
  }
  for (const auto& [key, value] : notes) json[key] = value;
  if (cost) {
    json["entries.evaluated"] = cost->entries;
    json["entries.culled"] = cost->culled;
    json["rays.shadow"] = cost->shadow_rays;
    json["sampling_rate"] = cost->sampling_rate;
  }
  if (sizes) {
    if (cost)
      json["rays.per_pixel"] = static_cast<double>(cost->shadow_rays) / static_cast<double>(sizes->pixels);
    json["virtual_lights"] = sizes->lights;
    json["virtual_lights.asked"] = sizes->lights_asked;
    json["virtual_lights.direct"] = sizes->direct_lights;
    json["virtual_lights.indirect"] = sizes->lights - sizes->direct_lights;
    json["virtual_lights.paths"] = sizes->light_paths;
    json["receivers"] = sizes->receivers;
    json["pixels"] = sizes->pixels;
    json["memory.scene_bytes"] = memory.scene;
    json["memory.receivers_bytes"] = memory.receivers;
    json["memory.lights_bytes"] = memory.lights;
    json["memory.matrix_bytes"] = memory.matrix;
  }
  json["memory.peak_bytes"] = memory.peak;
  json["parameters"] = nlohmann::ordered_json::parse(to_json(settings));
  if (!choices.empty()) json["choices"] = choices;
  return json.dump(1) + "\n";
}

}  // namespace lumirank

namespace lumirank::pipeline {

std::size_t peak_memory_bytes() {
  rusage usage{};
  if (getrusage(RUSAGE_SELF, &usage) != 0) return 0;
  return static_cast<std::size_t>(usage.ru_maxrss) * 1024;
}

void add_film_numbers(std::map<std::string, double>& numbers, const Recipe& recipe,
                      const transport::Receivers& seen, const FilmFits& fits) {
  using transport::FilmFit;
  numbers["film.samples"] = recipe.film_samples;
  if (recipe.film_samples == 0) return;
  numbers["film.receivers_added"] = static_cast<double>(seen.added);
  numbers["film.from_own_pixel"] = fits.share(FilmFit::own_pixel);
  numbers["film.from_neighbors"] = fits.share(FilmFit::neighbors);
  numbers["film.from_same_sort"] = fits.share(FilmFit::own_pixel_sort) + fits.share(FilmFit::neighbors_sort);
  numbers["film.from_any"] = fits.share(FilmFit::any) + fits.share(FilmFit::none);
}

Report begin_report(const std::string& method, const RenderSettings& settings) {
  Report report;
  report.method = method;
  report.version = program_version();
  report.seed = settings.seed;
  report.settings = settings;
  return report;
}

Report make_report(const Prepared& prepared, const TracedLight& traced, const RenderSettings& settings,
                   const methods::MethodInfo& method, const methods::Estimate& estimate,
                   const matrix::Cost& spent, const methods::TimedChoices::Lists& choices) {
  Report report = begin_report(method.name, settings);
  report.seconds = prepared.seconds;
  report.numbers = estimate.trace.numbers;
  report.notes = estimate.trace.notes;
  auto& numbers = report.numbers;
  if (numbers.contains("error.estimate")) report.notes["error.of"] = "the light that columns carry";

  const transport::SceneMatrix& scene_matrix = *prepared.matrix;
  const double all = static_cast<double>(scene_matrix.rows()) * static_cast<double>(scene_matrix.columns());
  Report::Cost cost{spent.entries, spent.culled, spent.rays, 0};
  // Some methods know a better one: of their reduced matrices.
  if (const auto own = numbers.find("sampling_rate"); own != numbers.end())
    cost.sampling_rate = own->second, numbers.erase(own);
  else
    cost.sampling_rate = all > 0 ? static_cast<double>(cost.entries) / all : 0;
  report.cost = cost;

  const auto& lights = prepared.lights();
  report.sizes = Report::Sizes{
      static_cast<std::uint64_t>(prepared.view.width) * static_cast<std::uint64_t>(prepared.view.height),
      prepared.receivers().size(),
      lights.size(),
      prepared.columns.asked,
      lights.direct_count,
      lights.paths};
  if (prepared.columns.radius_scale > 0)
    numbers["virtual_lights.radius_scale"] = prepared.columns.radius_scale;
  numbers["clamp.removed_fraction"] = matrix::clamped_fraction(spent);
  numbers["traced_direct.samples"] = traced.direct_samples;
  numbers["traced_direct.below_roughness"] =
      traced.direct.empty() ? 0.0 : static_cast<double>(prepared.recipe.traced_below);
  numbers["panes.straight"] = static_cast<double>(prepared.world->info().panes);
  numbers["panes.bending"] = static_cast<double>(prepared.world->info().bending_glass);
  numbers["meshes.touching_faces"] = static_cast<double>(prepared.world->info().touching_faces);
  numbers["meshes.left_out"] = static_cast<double>(prepared.world->info().meshes_left_out);
  report.memory = {peak_memory_bytes(), prepared.world->info().memory_bytes,
                   prepared.receivers().memory_bytes(), lights.memory_bytes(), scene_matrix.memory_bytes()};
  report.choices = choices;
  return report;
}

}  // namespace lumirank::pipeline
