#include "pipeline/media_run.h"

#include <algorithm>
#include <optional>

#include "base/error.h"
#include "base/random.h"
#include "matrix/metered_matrix.h"
#include "pipeline/develop.h"
#include "pipeline/error_advice.h"
#include "pipeline/preview_throttle.h"
#include "pipeline/report.h"
#include "transport/cpu/media_matrix.h"
#include "transport/lights/cut_rays.h"
#include "transport/lights/ray_lights.h"
#include "transport/lights/ray_tree.h"
#include "transport/rows/eye_groups.h"

namespace lumirank::pipeline {
namespace {

// Parts of a ray's way through a medium (Huo et al. 2016, section 4.1: 16 points).
constexpr int kSegmentsPerRay = 17;

// Pieces of light rays for methods that go by bounds: as many as made cuts better in the hall of the
// experiments.
constexpr double kPiecesOfLightRays = 4;

// At so many places of a segment at least the light of all emitters together is estimated: one place for the
// sun made noise of its shafts.
constexpr std::size_t kLeastDirect = 32;

class MediaRun {
 public:
  MediaRun(RenderTask task, const RenderSettings& asked, const Sinks& sinks, const PreviewCallback& preview)
      : task_(std::move(task)),
        asked_(asked),
        sinks_(sinks),
        throttle_(preview),
        previews_(static_cast<bool>(preview)),
        recipe_(make_recipe(asked, task_.view)) {
    // Receivers are the film samples: what is seen of a medium belongs to no surface that others could share.
    recipe_.film_samples = 0;
    // Noise of rows goes away over passes as well.
    if (asked.time > 0 && !asked.view.spp) recipe_.spp = 1;
    if (!asked.choices.empty()) choices_ = methods::TimedChoices(asked.choices);
  }

  RenderResult run() {
    sinks_.say("method: " + task_.info->name + " (" + task_.why + ")");
    if (asked_.time > 0 && asked_.method.name == "auto" && asked_.method.parameters.empty())
      task_.method = task_.info->make(of_a_pass());
    do {
      pass();
    } while (!result_.interrupted && again());
    if (asked_.time > 0) {
      choices_.record("passes", passes_);
      choices_.expect_end();
      if (const double took = task_.timer.seconds();
          passes_ == 1 && took > 1.2 * asked_.time && asked_.choices.empty())
        sinks_.warn("one pass over the picture took " + std::to_string(static_cast<int>(took + 0.5)) +
                    " s, more than was asked for; give a smaller --size, or fewer --lights");
    }
    result_.picture = to_picture(image_);
    // An interrupted run cannot be repeated: where it was stopped was no choice of its own.
    if (result_.interrupted) choices_ = {};
    report();
    return std::move(result_);
  }

 private:
  // What a pass of many needs less of than a picture by itself: noise is averaged over them.
  static std::map<std::string, std::string> of_a_pass() { return {{"rows", "100"}, {"columns", "200"}}; }
  static constexpr std::size_t kLightsOfAPass = 4000;
  static constexpr int kSegmentsOfAPass = 4;

  using Segments = matrix::MethodContract::Segments;
  Segments of_method() const {
    const methods::MethodInfo& info = *task_.info;
    return info.segments_wanted ? info.segments_wanted(asked_.method.parameters) : info.contract.segments;
  }
  int pieces_of_eye_rays() const {
    if (of_method() == Segments::whole || of_method() == Segments::light_pieces) return 1;
    return asked_.time > 0 && of_method() == Segments::pieces ? kSegmentsOfAPass : kSegmentsPerRay;
  }
  bool in_groups() const {
    return of_method() == Segments::groups || of_method() == Segments::groups_and_tree;
  }

  // Rows, columns and sums, with random numbers of their own; the picture so far is the mean of all.
  void pass() {
    const std::uint64_t number = static_cast<std::uint64_t>(passes_);
    if (number > 0) {
      const Recipe first = make_recipe(asked_, task_.view);
      recipe_.seed = hash_ids(first.seed, Stage::passes, number);
      recipe_.light_seed = hash_ids(first.light_seed, Stage::passes, number);
    }
    rows();
    columns();
    sums();
    if (result_.interrupted && passes_ > 0) return;  // the passes before are whole
    const Timer timer;
    image::Image image = image_of(estimate_.sums);
    const float share = 1 / static_cast<float>(passes_ + 1);
    if (passes_ == 0)
      image_ = std::move(image);
    else
      for (std::size_t p = 0; p < image.pixels.size(); ++p)
        image_.pixels[p] = lerp(image_.pixels[p], image.pixels[p], share);
    ++passes_;
    seconds_["film"] += timer.seconds();
  }

