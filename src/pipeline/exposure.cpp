#include "pipeline/exposure.h"

#include <algorithm>

#include "base/error.h"
#include "base/random.h"
#include "pipeline/develop.h"

namespace lumirank::pipeline {

std::vector<double> instants_between(double open, double close, std::size_t count, std::uint64_t seed) {
  std::vector<double> times;
  for (std::size_t k = 0; k < count; ++k) {
    const double place = static_cast<double>(k) + unit_double(hash_ids(seed, Stage::shutter, ~0ull, k));
    times.push_back(open + (close - open) * place / static_cast<double>(count));
  }
  return times;
}

void check_exposure(const methods::MethodInfo& method, const RenderSettings& settings) {
  if (!method.contract.instants) {
    std::string able;
    for (const auto& other : methods::all_methods())
      if (other.contract.instants) able += (able.empty() ? "" : ", ") + other.name;
    throw InputError("the method '" + method.name + "' renders one moment and no open shutter",
                     "choose one of " + able + ", leave '--method auto', or leave out --shutter");
  }
  if (settings.time > 0)
    throw InputError("an open shutter keeps no time budget",
                     "leave out --time; --lights, --spp and --set max-pairs=… decide its time");
  if (!settings.layers.empty())
    throw InputError("a picture with an open shutter has no layer '" + settings.layers.front() + "'",
                     "leave out --aov, or --shutter; 'reference' has direct, indirect and emission");
  if (settings.traced.compensate > 0)
    throw InputError("with an open shutter, what clamping takes cannot be given back",
                     "leave out --compensate, or --shutter");
}

std::vector<Rgb> Exposure::values(std::span<const Rgb> sums, LightPart only) const {
  std::vector<Rgb> all;
  for (std::size_t k = 0; k < instants.size(); ++k) {
    const Prepared& now = *instants[k];
    const std::size_t first = matrix->first_row(k);
    const auto own = sample_values(now.receivers(), now.traced,
                                   sums.subspan(first, matrix->first_row(k + 1) - first), wanted_parts(only));
    all.insert(all.end(), own.begin(), own.end());
  }
  return all;
}

std::vector<Vec2f> Exposure::film() const {
  std::vector<Vec2f> all;
  for (const SharedPrepared& now : instants)
    all.insert(all.end(), now->receivers().film.begin(), now->receivers().film.end());
  return all;
}

namespace {

// A light of one instant stands for more than one of a still picture with as many, but it also lights no more
// than its instant's receivers: the area that counts for clamping is that of a pixel's lights together.
void share_areas(Columns& columns, std::size_t instants) {
  auto lights = std::make_shared<transport::VirtualLights>(*columns.lights);
  for (float& area : lights->area) area /= static_cast<float>(instants);
  columns.lights = std::move(lights);
}

}  // namespace

Exposure prepare_exposure(const std::vector<Instant>& instants, const Recipe& recipe, std::size_t count,
                          const Sinks& sinks) {
  const std::size_t n = instants.size();
  const Instant& middle = instants[n / 2];
  const SharedSurvey common =
      survey(*middle.world, recipe, aim_at(*middle.world, middle.view, recipe.light_seed, sinks));
  Sinks quiet = sinks;
  quiet.progress = {};
  Exposure exposure;
  std::vector<transport::InstantParts> parts;
  for (std::size_t k = 0; k < n; ++k) {
    const auto& [world, view] = instants[k];
    Recipe own = recipe;
    own.instants = static_cast<int>(n), own.instant = static_cast<int>(k);
    own.light_seed = hash_ids(recipe.light_seed, Stage::shutter, k, ~0ull);  // lights of its own
    std::map<std::string, double> seconds;
    TracedRows made = trace_rows_and_light(*world, view, own, quiet, seconds);
    Columns columns = trace_columns(*world, own, *common, std::max<std::size_t>(1, count / n), quiet);
    made.traced.near = trace_near(*world, *made.rows, columns, own, quiet);
    share_areas(columns, std::min(n, static_cast<std::size_t>(recipe.spp)));
    exposure.instants.push_back(join(world, view, own, std::move(made.rows), std::move(columns),
                                     std::move(made.traced), std::move(seconds)));
    const Prepared& now = *exposure.instants.back();
    parts.push_back({*now.world, now.receivers(), now.lights(), now.matrix});
    sinks.report("instants", static_cast<double>(k + 1) / static_cast<double>(n));
  }
  exposure.matrix = std::make_shared<transport::InstantsMatrix>(parts, matrix_settings(recipe));
  return exposure;
}

}  // namespace lumirank::pipeline
