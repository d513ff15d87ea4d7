#include "pipeline/pass_tracer.h"

#include <algorithm>
#include <cmath>

#include "base/random.h"
#include "base/timer.h"
#include "pipeline/compensation.h"
#include "pipeline/pass_plan.h"

namespace lumirank::pipeline {
namespace {

// Lights of a pass, for the root of the pixels: a small picture shows as much of a room as a large one, whose
// receivers pay for better records.
constexpr double kLightsOfRoot = 40;
constexpr std::size_t kMinLightsOfPass = 1000, kMaxLightsOfPass = 120000;
// Samples of traced direct light, and paths of sharp lobes, for each receiver of a pass.
constexpr int kDirectOfPass = 1, kLocalOfPass = 1;
// Times the clamping of single pictures: what is near is traced, and what spots remain differ from pass to
// pass.
constexpr double kClampOfPass = 16;
// Light from places around which fewer lights than these lie is traced.
constexpr float kNearOfPass = 10;
// Seconds of a budget below which the survey of lights is brief.
constexpr double kTimeOfBriefSurvey = 5;
// What a receiver draws in a whole pass.
constexpr int kSamplesOfPass = 8;

// What is seen of emitters and the surroundings has no noise, and is not for the denoiser.
FilmParts without_emission(LightPart only) {
  FilmParts parts = wanted_parts(only);
  parts.emission = false;
  return parts;
}

}  // namespace

PassTracer::PassTracer(SharedWorld world, const methods::MethodInfo& info,
                       std::unique_ptr<methods::Method> method, const RenderSettings& settings,
                       const Sinks& sinks, std::map<std::string, double>& seconds)
    : world_(std::move(world)),
      info_(info),
      method_(std::move(method)),
      settings_(settings),
      sinks_(sinks),
      seconds_(seconds),
      sent_(without_emission(settings.view.only)),
      eighths_(PassPlan::kWhole) {}

void PassTracer::set_size(int eighths) {
  if (eighths == eighths_) return;
  eighths_ = eighths;
  auto parameters = settings_.method.parameters;
  parameters["samples"] = std::to_string(eighths * kSamplesOfPass / PassPlan::kWhole);
  method_ = info_.make(parameters);
}

Recipe PassTracer::recipe_of(std::uint64_t number, const View& view) const {
  RenderSettings of_pass = settings_;
  // Lights are spots in narrow lobes; few paths have noise there, which other passes and the denoiser take.
  if (settings_.lights.type == LightType::point && settings_.traced.direct != DirectLight::matrix &&
      settings_.traced.local_paths == 0 && settings_.traced.compensate == 0)
    of_pass.traced.local_paths = kLocalOfPass;
  Recipe recipe = make_recipe(of_pass, view);
  // Film samples would take a gathered receiver's light for that of a place they see.
  recipe.gathered = of_pass.traced.local_paths > settings_.traced.local_paths &&
                    settings_.view.only == LightPart::all && !settings_.view.film_samples;
  recipe.seed = hash_ids(settings_.seed, Stage::passes);
  const auto parts = static_cast<std::uint64_t>(this->parts());
  recipe.pass = number / parts;
  recipe.pixels = film::interleaved(side_, static_cast<int>(number % parts));
  recipe.light_seed = hash_ids(settings_.seed, Stage::passes, ~number);
  recipe.brief_survey = settings_.time > 0 && settings_.time < kTimeOfBriefSurvey;
  recipe.spp = 1;
  recipe.film_samples = settings_.view.film_samples.value_or(0);
  recipe.first_hits = false;
  recipe.lights.clamp = kClampOfPass * settings_.lights.clamp;
  if (recipe.lights.type != LightType::sphere && settings_.traced.compensate == 0)
    recipe.near_lights = kNearOfPass;
  return recipe;
}

std::size_t PassTracer::lights_of(const View& view) const {
  if (settings_.lights.count) return *settings_.lights.count;
  const double pixels = static_cast<double>(view.width) * static_cast<double>(view.height) / parts();
  const double part = static_cast<double>(eighths_) / PassPlan::kWhole;
  return std::clamp(static_cast<std::size_t>(part * kLightsOfRoot * std::sqrt(pixels)), kMinLightsOfPass,
                    kMaxLightsOfPass);
}

bool PassTracer::trace(std::uint64_t number, const View& view, image::Image& image, PassSeconds& took) {
  const Recipe recipe = recipe_of(number, view);
  Timer timer;
  const auto lap = [&](const char* stage, double& sum) {
    seconds_[stage] += timer.seconds(), sum += timer.seconds();
    timer = {};
  };
  TracedLight traced;
  SharedRows rows = gather_rows(*world_, trace_rows(*world_, view, recipe, sinks_), recipe, sinks_);
  traced.rows = rows;
  lap("receivers", took.by_pixel);
  if (const auto direct = start_direct(*world_, *rows, recipe)) {
    if (!direct->add(kDirectOfPass, sinks_)) return false;
    traced.direct = direct->radiance(), traced.direct_samples = direct->samples();
  }
  traced.sharp = trace_sharp_lobes(*world_, *rows, recipe, sinks_);
  rows = matrix_rows(rows, recipe);
  lap("traced_direct", took.by_pixel);
  Columns columns = trace_columns(*world_, recipe, *survey_, lights_of(view), sinks_);
  lap("lights", took.fixed);
  traced.near = trace_near(*world_, *rows, columns, recipe, sinks_);
  if (!traced.near.empty()) lap("traced_near", took.by_pixel);
  prepared_ = join(world_, view, recipe, rows, std::move(columns), {}, {});
  lap("matrix", took.fixed);
  methods::RunOptions run;
  run.seed = hash_ids(settings_.method.seed ? settings_.method.seed : settings_.seed, Stage::method, number);
  run.one_of_passes = true;
  run.sinks = sinks_;
  const matrix::MeteredMatrix metered(*prepared_->matrix);
  estimate_ = method_->run(metered, run);
  if (estimate_.interrupted) return false;
  cost_ += metered.total();
  lap("method", took.by_pixel);
  image = develop({*world_, view, recipe, *rows, traced}, estimate_.sums, sent_);
  if (settings_.traced.compensate > 0) {
    RenderSettings of_pass = settings_;
    of_pass.seed = recipe.light_seed;
    if (!compensate_clamping(*prepared_, of_pass, image, sinks_)) return false;
  }
  lap("film", took.by_pixel);
  traced_ = std::move(traced);
  return !sinks_.cancelled();
}

}  // namespace lumirank::pipeline