  // Whether another pass is wanted: as many as a repeated run had, or as fit the time.
  bool again() {
    if (!(asked_.time > 0)) return false;
    if (!asked_.choices.empty()) {
      if (!wanted_passes_) wanted_passes_ = choices_.earlier("passes", 1 << 20);
      return passes_ < wanted_passes_.value_or(1);
    }
    const double passed = task_.timer.seconds(), each = (passed - task_.build_seconds) / passes_;
    return passed + each <= asked_.time;
  }

  void rows() {
    const Timer timer;
    transport::ReceiverSettings settings = receiver_settings(recipe_, task_.view);
    settings.eye_medium = task_.view.sensor.medium;
    settings.segments = pieces_of_eye_rays();
    rows_ = transport::trace_receivers(*task_.world, world::Camera(task_.view.sensor, task_.world->units()),
                                       settings, sinks_);
    seconds_["receivers"] += timer.seconds();
    if (!in_groups()) return;
    const Timer grouping;
    transport::EyeGroupSettings groups;
    groups.seed = recipe_.seed;
    transport::group_eye_segments(*task_.world, rows_.film, groups, rows_.segments, sinks_);
    seconds_["segments"] += grouping.seconds();
  }

  void columns() {
    Timer timer;
    transport::MediaLightSettings settings;
    settings.seed = recipe_.light_seed;
    settings.count =
        asked_.time > 0 && !asked_.lights.count ? kLightsOfAPass : lights_for(*task_.info, asked_);
    settings.max_depth = recipe_.max_depth;
    settings.eye_medium = task_.view.sensor.medium;
    settings.direct = recipe_.only != LightPart::indirect,
    settings.indirect = recipe_.only != LightPart::direct;
    settings.least_direct = kLeastDirect;
    asked_lights_ = settings.count;
    lights_ = transport::trace_lights_in_media(*task_.world, settings, sinks_);
    whole_rays_ = lights_.rays.size();
    seconds_["lights"] += timer.seconds();
    timer = {};
    if (of_method() == Segments::light_pieces) {
      lights_.rays =
          transport::cut_evenly(*task_.world, lights_.rays, kPiecesOfLightRays, recipe_.light_seed);
      seconds_["segments"] += timer.seconds();
    } else if (of_method() == Segments::groups_and_tree) {
      transport::RayTreeSettings tree;
      tree.seed = recipe_.light_seed;
      transport::build_ray_tree(*task_.world, tree, lights_.rays, sinks_);
      seconds_["segments"] += timer.seconds();
    }
    timer = {};
    matrix_ = std::make_unique<transport::MediaMatrix>(
        *task_.world, rows_, lights_, transport::MediaMatrixSettings{matrix_settings(recipe_), in_groups()});
    seconds_["matrix"] += timer.seconds();
  }

  image::Image image_of(std::span<const Rgb> sums) const {
    const FilmParts parts{
        .emission = asked_.view.only == LightPart::all, .traced_direct = false, .traced_indirect = false};
    std::vector<Rgb> values = sample_values(rows_, {}, sums.first(rows_.size()), parts);
    const transport::EyeSegments& segments = rows_.segments;
    for (std::size_t k = 0; k < segments.size(); ++k)
      values[segments.sample[k]] += segments.weight[k] * sums[rows_.size() + k];
    return develop(task_.view, rows_, values);
  }

  void sums() {
    methods::RunOptions run;
    run.seed = asked_.method.seed ? asked_.method.seed : asked_.seed;
    if (passes_ > 0) run.seed = hash_ids(run.seed, Stage::passes, static_cast<std::uint64_t>(passes_));
    run.target_error = asked_.method.target_error;
    run.sinks = sinks_;
    if (previews_ && passes_ == 0)
      run.on_estimate = [&](std::span<const Rgb> sums) {
        if (throttle_.due()) throttle_.show(to_picture(image_of(sums)));
      };
    const Timer timer;
    const matrix::MeteredMatrix metered(*matrix_);
    estimate_ = task_.method->run(metered, run);
    cost_ += metered.total();
    seconds_["method"] += timer.seconds();
    result_.interrupted = estimate_.interrupted;
    const ErrorAsked asked{asked_.method.target_error, asked_lights_, "--lights",
                           task_.info->error_parameters};
    if (const std::string advice = error_advice(asked, estimate_.trace.numbers); !advice.empty()) {
      sinks_.warn(advice);
      estimate_.trace.notes["error.advice"] = advice;
    }
  }

