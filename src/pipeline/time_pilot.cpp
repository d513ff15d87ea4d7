#include "pipeline/time_pilot.h"

#include <algorithm>

#include "base/error.h"
#include "base/parallel.h"
#include "base/random.h"
#include "base/timer.h"
#include "film/filter.h"
#include "pipeline/develop.h"
#include "transport/rows/film_samples.h"

namespace lumirank::pipeline {
namespace {

// So many lights and columns are tried: together about a tenth of a second on ordinary scenes. Two numbers
// of lights, because some of their time is the same for any number.
constexpr std::size_t kFewLights = 1024, kPilotLights = 8192, kPilotColumns = 16;
// Whose film samples are traced; and what finding receivers adds to tracing them.
constexpr std::size_t kFilmPixels = 1024;
constexpr double kFindingReceivers = 1.5;

double direct_seconds(const world::World& world, const transport::Receivers& rows, const Recipe& recipe,
                      const Sinks& sinks) {
  const auto tracing = start_direct(world, rows, recipe);
  if (!tracing) return 0;
  const Timer timer;
  tracing->add(1, sinks);
  return timer.seconds();
}

double column_seconds(const transport::SceneMatrix& matrix, const Sinks& sinks) {
  const std::size_t columns = matrix.columns();
  if (columns == 0 || matrix.rows() == 0) return 0;
  std::vector<matrix::ScaledColumn> few;
  for (std::uint64_t k = 0; k < kPilotColumns; ++k)
    few.push_back({static_cast<matrix::Index>(Rng(1, Stage::pilot, k).next_below(columns)), Rgb(1)});
  std::vector<Rgb> sums(matrix.rows());
  const Timer timer;
  matrix.accumulate(few, sums, sinks);
  return timer.seconds() / static_cast<double>(kPilotColumns);
}

// Of one film sample: those of some pixels, whose rays are as alike as in the picture.
double seconds_of_film_sample(const world::World& world, const View& view, const Recipe& recipe) {
  if (recipe.film_samples == 0) return 0;
  const world::Camera camera(view.sensor, world.units());
  const transport::ReceiverSettings settings = receiver_settings(recipe, view);
  const auto random_of = [](Rng& rng, int count) {
    return static_cast<int>(rng.next_below(static_cast<std::uint64_t>(count)));
  };
  const Timer timer;
  parallel_for(kFilmPixels, kFilmPixels / 16, [&](std::size_t begin, std::size_t end) {
    transport::FilmEye eye(world, camera, settings);
    for (std::size_t p = begin; p < end; ++p) {
      Rng rng(1, Stage::pilot, p);
      const int x = settings.crop_x + random_of(rng, settings.crop_width);
      eye.begin({x, settings.crop_y + random_of(rng, settings.crop_height)});
      for (int k = 0; k < recipe.film_samples; ++k) eye.trace(k, nullptr);
    }
  });
  return kFindingReceivers * timer.seconds() / (static_cast<double>(kFilmPixels) * recipe.film_samples);
}

}  // namespace

TimePilot measure_costs(const SharedWorld& world, const View& view, const Recipe& recipe,
                        const Sinks& sinks) {
  TimePilot pilot;
  TimeCosts& costs = pilot.costs;
  const Timer eye_timer;
  const auto rows = std::make_shared<transport::Receivers>(aim_at(*world, view, recipe.light_seed, sinks));
  costs.receiver = eye_timer.seconds();
  const auto samples = static_cast<double>(rows->samples());
  pilot.survey = survey(*world, recipe, *rows);
  costs.direct = direct_seconds(*world, *rows, recipe, sinks);
  SharedPrepared tried;
  const auto light_seconds = [&](std::size_t count) {
    const Timer timer;
    Recipe plain = recipe;
    plain.near_radii = 0;
    tried = join(world, view, plain, rows, trace_columns(*world, plain, *pilot.survey, count, sinks), {}, {});
    return timer.seconds();
  };
  const double few = light_seconds(kFewLights), many = light_seconds(kPilotLights);
  // On a busy machine the smaller number can take longer: then as if a quarter of the time went by number.
  costs.light = std::max(many - few, 0.25 * many) / static_cast<double>(kPilotLights - kFewLights);
  costs.column = column_seconds(*tried->matrix, sinks);
  const Timer film_timer;
  to_picture(film::splat(rows->width, rows->height, world::make_filter(view.sensor.film.filter), rows->film,
                         sample_values(*rows, {}, std::vector<Rgb>(rows->size()), {}), {0, 0}));
  costs.develop = film_timer.seconds();
  for (double* seconds : {&costs.receiver, &costs.direct, &costs.column, &costs.develop}) *seconds /= samples;
  costs.film_sample = seconds_of_film_sample(*world, view, recipe);
  if (sinks.cancelled()) throw Cancelled();
  return pilot;
}

}  // namespace lumirank::pipeline
