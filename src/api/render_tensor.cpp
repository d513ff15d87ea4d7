#include "api/render_tensor.h"

#include <cmath>
#include <cstdio>
#include <optional>

#include "api/build_world.h"
#include "api/scene.h"
#include "base/error.h"
#include "base/parallel.h"
#include "base/timer.h"
#include "base/version.h"
#include "methods/tensor_clustering/tensor_clustering.h"
#include "pipeline/develop.h"
#include "pipeline/media_parts.h"
#include "pipeline/media_run.h"
#include "pipeline/memory.h"
#include "pipeline/noise_metric.h"
#include "pipeline/report.h"
#include "pipeline/rest_tracing.h"
#include "pipeline/shot.h"

namespace lumirank::api {
namespace {

// What a frame of a chunk takes beside its picture, as measured: mappings, sums and albedo; places in the
// common numbering, weights and norms. And what does not grow with frames: the program, and entries of rows
// that are shaded afresh.
constexpr double kBytesOfRow = 90, kBytesOfLight = 100, kBytesOfProgram = 160e6;

// Of a frame, without its world.
double bytes_of_frame(const pipeline::View& view, const RenderSettings& settings, const TensorSettings& t,
                      bool in_media) {
  const double of_sample = in_media ? 1 + pipeline::kSegmentsOfShot : 1;
  const double lights = static_cast<double>(settings.lights.count_or_default()),
               rows =
                   static_cast<double>(view.width) * view.height * settings.view.spp_or_default() * of_sample;
  const double read = settings.method.target_error > 0
                          ? static_cast<double>(methods::TensorClusteringSettings{}.max_rows)
                          : t.rows;
  return pipeline::memory_of_picture(rows, lights, false) + kBytesOfRow * rows +
         (kBytesOfLight + read * t.bits / 8) * lights;
}

double bytes_of(const world::World& world) { return static_cast<double>(world.info().memory_bytes); }

// Later worlds share what does not move with those before them; by the third all that can be shared is.
constexpr std::size_t kWorldsToKnow = 3;

methods::TensorClusteringSettings inner(const TensorSettings& t) {
  methods::TensorClusteringSettings s;
  s.rows = static_cast<std::size_t>(t.rows), s.columns = static_cast<std::size_t>(t.columns);
  s.initial_clusters = static_cast<std::size_t>(t.initial_clusters);
  s.time_weight = t.time_weight, s.max_distance = t.max_distance, s.max_change = t.max_change;
  s.max_peak = t.max_peak;
  s.carrying = t.carrying == TensorSettings::Carrying::always  ? methods::Carrying::always
               : t.carrying == TensorSettings::Carrying::never ? methods::Carrying::never
                                                               : methods::Carrying::automatic;
  s.filter = static_cast<std::size_t>(t.filter);
  s.keep_rectangles = t.write_clusters;
  if (t.largest_representatives) s.representatives = methods::RepresentativeRule::largest;
  s.precision =
      t.bits == 32 ? linalg::ReducedTensor::Precision::bits32 : linalg::ReducedTensor::Precision::bits16;
  return s;
}

// Every column of every frame, on the same lights: what clusterings are measured against.
methods::TensorEstimate all_columns(const matrix::LightingTensor& tensor, const Sinks& sinks) {
  const Timer timer;
  methods::TensorEstimate estimate;
  for (std::size_t k = 0; k < tensor.frames(); ++k) {
    const auto frame = tensor.frame(k);
    const matrix::LightingMatrix& whole = *frame;
    std::vector<matrix::ScaledColumn> columns(whole.columns());
    for (std::size_t j = 0; j < columns.size(); ++j) columns[j].column = static_cast<matrix::Index>(j);
    estimate.sums.emplace_back(whole.rows(), Rgb(0));
    estimate.spent += whole.accumulate(columns, estimate.sums.back(), sinks);
    estimate.clusters += columns.size(), estimate.active.push_back(columns.size());
  }
  estimate.interrupted = sinks.cancelled();
  estimate.trace.numbers["seconds.columns"] = timer.seconds();
  return estimate;
}

void warn_of_error(double target, const methods::TensorEstimate& estimate, const Sinks& sinks) {
  if (!(target > 0) || estimate.predicted_error <= target) return;
  char text[160];
  std::snprintf(text, sizeof text,
                "--error %g is not reached with as many columns as there may be: rows that no cluster knows "
                "have an error of %.3g",
                target, estimate.predicted_error);
  sinks.warn(text);
}

// `seconds`: what preparing the frame took, by stage.
Report report_of(const matrix::LightingMatrix& frame, const std::map<std::string, double>& seconds,
                 const methods::TensorEstimate& estimate, std::size_t k, std::size_t frames,
                 const RenderSettings& settings, const TensorSettings& tensor) {
  Report report;
  report.method = methods::kMethodOfShots;
  report.version = program_version();
  report.seed = settings.seed;
  report.settings = settings;
  report.settings.method.name = report.method;
  report.settings.method.parameters = parameters_of(tensor);
  report.seconds = seconds;
  // Of the chunk, a frame's part of it.
  const auto part = static_cast<double>(frames);
  for (const auto& [key, value] : estimate.trace.numbers)
    if (key.starts_with("seconds."))
      report.seconds[key.substr(8)] = value / part;
    else
      report.numbers[key] = value;
  Report::Cost cost;
  cost.entries = estimate.spent.entries / frames, cost.culled = estimate.spent.culled / frames;
  cost.shadow_rays = estimate.spent.rays / frames;
  cost.sampling_rate = static_cast<double>(cost.entries) /
                       (static_cast<double>(frame.rows()) * static_cast<double>(frame.columns()));
  report.cost = cost;
  report.numbers["clusters"] = static_cast<double>(estimate.clusters) / part;
  report.numbers["clusters.carried"] = estimate.carried ? 1 : 0;
  report.numbers["clusters.active"] = static_cast<double>(estimate.active[k]);
  if (estimate.predicted_error >= 0) report.numbers["error.predicted"] = estimate.predicted_error;
  report.memory.peak = pipeline::peak_memory_bytes();
  return report;
}

}  // namespace

void check(const TensorSettings& t, const RenderSettings& settings) {
  const auto require = [](bool sound, const char* what, const char* remedy) {
    if (!sound) throw InputError(std::string("tensor clustering: ") + what, remedy);
  };
  require(settings.time <= 0, "it keeps no time budget",
          "leave out --time; --set columns=… decides its time");
  pipeline::check_metric(settings.method, false);
  require(settings.layers.empty(), "it makes no layers", "leave out --aov, or choose another method");
  require(!settings.view.is_open(), "its frames are of one moment each",
          "leave out --shutter, or choose another method");
  require(settings.traced.compensate == 0, "it gives back nothing of what clamping takes",
          "leave out --compensate");
  require(t.chunk >= 1 && t.chunk <= 1000, "a chunk has no such number of frames", "give 1 to 1000");
  require(t.overlap >= 0, "chunks overlap by a negative number of frames", "give 0 or more");
  require(t.memory >= 0 && std::isfinite(t.memory), "its memory is negative", "give a number of megabytes");
  require(t.rows >= 1 && t.rows <= 10'000, "there is no such number of rows", "give 1 to 10000");
  require(t.columns >= 0 && t.columns <= 1'000'000, "there is no such number of columns",
          "give 1 to 1000000, or 0 for all columns");
  require(t.initial_clusters >= 1, "there are no initial clusters", "give 1 or more");
  require(t.time_weight >= 0, "the weight of time is negative", "give 0 or more");
  require(t.max_change >= 0, "the greatest change of light is negative", "give 0 or more");
  require(t.max_peak >= 0, "the greatest peak of a cluster's light is negative", "give 0 or more");
  require(t.filter >= 0, "it filters over a negative number of frames", "give 0 or more");
  require(t.max_distance >= 0, "the greatest distance of a mapping is negative", "give 0 or more");
  require(t.bits == 16 || t.bits == 32, "entries have 16 or 32 bits", "give one of them");
}

int frames_within_memory(const std::vector<Scene>& first, const RenderSettings& settings,
                         const TensorSettings& t) {
  if (!(t.memory > 0)) return t.chunk;
  const bool in_media = pipeline::some_scatter(first.front().impl().desc);
  std::vector<pipeline::SharedWorld> worlds;
  double built = 0;
  for (const Scene& scene : first) {
    worlds.push_back(build_world(
        scene, {}, {.before = worlds.empty() ? nullptr : worlds.back().get(), .media = in_media}));
    built += bytes_of(*worlds.back());
  }
  const double later = bytes_of(*worlds.back());
  const double frame =
      bytes_of_frame(pipeline::make_view(first.front().impl().desc, settings.view), settings, t, in_media);
  // built + later · (n − worlds) + frame · n = what is given.
  const double once = kBytesOfProgram + built - later * static_cast<double>(worlds.size());
  const double fitting = std::floor((1e6 * t.memory - once) / (later + frame)), overlap = t.overlap;
  // A chunk overlaps by no more frames than it has.
  const double length = fitting >= 2 * overlap ? fitting - overlap : std::floor(fitting / 2);
  if (length < 1)
    throw InputError("tensor clustering takes about " +
                         std::to_string(std::lround((once + (later + frame) * (overlap > 0 ? 2 : 1)) / 1e6)) +
                         " MB for one frame and its overlap, more than the memory that is given",
                     "give more with --method tensor-clustering --set memory=…, or fewer --lights, a smaller "
                     "--size or a lower --spp");
  return static_cast<int>(std::min<double>(t.chunk, length));
}

namespace {

// What a part of a shot is rendered of.
struct Part {
  const std::vector<pipeline::SharedWorld>& worlds;
  const std::vector<pipeline::View>& views;
  const RenderSettings& settings;
  const TensorSettings& tensor;
  double build_seconds;  // of a frame
  const Sinks& sinks;
};

// Empty if it was cancelled.
std::optional<methods::TensorEstimate> estimate(const Part& part, const matrix::LightingTensor& shot,
                                                const methods::TensorClusteringSettings& how,
                                                TensorFrames& made) {
  methods::RunOptions options;
  options.seed = part.settings.seed;
  options.sinks = part.sinks;
  methods::TensorEstimate estimate =
      part.tensor.columns == 0 ? all_columns(shot, part.sinks) : methods::estimate_tensor(shot, how, options);
  if (estimate.interrupted) return std::nullopt;
  made.rectangles = std::move(estimate.rectangles);
  made.lights = shot.columns();
  warn_of_error(how.target_error, estimate, part.sinks);
  return estimate;
}

methods::TensorClusteringSettings how_for(const Part& part) {
  methods::TensorClusteringSettings how = inner(part.tensor);
  how.target_error = part.settings.method.target_error;
  return how;
}

void render_in_space(const Part& part, TensorFrames& made) {
  const auto& [worlds, views, settings, tensor, build_seconds, sinks] = part;
  Sinks silent;
  silent.cancel = sinks.cancel;
  pipeline::Recipe recipe = pipeline::make_recipe(settings, views.front());
  recipe.row_albedo = true;
  if (recipe.lights.placement == LightPlacement::automatic) recipe.lights.placement = LightPlacement::gather;
  const auto frames =
      pipeline::prepare_shot(worlds, views, recipe, settings.lights.count_or_default(), sinks);
  const pipeline::ShotTensor shot(frames);
  const auto found = estimate(part, shot, how_for(part), made);
  if (!found) return;
  // Whether the rest of the light matters is asked once, so that it does not come and go.
  const std::size_t middle = frames.size() / 2;
  const pipeline::RestPlan rest_plan =
      pipeline::plan_rest(*worlds[middle], views[middle], settings, pipeline::LightPaths::beside, silent);
  for (std::size_t k = 0; k < frames.size(); ++k) {
    const pipeline::Prepared& frame = *frames[k];
    RenderResult result;
    pipeline::FilmFits fits;
    image::Image image = pipeline::develop(pipeline::film_input(frame), found->sums[k],
                                           pipeline::wanted_parts(settings.view.only), &fits);
    pipeline::RestTracing rest(frame.world, settings, rest_plan);
    if (!rest.trace_all(frame.view, silent)) throw Cancelled();
    rest.add_to(image);
    result.picture = pipeline::to_picture(image);
    result.report = report_of(*frame.matrix, frame.seconds, *found, k, frames.size(), settings, tensor);
    pipeline::add_film_numbers(result.report.numbers, recipe,
                               pipeline::seen_rows(frame.receivers(), frame.traced), fits);
    if (rest_plan.piloted) result.report.numbers["rest.share"] = rest_plan.pilot.share;
    result.report.numbers["rest.paths"] = rest.paths();
    result.report.seconds["build"] = build_seconds;
    result.report.seconds["rest"] = rest.seconds();
    result.report.numbers["lights.in_all_frames"] = shot.common_share();
    made.frames.push_back(std::move(result));
  }
}

void render_in_media(const Part& part, TensorFrames& made) {
  pipeline::check_media(part.settings);
  if (part.settings.method.target_error > 0)
    throw InputError(
        "tensor clustering finds no number of columns for an error in a scene with "
        "participating media",
        "leave out --error; --set columns=… decides");
  const auto frames = pipeline::prepare_shot_in_media(
      part.worlds, part.views, pipeline::make_recipe(part.settings, part.views.front()),
      part.settings.lights.count_or_default(), part.sinks);
  methods::TensorClusteringSettings how = how_for(part);
  // What a row is, a piece of an eye ray with what scatters in it, no other frame has.
  how.carrying = methods::Carrying::never;
  how.two_of_a_place = true;
  const auto found = estimate(part, pipeline::MediaShotTensor(frames), how, made);
  if (!found) return;
  for (std::size_t k = 0; k < frames.size(); ++k) {
    const pipeline::PreparedMedia& frame = *frames[k];
    RenderResult result;
    result.picture = pipeline::to_picture(pipeline::picture_of(frame, found->sums[k]));
    result.report =
        report_of(*frame.matrix, frame.seconds, *found, k, frames.size(), part.settings, part.tensor);
    result.report.numbers["eye_segments"] = static_cast<double>(frame.rows.segments.size());
    result.report.numbers["ray_lights"] = static_cast<double>(frame.lights.rays.size());
    result.report.seconds["build"] = part.build_seconds;
    made.frames.push_back(std::move(result));
  }
}

}  // namespace

TensorFrames render_tensor(const std::vector<Scene>& scenes, const RenderSettings& settings,
                           const TensorSettings& tensor, const Sinks& sinks) {
  TensorFrames made;
  const bool in_media = pipeline::some_scatter(scenes.front().impl().desc);
  pipeline::within_memory(pipeline::kSmallerPicture, [&] {
    with_threads(settings.threads, [&] {
      const Timer timer;
      std::vector<pipeline::SharedWorld> worlds;
      std::vector<pipeline::View> views;
      Sinks silent;
      silent.cancel = sinks.cancel;
      for (const Scene& scene : scenes) {
        worlds.push_back(
            build_world(scene, worlds.empty() ? sinks : silent,
                        {.before = worlds.empty() ? nullptr : worlds.back().get(), .media = in_media}));
        views.push_back(pipeline::make_view(scene.impl().desc, settings.view));
        if (worlds.size() != std::min(kWorldsToKnow, scenes.size())) continue;
        pipeline::require_memory(
            bytes_of(*worlds.back()) * static_cast<double>(scenes.size() - worlds.size()) +
                bytes_of_frame(views[0], settings, tensor, in_media) * static_cast<double>(scenes.size()),
            "give --set memory=… (in MB) or --set chunk=… for shorter chunks, or fewer --lights");
      }
      const double build_seconds = timer.seconds() / static_cast<double>(scenes.size());
      const Part part{worlds, views, settings, tensor, build_seconds, sinks};
      try {
        if (in_media)
          render_in_media(part, made);
        else
          render_in_space(part, made);
      } catch (const Cancelled&) {
        made.frames.clear();
      }
    });
  });
  return made;
}

}  // namespace lumirank::api
