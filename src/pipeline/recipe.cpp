#include "pipeline/recipe.h"

#include <algorithm>

#include "base/error.h"
#include "pipeline/layers.h"

namespace lumirank::pipeline {

View make_view(const scenedesc::SceneDesc& desc, const ViewSettings& settings) {
  world::ViewChoice choice{settings.camera, settings.width, settings.height, {}, settings.max_depth};
  std::copy(settings.crop.begin(), settings.crop.end(), choice.crop);
  return world::make_view(desc, choice);
}

pathtrace::ReferenceOptions reference_options(LightPart only, std::uint64_t seed, ReferencePaths paths) {
  pathtrace::ReferenceOptions options;
  options.seed = seed;
  options.paths = paths == ReferencePaths::columns ? pathtrace::Paths::columns
                  : paths == ReferencePaths::rest  ? pathtrace::Paths::rest
                                                   : pathtrace::Paths::all;
  // A part is that part alone: emission seen directly belongs to neither.
  options.emission = only == LightPart::all;
  options.direct = only != LightPart::indirect;
  options.indirect = only != LightPart::direct;
  return options;
}

namespace {

float roughness_traced(const RenderSettings& settings, float sharp_below) {
  if (settings.view.only == LightPart::indirect || settings.traced.direct == DirectLight::matrix) return 0;
  if (settings.traced.direct == DirectLight::traced) return 2;  // roughness never exceeds 1
  // Traced light does not know its emitter.
  for (const auto& layer : settings.layers)
    if (layer.starts_with("light:")) return 0;
  return std::max(0.15f, sharp_below);
}

// Spheres are wide enough by themselves, and what paths make whole may not be blurred. With 0.1 pictures are
// nearest to the path tracer's; with 0.3 their caustics flicker half as much.
float least_roughness(const Recipe& recipe) {
  if (recipe.lights.type != LightType::point || recipe.compensated ||
      (recipe.local_paths > 0 && recipe.near_lights == 0))
    return 0;
  const double unset = recipe.lights.placement == LightPlacement::gather ? 0.3 : 0.1;
  return static_cast<float>(recipe.lights.roughness.value_or(unset));
}

}  // namespace

Recipe make_recipe(const RenderSettings& settings, const View& view) {
  Recipe recipe;
  recipe.seed = recipe.light_seed = settings.seed;
  recipe.spp = settings.view.spp_or_default();
  // Sums that are right for a pixel's receivers together say nothing of one surface of it; with an open
  // shutter a pixel's receivers are of several moments.
  if (!chosen_method(settings).contract.sums_of_pixels && !settings.view.is_open())
    recipe.film_samples = settings.view.film_samples_or_default();
  recipe.max_depth = view.max_depth;
  recipe.only = settings.view.only;
  recipe.lights = settings.lights;
  recipe.local_paths = settings.traced.local_paths;
  if (recipe.local_paths > 0) {
    recipe.sharp_below = static_cast<float>(settings.traced.local_sharp);
    if (settings.lights.type == LightType::sphere)
      recipe.near_radii = static_cast<float>(settings.traced.local_near);
  }
  recipe.traced_below = roughness_traced(settings, recipe.sharp_below);
  recipe.first_hits = !settings.layers.empty();
  recipe.group_by_emitter = std::any_of(settings.layers.begin(), settings.layers.end(), parts_light);
  recipe.compensated = settings.traced.compensate > 0;
  return recipe;
}

transport::ReceiverSettings receiver_settings(const Recipe& recipe, const View& view) {
  transport::ReceiverSettings rs;
  rs.seed = recipe.seed, rs.pass = recipe.pass;
  rs.spp = recipe.spp;
  rs.max_depth = recipe.max_depth;
  rs.film_samples = recipe.film_samples;
  // The window, and around it what its filter reaches; film samples there need a pixel more.
  const auto& film = view.sensor.film;
  const int reach = world::make_filter(film.filter).reach() + (recipe.film_samples > 0 ? 1 : 0);
  rs.crop_x = std::max(0, view.crop_x - reach), rs.crop_y = std::max(0, view.crop_y - reach);
  rs.crop_width = std::min(film.width, view.crop_x + view.width + reach) - rs.crop_x;
  rs.crop_height = std::min(film.height, view.crop_y + view.height + reach) - rs.crop_y;
  rs.first_hits = recipe.first_hits;
  rs.instants = recipe.instants, rs.instant = recipe.instant;
  rs.pixels = recipe.pixels;
  return rs;
}

transport::LightSettings light_settings(const Recipe& recipe) {
  transport::LightSettings ls;
  ls.seed = recipe.light_seed;
  ls.max_depth = recipe.max_depth;
  ls.direct = recipe.only != LightPart::indirect;
  ls.indirect = recipe.only != LightPart::direct;
  ls.lobes.diffuse_only = recipe.lights.type == LightType::diffuse_point;
  ls.lobes.least_roughness = least_roughness(recipe);
  ls.traced_direct_below = recipe.traced_below;
  ls.on_gather_samples = recipe.lights.placement == LightPlacement::gather;
  ls.brief_survey = recipe.brief_survey;
  return ls;
}

transport::SceneMatrixSettings matrix_settings(const Recipe& recipe) {
  using Rules = transport::SphereRules;
  transport::SceneMatrixSettings ms;
  ms.seed = recipe.light_seed;
  ms.clamp = static_cast<float>(recipe.lights.clamp);
  ms.compensated = recipe.compensated;
  ms.row_albedo = recipe.row_albedo;
  ms.spheres.indicator = recipe.lights.sphere_indicator == SphereIndicator::cosine ? Rules::Indicator::cosine
                                                                                   : Rules::Indicator::disc;
  ms.spheres.strategies = recipe.lights.sphere_strategies == SphereStrategies::cone ? Rules::Strategies::cone
                                                                                    : Rules::Strategies::all;
  ms.spheres.samples =
      recipe.lights.sphere_samples == SphereSamples::cone ? Rules::Samples::cone : Rules::Samples::overlap;
  ms.spheres.beyond = recipe.near_radii;
  ms.max_depth = recipe.max_depth;
  ms.traced_direct_below = recipe.traced_below;
  ms.group_by_emitter = recipe.group_by_emitter;
  return ms;
}

bool takes_settings(const methods::MethodInfo& info, const std::map<std::string, std::string>& settings) {
  return std::all_of(settings.begin(), settings.end(), [&](const auto& given) {
    return std::any_of(info.parameters.begin(), info.parameters.end(),
                       [&](const methods::Parameter& p) { return p.key == given.first; });
  });
}

const methods::MethodInfo& chosen_method(const RenderSettings& settings, std::string* why) {
  std::string because;
  const methods::MethodInfo* info = nullptr;
  if (settings.method.name != "auto") {
    info = &methods::find_method(settings.method.name);
    because = "as asked";
  } else {
    const auto& by_default = methods::find_method("slice-cuts");
    const auto& global = methods::find_method("row-column-sampling");
    const auto& over_time = methods::find_method("multidimensional-lightcuts");
    const auto split = std::find_if(settings.layers.begin(), settings.layers.end(), parts_light);
    if (settings.view.is_open()) {
      info = &over_time;
      because = "the shutter is open for a while";
    } else if (split != settings.layers.end()) {
      info = &global;
      because = "the layer '" + *split + "' takes one combination of columns";
    } else if (!takes_settings(by_default, settings.method.parameters) &&
               takes_settings(global, settings.method.parameters)) {
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
  const std::size_t wanted = method.lights_wanted ? method.lights_wanted(settings.method.parameters) : 0;
  return wanted > 0 ? wanted : settings.lights.count_or_default();
}

}  // namespace lumirank::pipeline
