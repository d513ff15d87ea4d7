#include "pipeline/prepared.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/random.h"
#include "base/timer.h"
#include "pipeline/shot.h"
#include "pipeline/traced_indirect.h"
#include "transport/lights/sphere_lights.h"
#include "transport/rows/gathered_receivers.h"

namespace lumirank::pipeline {

SharedRows trace_rows(const world::World& world, const View& view, const Recipe& recipe, const Sinks& sinks) {
  auto rows = std::make_shared<transport::Receivers>(transport::trace_receivers(
      world, world::Camera(view.sensor, world.units()), receiver_settings(recipe, view), sinks));
  if (sinks.cancelled()) throw Cancelled();
  return rows;
}

bool some_traced(const transport::Receivers& rows, float below) {
  for (std::size_t i = 0; i < rows.size(); ++i)
    if (is_traced(rows, i, below)) return true;
  return false;
}

std::unique_ptr<DirectTracing> start_direct(const world::World& world, const transport::Receivers& rows,
                                            const Recipe& recipe) {
  TracedDirectSettings ts;
  ts.seed = recipe.seed, ts.pass = recipe.pass;
  ts.below = recipe.traced_below;
  ts.max_depth = recipe.max_depth;
  if (recipe.traced_below <= 0 || !some_traced(rows, ts.below)) return nullptr;
  return std::make_unique<DirectTracing>(world, rows, ts);
}

std::vector<Rgb> trace_sharp_lobes(const world::World& world, const transport::Receivers& rows,
                                   const Recipe& recipe, const Sinks& sinks) {
  if (recipe.only == LightPart::direct || !some_traced(rows, recipe.sharp_below)) return {};
  TracedIndirectSettings ts;
  ts.seed = recipe.seed, ts.pass = recipe.pass;
  ts.below = recipe.sharp_below;
  ts.gathered = recipe.gathered;
  ts.paths = recipe.local_paths;
  ts.max_depth = recipe.max_depth;
  auto light = trace_indirect(world, rows, ts, sinks);
  if (sinks.cancelled()) throw Cancelled();
  return light;
}

SharedRows gather_rows(const world::World& world, SharedRows rows, const Recipe& recipe, const Sinks& sinks) {
  if (!recipe.gathered || !some_traced(*rows, recipe.sharp_below)) return rows;
  return std::make_shared<transport::Receivers>(
      transport::with_gathered(world, transport::Receivers(*rows),
                               {recipe.seed, recipe.pass, recipe.sharp_below, recipe.max_depth}, sinks));
}

SharedRows matrix_rows(const SharedRows& rows, const Recipe& recipe) {
  if (!some_traced(*rows, recipe.sharp_below)) return rows;
  // Direct light of these lobes is traced or not wanted, so columns have nothing to add to them.
  return std::make_shared<transport::Receivers>(
      transport::broad_receivers(transport::Receivers(*rows), recipe.sharp_below));
}

const transport::Receivers& seen_rows(const transport::Receivers& rows, const TracedLight& traced) {
  return traced.rows ? *traced.rows : rows;
}

TracedRows trace_rows_and_light(const world::World& world, const View& view, const Recipe& recipe,
                                const Sinks& sinks, std::map<std::string, double>& seconds) {
  TracedRows made;
  Timer timer;
  const SharedRows all = trace_rows(world, view, recipe, sinks);
  seconds["receivers"] = timer.seconds();
  timer = {};
  if (const auto tracing = start_direct(world, *all, recipe)) {
    if (!tracing->add(TracedDirectSettings{}.samples, sinks)) throw Cancelled();
    made.traced.direct = tracing->radiance();
    made.traced.direct_samples = tracing->samples();
  }
  if (recipe.traced_below > 0) seconds["traced_direct"] = timer.seconds();
  timer = {};
  made.traced.rows = all;
  made.traced.sharp = trace_sharp_lobes(world, *all, recipe, sinks);
  made.rows = matrix_rows(all, recipe);
  if (made.rows != all) seconds["traced_indirect"] = timer.seconds();
  return made;
}

transport::Receivers aim_at(const world::World& world, const View& view, std::uint64_t seed,
                            const Sinks& sinks) {
  constexpr double kWanted = 16384;
  const world::Camera camera(world::whole_film(view, kWanted), world.units());
  transport::ReceiverSettings rs;
  rs.seed = hash_ids(seed, Stage::pilot, ~0ull);  // places of their own
  rs.spp = 1;
  rs.max_depth = view.max_depth;
  rs.first_hits = false;
  return transport::trace_receivers(world, camera, rs, sinks);
}

SharedSurvey survey(const world::World& world, const Recipe& recipe, const transport::Receivers& aim) {
  transport::LightSettings ls = light_settings(recipe);
  ls.receivers = &aim;
  return transport::survey_lights(world, ls);
}

namespace {

// Clamping takes from an entry what belongs to its light's area, which other lights decide; to be given back
// by tracing paths it must be the same for all. Lights spread over a sphere around the scene would have this
// much each. Emitter samples are not clamped then: direct light is not given back.
pathtrace::CarriedByColumns even_areas(transport::VirtualLights& lights, const world::World& world,
                                       double clamp, std::size_t count) {
  const float area = 4 * kPi * square(world.bounds().radius()) / static_cast<float>(count);
  for (std::size_t j = 0; j < lights.size(); ++j)
    lights.area[j] = lights.kind[j] == transport::LightKind::surface ? area : 0;
  return {static_cast<float>(clamp) / area, false};
}

}  // namespace

SharedSurvey survey(const SharedWorld& world, const View& view, const Recipe& recipe, const Sinks& sinks) {
  if (recipe.shot_lights) return recipe.shot_lights->guide;
  return survey(*world, recipe, aim_at(*world, view, recipe.light_seed, sinks));
}

Columns trace_columns(const world::World& world, const Recipe& recipe, const transport::LightSurvey& survey,
                      std::size_t count, const Sinks& sinks) {
  transport::LightSettings ls = light_settings(recipe);
  ls.count = count;
  ls.survey = &survey;
  if (recipe.shot_lights && recipe.shot_lights->count == count) ls.gather = &recipe.shot_lights->plan;
  auto lights = std::make_shared<transport::VirtualLights>(transport::trace_virtual_lights(world, ls, sinks));
  Columns columns;
  columns.asked = count;
  if (recipe.compensated) {
    columns.carried = even_areas(*lights, world, recipe.lights.clamp, count);
    columns.carried.diffuse_only = ls.lobes.diffuse_only;
  }
  if (recipe.lights.type == LightType::sphere)
    columns.radius_scale =
        transport::make_spherical(*lights, world, {static_cast<float>(recipe.lights.radius_scale)}, sinks);
  if (recipe.near_lights > 0) columns.max_reach = transport::give_reach(*lights, recipe.near_lights);
  if (sinks.cancelled()) throw Cancelled();
  columns.lights = std::move(lights);
  return columns;
}

std::vector<Rgb> trace_near(const world::World& world, const transport::Receivers& rows,
                            const Columns& columns, const Recipe& recipe, const Sinks& sinks) {
  if ((recipe.near_radii <= 0 && recipe.near_lights <= 0) || recipe.only == LightPart::direct) return {};
  const transport::LightReach reach =
      recipe.near_lights > 0
          ? transport::LightReach(*columns.lights, recipe.near_lights, columns.max_reach)
          : transport::LightReach(*columns.lights, world, static_cast<float>(columns.radius_scale),
                                  recipe.near_radii);
  TracedIndirectSettings ts;
  ts.seed = recipe.seed, ts.pass = recipe.pass;
  ts.paths = std::max(1, recipe.local_paths);
  ts.max_depth = recipe.max_depth;
  ts.near = &reach;
  auto light = trace_indirect(world, rows, ts, sinks);
  if (sinks.cancelled()) throw Cancelled();
  return light;
}

SharedPrepared join(const SharedWorld& world, const View& view, const Recipe& recipe, SharedRows rows,
                    Columns columns, TracedLight traced, std::map<std::string, double> seconds) {
  auto prepared = std::make_shared<Prepared>();
  prepared->world = world, prepared->view = view, prepared->recipe = recipe;
  prepared->rows = std::move(rows), prepared->columns = std::move(columns);
  prepared->traced = std::move(traced), prepared->seconds = std::move(seconds);
  const Timer timer;
  prepared->matrix = std::make_shared<transport::SceneMatrix>(*world, prepared->receivers(),
                                                              prepared->lights(), matrix_settings(recipe));
  prepared->seconds["matrix"] = timer.seconds();
  return prepared;
}

namespace {

// What lights are aimed at and rows are traced for. Cameras of one world are told apart by their ids.
bool same_view(const View& a, const View& b) {
  return a.sensor.id == b.sensor.id && a.sensor.film.width == b.sensor.film.width &&
         a.sensor.film.height == b.sensor.film.height && a.max_depth == b.max_depth && a.crop_x == b.crop_x &&
         a.crop_y == b.crop_y && a.width == b.width && a.height == b.height;
}

// Rows and the light that is traced at them.
bool same_rows(const Recipe& a, const Recipe& b) {
  return a.seed == b.seed && a.pass == b.pass && a.spp == b.spp && a.film_samples == b.film_samples &&
         a.only == b.only && a.traced_below == b.traced_below && a.sharp_below == b.sharp_below &&
         a.local_paths == b.local_paths && a.gathered == b.gathered && a.first_hits == b.first_hits &&
         a.instants == b.instants && a.instant == b.instant && a.pixels == b.pixels;
}

bool same_columns(const Recipe& a, const Recipe& b) {
  return a.light_seed == b.light_seed && a.only == b.only && a.traced_below == b.traced_below &&
         a.compensated == b.compensated && a.lights.type == b.lights.type &&
         a.lights.placement == b.lights.placement && a.shot_lights == b.shot_lights &&
         a.lights.radius_scale == b.lights.radius_scale && a.lights.roughness == b.lights.roughness &&
         (a.local_paths > 0) == (b.local_paths > 0) && (!a.compensated || a.lights.clamp == b.lights.clamp);
}

}  // namespace

SharedPrepared prepare(const SharedWorld& world, const View& view, const Recipe& recipe, std::size_t count,
                       const SharedPrepared& previous, const Sinks& sinks) {
  const bool same_place = previous && previous->world == world && same_view(previous->view, view);
  const bool keeps_rows = same_place && same_rows(previous->recipe, recipe);
  const bool keeps_columns =
      same_place && previous->columns.asked == count && same_columns(previous->recipe, recipe);
  if (keeps_rows && keeps_columns && previous->recipe == recipe) return previous;
  std::map<std::string, double> seconds;  // of what is kept: what it took then
  SharedRows rows;
  TracedLight traced;
  Columns columns;
  if (previous && (keeps_rows || keeps_columns)) seconds = previous->seconds;
  if (keeps_rows) {
    rows = previous->rows, traced = previous->traced;
  } else {
    TracedRows made = trace_rows_and_light(*world, view, recipe, sinks, seconds);
    rows = std::move(made.rows), traced = std::move(made.traced);
  }
  if (keeps_columns) {
    columns = previous->columns;
  } else {
    const Timer timer;
    columns = trace_columns(*world, recipe, *survey(world, view, recipe, sinks), count, sinks);
    seconds["lights"] = timer.seconds();
  }
  if (!keeps_rows || !keeps_columns || previous->recipe.near_radii != recipe.near_radii) {
    const Timer timer;
    traced.near = trace_near(*world, *rows, columns, recipe, sinks);
    if (!traced.near.empty()) seconds["traced_near"] = timer.seconds();
  }
  return join(world, view, recipe, std::move(rows), std::move(columns), std::move(traced),
              std::move(seconds));
}

}  // namespace lumirank::pipeline
