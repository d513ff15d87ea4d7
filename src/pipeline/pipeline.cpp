#include "pipeline/pipeline.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/random.h"
#include "base/timer.h"
#include "pipeline/aovs.h"
#include "pipeline/sound_pixels.h"
#include "pipeline/traced_indirect.h"
#include "scenedesc/schema/film_size.h"
#include "transport/lights/sphere_lights.h"

namespace lumirank::pipeline {
View make_view(const scenedesc::SceneDesc& desc, const RenderSettings& settings) {
  world::ViewChoice choice{settings.camera, settings.width, settings.height, {}, settings.max_depth};
  std::copy_n(settings.crop, 4, choice.crop);
  return world::make_view(desc, choice);
}

pathtrace::ReferenceOptions reference_options(const RenderSettings& settings, const std::string& paths) {
  using pathtrace::Paths;
  pathtrace::ReferenceOptions options;
  options.seed = settings.seed;
  if (paths == "columns")
    options.paths = Paths::columns;
  else if (paths == "rest")
    options.paths = Paths::rest;
  else if (paths != "all")
    throw InputError("'" + paths + "' is not a value of 'paths'", "choose one of all|columns|rest");
  // `--only` is that part alone: emission seen directly belongs to neither.
  options.emission = settings.only == "all";
  options.direct = settings.only != "indirect";
  options.indirect = settings.only != "direct";
  return options;
}

namespace {
double local_sharp(const RenderSettings& settings) {
  return settings.local_paths > 0 ? settings.local_sharp : 0;
}
double local_near(const RenderSettings& settings) {
  return settings.local_paths > 0 && settings.light_type == "sphere" ? settings.local_near : 0;
}
}  // namespace

double traced_roughness(const RenderSettings& settings) {
  if (settings.only == "indirect" || settings.direct == "matrix") return 0;
  if (settings.direct == "traced") return 2;  // roughness never exceeds 1
  // Traced light does not know its emitter.
  for (const auto& aov : settings.aovs)
    if (aov.starts_with("light:")) return 0;
  return std::max(0.15, local_sharp(settings));
}

bool some_traced(const transport::Receivers& receivers, float below) {
  for (std::size_t i = 0; i < receivers.size(); ++i)
    if (is_traced(receivers, i, below)) return true;
  return false;
}

void trace_sharp_lobes(Setup& setup, const RenderSettings& settings, const Sinks& sinks) {
  setup.traced_indirect.clear();
  const auto below = static_cast<float>(local_sharp(settings));
  if (!some_traced(setup.receivers, below)) return;
  const Timer timer;
  if (settings.only != "direct") {
    TracedIndirectSettings ts;
    ts.seed = settings.seed;
    ts.below = below;
    ts.paths = settings.local_paths;
    ts.max_depth = setup.view.max_depth;
    setup.traced_indirect = trace_indirect(*setup.world, setup.receivers, ts, sinks);
  }
  // Direct light of these lobes is traced by now or not wanted, so columns have nothing to add to them.
  setup.receivers = transport::broad_receivers(std::move(setup.receivers), below);
  setup.seconds["traced_indirect"] = timer.seconds();
  if (sinks.cancelled()) throw Cancelled();
}

transport::ReceiverSettings receiver_settings(const View& view, const RenderSettings& settings) {
  transport::ReceiverSettings rs;
  rs.seed = settings.seed;
  rs.spp = settings.spp;
  rs.max_depth = view.max_depth;
  // The window, and around it what its filter reaches.
  const auto& film = view.sensor.film;
  const int reach = make_filter(film.filter).reach();
  rs.crop_x = std::max(0, view.crop_x - reach), rs.crop_y = std::max(0, view.crop_y - reach);
  rs.crop_width = std::min(film.width, view.crop_x + view.width + reach) - rs.crop_x;
  rs.crop_height = std::min(film.height, view.crop_y + view.height + reach) - rs.crop_y;
  rs.first_hits = !settings.aovs.empty();
  return rs;
}

void make_eye_receivers(Setup& setup, const RenderSettings& settings, const Sinks& sinks) {
  const Timer timer;
  setup.receivers =
      transport::trace_receivers(*setup.world, world::Camera(setup.view.sensor, setup.world->units()),
                                 receiver_settings(setup.view, settings), sinks);
  setup.seconds["receivers"] = timer.seconds();
  if (sinks.cancelled()) throw Cancelled();
}

std::unique_ptr<DirectTracing> start_direct(Setup& setup, const RenderSettings& settings) {
  setup.traced_below = traced_roughness(settings);
  setup.traced_direct.clear();
  setup.direct_samples = 0;
  TracedDirectSettings ts;
  ts.seed = settings.seed;
  ts.below = static_cast<float>(setup.traced_below);
  ts.max_depth = setup.view.max_depth;
  if (setup.traced_below <= 0 || !some_traced(setup.receivers, ts.below)) return nullptr;
  return std::make_unique<DirectTracing>(*setup.world, setup.receivers, ts);
}

void keep_direct(Setup& setup, const DirectTracing& tracing) {
  setup.traced_direct = per_sample(setup.receivers, tracing.radiance());
  setup.direct_samples = tracing.samples();
}

void make_receivers(Setup& setup, const RenderSettings& settings, const Sinks& sinks) {
  make_eye_receivers(setup, settings, sinks);
  const Timer timer;
  if (const auto tracing = start_direct(setup, settings)) {
    if (!tracing->add(TracedDirectSettings{}.samples, sinks)) throw Cancelled();
    keep_direct(setup, *tracing);
  }
  if (setup.traced_below > 0) setup.seconds["traced_direct"] = timer.seconds();
  trace_sharp_lobes(setup, settings, sinks);
}

transport::Receivers aim_at(const Setup& setup, std::uint64_t seed, const Sinks& sinks) {
  constexpr double kWanted = 16384;
  const world::Camera camera(whole_film(setup.view, kWanted), setup.world->units());
  transport::ReceiverSettings rs;
  rs.seed = hash_ids(seed, Stage::pilot, ~0ull);  // places of their own
  rs.spp = 1;
  rs.max_depth = setup.view.max_depth;
  rs.first_hits = false;
  return transport::trace_receivers(*setup.world, camera, rs, sinks);
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

transport::SceneMatrixSettings matrix_settings(const Setup& setup, const RenderSettings& settings) {
  transport::SceneMatrixSettings ms;
  ms.seed = settings.seed;
  ms.clamp = static_cast<float>(settings.clamp);
  ms.compensated = settings.compensate > 0;
  using Rules = transport::SphereRules;
  ms.spheres.indicator =
      settings.sphere_indicator == "cosine" ? Rules::Indicator::cosine : Rules::Indicator::disc;
  ms.spheres.strategies =
      settings.sphere_strategies == "cone" ? Rules::Strategies::cone : Rules::Strategies::all;
  ms.spheres.samples = settings.sphere_samples == "cone" ? Rules::Samples::cone : Rules::Samples::overlap;
  ms.spheres.beyond = static_cast<float>(local_near(settings));
  ms.max_depth = setup.view.max_depth;
  ms.traced_direct_below = static_cast<float>(setup.traced_below);
  for (const auto& aov : settings.aovs)
    if (aov.starts_with("light:") || aov == "direct" || aov == "indirect") ms.group_by_emitter = true;
  return ms;
}

namespace {
transport::LightSettings light_settings(const Setup& setup, const RenderSettings& settings) {
  transport::LightSettings ls;
  ls.seed = settings.seed;
  ls.max_depth = setup.view.max_depth;
  ls.direct = settings.only != "indirect";
  ls.indirect = settings.only != "direct";
  ls.diffuse_only = settings.light_type == "diffuse-point";
  ls.traced_direct_below = static_cast<float>(setup.traced_below);
  return ls;
}
}  // namespace

void survey_lights(Setup& setup, const RenderSettings& settings, const transport::Receivers& aim) {
  transport::LightSettings ls = light_settings(setup, settings);
  ls.receivers = &aim;
  setup.survey = transport::survey_lights(*setup.world, ls);
}

void make_matrix(Setup& setup, const RenderSettings& settings, std::size_t count, const Sinks& sinks) {
  const Timer timer;
  setup.matrix.reset();  // before its lights change
  if (!setup.survey) survey_lights(setup, settings, aim_at(setup, settings.seed, sinks));
  const std::shared_ptr<const transport::LightSurvey> survey = std::move(setup.survey);
  transport::LightSettings ls = light_settings(setup, settings);
  ls.count = count;
  ls.survey = survey.get();
  setup.lights = transport::trace_virtual_lights(*setup.world, ls, sinks);
  setup.carried = {};
  if (settings.compensate > 0) {
    setup.carried = even_areas(setup.lights, *setup.world, settings.clamp, count);
    setup.carried.diffuse_only = ls.diffuse_only;
  }
  const bool spherical = settings.light_type == "sphere";
  setup.radius_scale = spherical
                           ? transport::make_spherical(setup.lights, *setup.world,
                                                       {static_cast<float>(settings.radius_scale)}, sinks)
                           : 0;
  setup.seconds["lights"] = timer.seconds();
  if (sinks.cancelled()) throw Cancelled();
  setup.traced_near.clear();
  if (local_near(settings) > 0 && settings.only != "direct") {
    const Timer near_timer;
    const transport::LightReach reach(setup.lights, *setup.world, static_cast<float>(setup.radius_scale),
                                      static_cast<float>(local_near(settings)));
    TracedIndirectSettings ts;
    ts.seed = settings.seed;
    ts.paths = settings.local_paths;
    ts.max_depth = setup.view.max_depth;
    ts.near = &reach;
    setup.traced_near = trace_indirect(*setup.world, setup.receivers, ts, sinks);
    setup.seconds["traced_near"] = near_timer.seconds();
    if (sinks.cancelled()) throw Cancelled();
  }

  const Timer matrix_timer;
  setup.matrix = std::make_unique<transport::SceneMatrix>(*setup.world, setup.receivers, setup.lights,
                                                          matrix_settings(setup, settings));
  setup.seconds["matrix"] = matrix_timer.seconds();
}

namespace {
bool takes_settings(const methods::MethodInfo& info, const std::map<std::string, std::string>& settings) {
  return std::all_of(settings.begin(), settings.end(), [&](const auto& given) {
    return std::any_of(info.parameters.begin(), info.parameters.end(),
                       [&](const methods::Parameter& p) { return p.key == given.first; });
  });
}
}  // namespace

const methods::MethodInfo& chosen_method(const RenderSettings& settings, std::string* why) {
  std::string because;
  const methods::MethodInfo* info = nullptr;
  if (settings.method != "auto") {
    info = &methods::find_method(settings.method);
    because = "as asked";
  } else {
    const auto& by_default = methods::find_method("slice-cuts");
    const auto& global = methods::find_method("row-column-sampling");
    const auto split = std::find_if(settings.aovs.begin(), settings.aovs.end(),
                                    [](const auto& aov) { return parts_light(aov); });
    if (split != settings.aovs.end()) {
      info = &global;
      because = "the layer '" + *split + "' takes one combination of columns";
    } else if (!takes_settings(by_default, settings.method_settings) &&
               takes_settings(global, settings.method_settings)) {
      info = &global;
      because = "--set names its parameters";
    } else {
      info = &by_default;
      because = "the default";
    }
  }
  if (why) *why = because;
  return *info;
}

std::size_t lights_for(const methods::MethodInfo& method, const RenderSettings& settings) {
  const std::size_t wanted = method.lights_wanted ? method.lights_wanted(settings.method_settings) : 0;
  return wanted > 0 ? wanted : settings.lights;
}

std::vector<Rgb> sample_values(const Setup& setup, std::span<const Rgb> sums, FilmParts parts) {
  const transport::Receivers& receivers = setup.receivers;
  std::vector<Rgb> values(receivers.samples());
  if (parts.emission) values = receivers.emission;
  if (parts.matrix)
    for (std::size_t i = 0; i < receivers.size(); ++i)
      values[receivers.sample[i]] += receivers.weight[i] * sums[i];
  const auto add = [&](const std::vector<Rgb>& traced) {
    for (std::size_t k = 0; k < traced.size(); ++k) values[k] += traced[k];
  };
  if (parts.traced_direct) add(setup.traced_direct);
  if (parts.traced_indirect) add(setup.traced_indirect), add(setup.traced_near);
  return values;
}

image::Image develop(const Setup& setup, std::span<const Rgb> values) {
  return film::splat(setup.view.width, setup.view.height, make_filter(setup.view.sensor.film.filter),
                     setup.receivers.film, values, {setup.view.crop_x, setup.view.crop_y});
}

Picture to_picture(const image::Image& image) {
  check_pixels(image);
  Picture picture;
  picture.width = image.width, picture.height = image.height;
  picture.planes.emplace_back();
  auto& rgb = picture.planes[0].rgb;
  rgb.reserve(image.pixels.size() * 3);
  for (const Rgb& p : image.pixels) rgb.insert(rgb.end(), {p.r, p.g, p.b});
  return picture;
}

}  // namespace lumirank::pipeline
