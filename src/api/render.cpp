// Rendering and the reference.
#include <nlohmann/json.hpp>

#include "api/build_world.h"
#include "api/render_in_shot.h"
#include "api/scene.h"
#include "api/shutter.h"
#include "base/error.h"
#include "base/parallel.h"
#include "base/timer.h"
#include "base/version.h"
#include "lumirank/lumirank.h"
#include "pathtrace/reference.h"
#include "pipeline/develop.h"
#include "pipeline/error_advice.h"
#include "pipeline/exposure_run.h"
#include "pipeline/layers.h"
#include "pipeline/media_run.h"
#include "pipeline/memory.h"
#include "pipeline/noise_metric.h"
#include "pipeline/pass_run.h"
#include "pipeline/path_run.h"
#include "pipeline/preview_throttle.h"
#include "pipeline/render_run.h"
#include "pipeline/report.h"
#include "pipeline/view_check.h"
#include "world/colored_glass.h"

namespace lumirank {
namespace {

double pixels_of(const pipeline::View& view) {
  return static_cast<double>(view.width) * static_cast<double>(view.height);
}

double memory_of(const pipeline::View& view, const RenderSettings& settings, std::size_t lights) {
  return pipeline::memory_of_picture(pixels_of(view) * settings.view.spp_or_default(),
                                     static_cast<double>(lights), !settings.layers.empty());
}

std::size_t reference_instants(const RenderSettings& settings) {
  return static_cast<std::size_t>(settings.view.shutter_samples.value_or(ViewSettings::kReferenceInstants));
}

void within_memory_and_threads(const RenderSettings& settings, const std::function<void()>& work) {
  pipeline::within_memory(pipeline::kSmallerPicture, [&] { with_threads(settings.threads, work); });
}

void say_glass(const world::WorldInfo& info, const Sinks& sinks) {
  if (info.touching_faces > 0)
    sinks.say("glass, water, fog or lamps end in the plane of something else: " +
              std::to_string(info.touching_faces) + " of their triangles are moved by a hair");
  if (info.panes + info.bending_glass == 0) return;
  sinks.say("smooth glass: light passes " + std::to_string(info.panes) +
            " shapes straight, as thin panes, and is bent by " + std::to_string(info.bending_glass) +
            (info.bending_glass > 0 ? ", whose light is left to paths (--rest)" : ""));
}

}  // namespace

std::string version() { return program_version(); }
std::string instruction_set() { return program_instruction_set(); }

RenderResult render(const Scene& scene, const RenderSettings& settings, const Sinks& sinks,
                    const PreviewCallback& on_preview) {
  return api::render_by_choice(scene, settings, {}, sinks, on_preview);
}

RenderResult api::render_by_choice(const Scene& scene, const RenderSettings& settings, InShot shot,
                                   const Sinks& sinks, const PreviewCallback& on_preview) {
  RenderSettings chosen = settings;
  const scenedesc::SceneDesc& desc = scene.impl().desc;
  if (pipeline::paths_by_default(desc, settings) && world::may_color_glass(desc)) {
    validate(settings);
    shot.timer = Timer(settings.time_spent);
    within_memory_and_threads(settings, [&] {
      // What there is to say of it is said once, of the world that is rendered.
      Sinks quiet = sinks;
      quiet.info = quiet.warning = {};
      std::vector<scenedesc::Warning> warnings;
      shot.world = api::build_world(scene, quiet,
                                    {.warnings = &warnings,
                                     .before = shot.before.get(),
                                     .straight_panes = settings.traced.panes == Panes::straight});
      if (world::colors_glass(*shot.world))
        api::report_warnings(sinks, warnings);
      else
        shot.world = nullptr;
    });
  }
  if (!pipeline::may_be_paths(settings)) shot.kind = InShot::Kind::open;
  if (shot.kind != InShot::Kind::paths && (shot.world || !pipeline::paths_by_default(desc, settings)) &&
      pipeline::passes_by_default(desc, settings)) {
    chosen.method.name = pipeline::kMethodOfPasses;
    if (shot.why.empty()) shot.why = "the default";
    shot.may_be_paths = shot.kind == InShot::Kind::open && pipeline::may_be_paths(settings) &&
                        settings.passes == 0 && !settings.view.spp && settings.view.only == LightPart::all;
  }
  return api::render_in_shot(scene, chosen, shot, sinks, on_preview);
}

RenderResult api::render_in_shot(const Scene& scene, const RenderSettings& settings, const InShot& shot,
                                 const Sinks& sinks, const PreviewCallback& on_preview) {
  validate(settings);
  RenderResult result;
  within_memory_and_threads(settings, [&] {
    pipeline::RenderTask task;
    task.timer = shot.timer ? *shot.timer : Timer(settings.time_spent);
    task.part_of_usual = shot.part_of_usual;
    task.shot_lights = shot.lights;
    task.view = pipeline::make_view(scene.impl().desc, settings.view);
    const bool by_paths =
        shot.kind == InShot::Kind::paths || pipeline::paths_by_default(scene.impl().desc, settings);
    const bool in_media = by_paths || (pipeline::some_scatter(scene.impl().desc) && !settings.view.is_open());
    task.info = in_media ? &pipeline::chosen_method_in_media(settings, &task.why)
                         : &pipeline::chosen_method(settings, &task.why);
    task.by_default = settings.method.name == "auto" && settings.method.parameters.empty() &&
                      settings.method.target_error <= 0 && !task.info->contract.combination;
    if (in_media) pipeline::check_media(*task.info, settings);
    if (!shot.why.empty()) task.why = shot.why;
    // A repetition names the method of passes, and has the choice among its own.
    task.may_be_paths = shot.may_be_paths || settings.choices.contains("trial_paths") ||
                        settings.choices.contains(pipeline::kChoiceOfPaths);
    const bool passes = pipeline::runs_in_passes(*task.info, settings) && !in_media;
    if (passes) pipeline::check_passes(settings);
    pipeline::check_metric(settings.method, passes || by_paths);
    pipeline::check_layers(*task.info, settings);
    methods::require_capabilities(*task.info, transport::SceneMatrix::kCapabilities);
    task.method = task.info->make(settings.method.parameters);
    if (const std::string text = pipeline::error_not_aimed_at(*task.info, settings.method.target_error);
        !text.empty() && !passes)
      sinks.warn(text);
    pipeline::require_countable(pixels_of(task.view) * settings.view.spp_or_default());
    const double memory = memory_of(task.view, settings, pipeline::lights_for(*task.info, settings));
    pipeline::require_memory(memory, pipeline::kSmallerPicture);
    if (settings.view.is_open()) {
      pipeline::check_exposure(*task.info, settings);
      const auto count = settings.view.shutter_samples.value_or(ViewSettings::kDefaultInstants);
      const auto instants = api::open_shutter(scene, settings, static_cast<std::size_t>(count), false, sinks);
      task.build_seconds = task.timer.seconds();
      pipeline::require_memory(memory, pipeline::kSmallerPicture);
      result = pipeline::run_exposure(instants, std::move(task), settings, sinks, on_preview);
      return;
    }
    task.world = shot.world ? shot.world
                            : api::build_world(scene, sinks,
                                               {.before = shot.before.get(),
                                                .media = in_media,
                                                .refit = shot.refit ? shot.refit->get() : nullptr,
                                                .straight_panes = settings.traced.panes == Panes::straight});
    if (shot.refit) *shot.refit = task.world;
    task.build_seconds = task.timer.seconds();
    say_glass(task.world->info(), sinks);
    if (const std::string text = pipeline::empty_view(*task.world, task.view); !text.empty())
      sinks.warn(text);
    pipeline::require_memory(memory, pipeline::kSmallerPicture);  // the scene has taken its part
    if (sinks.cancelled()) throw Cancelled();
    pipeline::check_lights(*task.world, settings, pipeline::make_recipe(settings, task.view));
    task.lumens_per_unit = scene.impl().desc.lumens_per_unit;
    pipeline::PictureFeatures features;
    if (shot.filmed) task.features = &features;
    const auto world = task.world;
    const pipeline::View view = task.view;
    result = by_paths   ? pipeline::run_by_paths(std::move(task), settings, sinks, on_preview)
             : in_media ? pipeline::run_in_media(std::move(task), settings, sinks, on_preview)
             : passes   ? pipeline::run_in_passes(std::move(task), settings, sinks, on_preview)
                        : pipeline::run_render(std::move(task), settings, sinks, on_preview);
    if (shot.filmed && !result.interrupted)
      *shot.filmed = pipeline::shot_frame(world, view, pipeline::image_of(result.picture), features);
  });
  return result;
}

RenderResult reference(const Scene& scene, const RenderSettings& settings, const ReferenceSettings& how,
                       const Sinks& sinks, const PreviewCallback& on_preview) {
  validate(settings);
  for (const auto& layer : settings.layers)
    if (layer != "direct" && layer != "indirect" && layer != "emission")
      throw InputError("the reference has no AOV '" + layer + "'", "it has direct, indirect and emission");
  RenderResult result;
  within_memory_and_threads(settings, [&] {
    const Timer timer;
    const world::View view = pipeline::make_view(scene.impl().desc, settings.view);
    pipeline::require_memory(pipeline::memory_of_reference(pixels_of(view)), pipeline::kSmallerPicture);
    const bool open = settings.view.is_open();
    const std::vector<pathtrace::Instant> instants =
        open ? api::open_shutter(scene, settings, reference_instants(settings), true, sinks)
             : std::vector<pathtrace::Instant>{{api::build_world(scene, sinks, {.media = true}), view}};
    const double build_seconds = timer.seconds();
    if (how.paths != ReferencePaths::all && !instants.front().world->media().empty())
      throw InputError("--paths " + to_text(how.paths) + " leaves out paths by what they meet on surfaces",
                       "in a scene with participating media leave --paths out");
    if (!open)
      if (const std::string text = pipeline::empty_view(*instants.front().world, view); !text.empty())
        sinks.warn(text);
    pipeline::PreviewThrottle throttle(on_preview);
    const auto traced = pathtrace::path_trace(
        instants, pipeline::reference_options(settings.view.only, settings.seed, how.paths),
        {how.spp, how.time, how.error}, sinks, [&](const image::Image& image) {
          if (throttle.due()) throttle.show(pipeline::to_picture(image));
        });
    result.interrupted = traced.interrupted;
    result.picture = pipeline::to_picture(traced.image);
    for (const auto& layer : settings.layers) {
      const image::Image& plane = layer == "direct"     ? traced.direct
                                  : layer == "indirect" ? traced.indirect
                                                        : traced.emission;
      result.picture.planes.push_back({layer, pipeline::to_picture(plane).planes[0].rgb});
    }
    Report& report = result.report;
    report.method = "reference";
    report.version = program_version();
    report.seed = settings.seed;
    report.notes["paths"] = to_text(how.paths);
    report.numbers = {{"spp", traced.spp}, {"error.relative_l1", traced.error}};
    if (open) report.numbers["shutter.instants"] = static_cast<double>(instants.size());
    report.seconds = {{"total", timer.seconds()}, {"build", build_seconds}};
    report.memory.peak = pipeline::peak_memory_bytes();
    report.settings = settings;
    result.summary = std::to_string(traced.spp) + " paths per pixel; stated relative L1 error " +
                     nlohmann::json(traced.error).dump();
  });
  return result;
}

}  // namespace lumirank
