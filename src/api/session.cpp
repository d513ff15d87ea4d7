#include "lumirank/session.h"

#include <algorithm>

#include "api/build_world.h"
#include "api/matrix.h"
#include "api/scene.h"
#include "base/error.h"
#include "base/parallel.h"
#include "matrix/metered_matrix.h"
#include "methods/method.h"
#include "pipeline/develop.h"
#include "pipeline/layers.h"
#include "pipeline/memory.h"
#include "pipeline/noise_metric.h"

namespace lumirank {

struct Prepared::Impl {
  std::shared_ptr<const Scene::Impl> scene;
  pipeline::SharedPrepared prepared;
  RenderSettings settings;
};

namespace {

const Prepared::Impl& require_prepared(const Prepared& prepared) {
  if (!prepared) throw InputError("nothing is prepared", "call prepare() first");
  return prepared.impl();
}

methods::Estimate to_inner(const Estimate& estimate) {
  methods::Estimate inner;
  inner.sums = estimate.sums;
  inner.combination = to_scaled(estimate.combination);
  return inner;
}

void require_sums(const Estimate& estimate, const pipeline::Prepared& prepared) {
  if (estimate.sums.size() != prepared.matrix->rows())
    throw InputError("the estimate has " + std::to_string(estimate.sums.size()) + " sums, the matrix " +
                         std::to_string(prepared.matrix->rows()) + " rows",
                     "develop it with what it was estimated on");
}

}  // namespace

Matrix Prepared::matrix() const {
  return Matrix(std::make_shared<Matrix::Impl>(Matrix::Impl{require_prepared(*this).prepared}));
}
int Prepared::width() const { return require_prepared(*this).prepared->view.width; }
int Prepared::height() const { return require_prepared(*this).prepared->view.height; }
std::map<std::string, double> Prepared::seconds() const { return require_prepared(*this).prepared->seconds; }

std::vector<std::string> Prepared::lights() const {
  std::vector<std::string> names;
  for (const auto& e : require_prepared(*this).prepared->world->emitters())
    if (std::find(names.begin(), names.end(), e.name) == names.end()) names.push_back(e.name);
  return names;
}

Prepared prepare(const Scene& scene, const RenderSettings& settings, const Sinks& sinks,
                 const Prepared& previous) {
  validate(settings);
  pipeline::check_metric(settings.method, false);
  if (settings.view.is_open())
    throw InputError("what is prepared is of one moment", "leave out the shutter, or use render()");
  auto impl = std::make_shared<Prepared::Impl>();
  impl->scene = scene.share();
  impl->settings = settings;
  pipeline::within_memory(pipeline::kSmallerPicture, [&] {
    with_threads(settings.threads, [&] {
      const world::View view = pipeline::make_view(scene.impl().desc, settings.view);
      const pipeline::Recipe recipe = pipeline::make_recipe(settings, view);
      const std::size_t lights = settings.lights.count_or_default();
      const double samples = static_cast<double>(view.width) * static_cast<double>(view.height) * recipe.spp;
      pipeline::require_countable(samples);
      pipeline::require_memory(
          pipeline::memory_of_picture(samples, static_cast<double>(lights), recipe.first_hits),
          pipeline::kSmallerPicture);
      const bool same_scene = previous && previous.impl().scene == impl->scene;
      const pipeline::SharedPrepared before = same_scene ? previous.impl().prepared : nullptr;
      const pipeline::SharedWorld world = before ? before->world : api::build_world(scene, sinks);
      pipeline::check_lights(*world, settings, recipe);
      impl->prepared = pipeline::prepare(world, view, recipe, lights, before, sinks);
    });
  });
  return Prepared(std::move(impl));
}

Estimate estimate_sums(const Prepared& prepared, const MethodSettings& method,
                       const EstimateOptions& options) {
  const Prepared::Impl& impl = require_prepared(prepared);
  RenderSettings settings = impl.settings;
  settings.method = method;
  const methods::MethodInfo& info = pipeline::chosen_method(settings);
  if (info.contract.sums_of_pixels && impl.prepared->recipe.film_samples > 0)
    throw InputError("the sums of " + info.name + " are right for whole pixels, not for surfaces in them",
                     "prepare() with this method, or with film_samples 0");
  methods::RunOptions run;
  run.seed = method.seed ? method.seed : settings.seed;
  run.target_error = method.target_error;
  run.time_seconds = options.time;
  run.sinks = options.sinks;
  run.on_estimate = options.on_estimate;
  methods::Estimate made;
  const matrix::MeteredMatrix matrix(*impl.prepared->matrix);
  with_threads(settings.threads, [&] { made = info.make(method.parameters)->run(matrix, run); });
  Estimate estimate;
  estimate.sums = std::move(made.sums);
  for (const matrix::ScaledColumn& c : made.combination)
    estimate.combination.push_back({c.column, c.scale, c.max_contribution});
  estimate.numbers = std::move(made.trace.numbers);
  estimate.notes = std::move(made.trace.notes);
  estimate.notes["method"] = info.name;
  estimate.interrupted = made.interrupted;
  const matrix::Cost cost = matrix.total();
  estimate.cost = {cost.entries, cost.culled, cost.rays};
  return estimate;
}

Picture develop(const Prepared& prepared, const Estimate& estimate, const std::vector<std::string>& layers,
                const Sinks& sinks) {
  const Prepared::Impl& impl = require_prepared(prepared);
  const pipeline::Prepared& p = *impl.prepared;
  require_sums(estimate, p);
  RenderSettings wanted = impl.settings;
  wanted.layers = layers;
  for (const std::string& layer : layers) {
    set_field(wanted, "aov", layer);  // throws for an unknown name
    if (layer == "illuminance")
      throw InputError("develop() cannot make the layer 'illuminance', which takes an estimate of its own",
                       "use render() with this layer");
    if (pipeline::parts_light(layer) && estimate.combination.empty())
      throw InputError("the layer '" + layer + "' takes one combination of columns for all receivers",
                       "estimate with row-column-sampling");
    if (pipeline::parts_light(layer) && !p.recipe.group_by_emitter)
      throw InputError("columns of different emitters may have been clustered together",
                       "name the layer '" + layer + "' to prepare() as well");
    if (!pipeline::parts_light(layer) && layer != "emission" && layer != "samples" && !p.recipe.first_hits)
      throw InputError("what the eye meets first was not kept", "name the layer to prepare() as well");
  }
  wanted.layers = layers;
  pipeline::check_lights(*p.world, wanted, p.recipe);
  Picture picture;
  with_threads(impl.settings.threads, [&] {
    picture = pipeline::to_picture(
        pipeline::develop(pipeline::film_input(p), estimate.sums, pipeline::wanted_parts(p.recipe.only)));
    if (!pipeline::add_layers(picture, p, p.traced, to_inner(estimate), layers, sinks)) throw Cancelled();
  });
  return picture;
}

Relighting::Relighting(const Prepared& prepared, const Estimate& estimate, const Sinks& sinks) {
  Picture picture = develop(prepared, estimate, {"emission", "light:*"}, sinks);
  emission_.width = picture.width, emission_.height = picture.height;
  for (Plane& plane : picture.planes) {
    if (plane.name == "emission") {
      plane.name.clear();
      emission_.planes.push_back(std::move(plane));
    } else if (plane.name.starts_with("light:")) {
      plane.name = plane.name.substr(6);
      by_light_.push_back(std::move(plane));
    }
  }
}

std::vector<std::string> Relighting::lights() const {
  std::vector<std::string> names;
  for (const Plane& plane : by_light_) names.push_back(plane.name);
  return names;
}

Picture Relighting::picture(const std::map<std::string, Rgb>& factors) const {
  const auto known_light = [&](const std::string& name) {
    return std::any_of(by_light_.begin(), by_light_.end(), [&](const Plane& p) { return p.name == name; });
  };
  for (const auto& [name, factor] : factors)
    if (!known_light(name)) {
      std::string known;
      for (const Plane& p : by_light_) known += (known.empty() ? "" : ", ") + p.name;
      throw InputError("there is no light '" + name + "'", "the lights are " + known);
    }
  Picture picture = emission_;
  std::vector<float>& sum = picture.planes[0].rgb;
  for (const Plane& plane : by_light_) {
    const auto found = factors.find(plane.name);
    const Rgb factor = found == factors.end() ? Rgb(1) : found->second;
    for (std::size_t k = 0; k < sum.size(); ++k) sum[k] += plane.rgb[k] * factor[static_cast<int>(k % 3)];
  }
  return picture;
}

}  // namespace lumirank