  void report() {
    Report& report = result_.report = begin_report(task_.info->name, asked_);
    report.numbers = estimate_.trace.numbers, report.notes = estimate_.trace.notes;
    report.notes["method.why"] = task_.why;
    if (report.numbers.contains("error.estimate")) report.notes["error.of"] = "the light that columns carry";
    report.numbers["receivers_per_pixel"] = recipe_.spp;
    report.numbers["passes"] = passes_;
    report.choices = choices_.made();
    report.numbers["clamp.removed_fraction"] = matrix::clamped_fraction(cost_);
    report.numbers["eye_segments"] = static_cast<double>(rows_.segments.size());
    report.numbers["ray_lights"] = static_cast<double>(whole_rays_);
    report.numbers["light_segments"] = static_cast<double>(lights_.rays.size());
    const double all =
        static_cast<double>(matrix_->rows()) * static_cast<double>(matrix_->columns()) * std::max(1, passes_);
    Report::Cost cost{cost_.entries, cost_.culled, cost_.rays, 0};
    if (const auto own = report.numbers.find("sampling_rate"); own != report.numbers.end())
      cost.sampling_rate = own->second, report.numbers.erase(own);
    else
      cost.sampling_rate = all > 0 ? static_cast<double>(cost.entries) / all : 0;
    report.cost = cost;
    report.sizes = Report::Sizes{
        static_cast<std::uint64_t>(task_.view.width) * static_cast<std::uint64_t>(task_.view.height),
        matrix_->rows(),
        matrix_->columns(),
        asked_lights_,
        lights_.points.direct_count,
        lights_.points.paths};
    report.memory = {peak_memory_bytes(), task_.world->info().memory_bytes, rows_.memory_bytes(),
                     lights_.points.memory_bytes() + lights_.rays.memory_bytes(), matrix_->memory_bytes()};
    seconds_["build"] = task_.build_seconds;
    seconds_["total"] = task_.timer.seconds();
    report.seconds = seconds_;
  }

  RenderTask task_;
  const RenderSettings& asked_;
  Sinks sinks_;
  PreviewThrottle throttle_;
  bool previews_;
  Recipe recipe_;
  transport::Receivers rows_;
  transport::LightsInMedia lights_;
  std::size_t asked_lights_ = 0, whole_rays_ = 0;
  std::unique_ptr<transport::MediaMatrix> matrix_;
  image::Image image_;
  int passes_ = 0;  // that image_ is the mean of
  std::optional<std::int64_t> wanted_passes_;
  methods::TimedChoices choices_;
  methods::Estimate estimate_;
  matrix::Cost cost_;
  std::map<std::string, double> seconds_;
  RenderResult result_;
};

}  // namespace

bool some_scatter(const scenedesc::SceneDesc& desc) {
  using Form = scenedesc::MediumDesc::Form;
  return std::ranges::any_of(desc.media, [](const scenedesc::MediumDesc& medium) {
    if (medium.form == Form::absorption_and_scattering) return !is_black(medium.scattering.value);
    return !is_black(medium.albedo.value) && !is_black(medium.extinction.value);
  });
}

void check_media(const methods::MethodInfo& method, const RenderSettings& settings) {
  const std::string there = " in a scene with participating media";
  methods::require_capabilities(method, transport::MediaMatrix::kCapabilities);
  if (!settings.layers.empty())
    throw InputError("there is no layer '" + settings.layers.front() + "'" + there,
                     "leave out --aov; 'reference' has direct, indirect and emission");
  if (settings.traced.compensate > 0)
    throw InputError("what clamping takes cannot be given back" + there, "leave out --compensate");
  if (settings.traced.local_paths > 0)
    throw InputError("no local paths are traced" + there, "leave out --local-paths");
  if (settings.lights.type == LightType::sphere)
    throw InputError("lights are points and rays" + there, "leave out --light-type");
}

const methods::MethodInfo& chosen_method_in_media(const RenderSettings& settings, std::string* why) {
  if (settings.method.name != "auto") return chosen_method(settings, why);
  if (why) *why = "the scene has participating media";
  return methods::find_method("row-column-sampling");
}

RenderResult run_in_media(RenderTask task, const RenderSettings& settings, const Sinks& sinks,
                          const PreviewCallback& on_preview) {
  return MediaRun(std::move(task), settings, sinks, on_preview).run();
}

}  // namespace lumirank::pipeline
