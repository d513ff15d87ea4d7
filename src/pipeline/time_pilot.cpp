#include "pipeline/time_pilot.h"

#include <algorithm>

#include "base/error.h"
#include "base/random.h"
#include "base/timer.h"
#include "film/filter.h"
#include "pipeline/traced_direct.h"

namespace lumirank::pipeline {
namespace {

// So many lights and columns are tried: together about a tenth of a second on ordinary scenes. Two numbers
// of lights, because some of their time is the same for any number.
constexpr std::size_t kFewLights = 1024, kPilotLights = 8192, kPilotColumns = 16;

double direct_seconds(const Setup& pilot, const RenderSettings& settings, const Sinks& sinks) {
  TracedDirectSettings ts;
  ts.seed = settings.seed;
  ts.below = static_cast<float>(pilot.traced_below);
  ts.max_depth = pilot.view.max_depth;
  if (!some_traced(pilot.receivers, ts.below)) return 0;
  DirectTracing tracing(*pilot.world, pilot.receivers, ts);
  const Timer timer;
  tracing.add(1, sinks);
  return timer.seconds();
}

double column_seconds(const Setup& pilot, const Sinks& sinks) {
  const std::size_t columns = pilot.matrix->columns();
  if (columns == 0 || pilot.matrix->rows() == 0) return 0;
  std::vector<matrix::ScaledColumn> few;
  for (std::uint64_t k = 0; k < kPilotColumns; ++k)
    few.push_back({static_cast<matrix::Index>(Rng(1, Stage::pilot, k).next_below(columns)), Rgb(1)});
  std::vector<Rgb> sums(pilot.matrix->rows());
  const Timer timer;
  pilot.matrix->accumulate(few, sums, sinks);
  return timer.seconds() / static_cast<double>(kPilotColumns);
}

}  // namespace

TimeCosts measure_costs(Setup& setup, const RenderSettings& settings, const Sinks& sinks) {
  TimeCosts costs;
  const Timer eye_timer;
  const transport::Receivers aim = aim_at(setup, settings.seed, sinks);
  costs.receiver = eye_timer.seconds();
  const auto samples = static_cast<double>(aim.samples());
  setup.traced_below = traced_roughness(settings);
  // Takes as long for few lights as for many, and is not made again.
  survey_lights(setup, settings, aim);

  Setup pilot;
  pilot.world = setup.world, pilot.view = setup.view;
  pilot.receivers = aim;
  pilot.traced_below = setup.traced_below;
  if (pilot.traced_below > 0) costs.direct = direct_seconds(pilot, settings, sinks);
  RenderSettings plain = settings;
  plain.local_paths = 0;
  const auto light_seconds = [&](std::size_t count) {
    pilot.survey = setup.survey;
    const Timer timer;
    make_matrix(pilot, plain, count, sinks);
    return timer.seconds();
  };
  const double few = light_seconds(kFewLights), many = light_seconds(kPilotLights);
  // On a busy machine the smaller number can take longer: then as if a quarter of the time went by number.
  costs.light = std::max(many - few, 0.25 * many) / static_cast<double>(kPilotLights - kFewLights);
  costs.column = column_seconds(pilot, sinks);
  const Timer film_timer;
  to_picture(film::splat(pilot.receivers.width, pilot.receivers.height,
                         make_filter(setup.view.sensor.film.filter), pilot.receivers.film,
                         sample_values(pilot, std::vector<Rgb>(pilot.receivers.size()), {}), {0, 0}));
  costs.develop = film_timer.seconds();
  for (double* seconds : {&costs.receiver, &costs.direct, &costs.column, &costs.develop}) *seconds /= samples;
  if (sinks.cancelled()) throw Cancelled();
  return costs;
}

}  // namespace lumirank::pipeline
