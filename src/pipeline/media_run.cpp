#include "pipeline/media_run.h"

#include <algorithm>
#include <optional>

#include "base/error.h"
#include "base/random.h"
#include "matrix/metered_matrix.h"
#include "pipeline/error_advice.h"
#include "pipeline/media_parts.h"
#include "pipeline/preview_throttle.h"
#include "pipeline/report.h"

namespace lumirank::pipeline {
namespace {

class MediaRun {
 public:
  MediaRun(RenderTask task, const RenderSettings& asked, const Sinks& sinks, const PreviewCallback& preview)
      : task_(std::move(task)),
        asked_(asked),
        sinks_(sinks),
        throttle_(preview),
        previews_(static_cast<bool>(preview)),
        recipe_(make_recipe(asked, task_.view)) {
    // Noise of rows goes away over passes as well.
    if (asked.time > 0 && !asked.view.spp) recipe_.spp = 1;
    if (!asked.choices.empty()) choices_ = methods::TimedChoices(asked.choices);
    plan_ = {segments_for(*task_.info, asked.method.parameters),
             asked.time > 0 && !asked.lights.count ? kLightsOfAPass : lights_for(*task_.info, asked),
             asked.time > 0};
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

  // Rows, columns and sums, with random numbers of their own; the picture so far is the mean of all.
  void pass() {
    const std::uint64_t number = static_cast<std::uint64_t>(passes_);
    if (number > 0) {
      const Recipe first = make_recipe(asked_, task_.view);
      recipe_.seed = hash_ids(first.seed, Stage::passes, number);
      recipe_.light_seed = hash_ids(first.light_seed, Stage::passes, number);
    }
    prepared_.reset();  // before the next takes its memory
    prepared_ = prepare_in_media(task_.world, task_.view, recipe_, plan_, sinks_);
    for (const auto& [stage, seconds] : prepared_->seconds) seconds_[stage] += seconds;
    sums();
    if (result_.interrupted && passes_ > 0) return;  // the passes before are whole
    const Timer timer;
    image::Image image = picture_of(*prepared_, estimate_.sums);
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

  void sums() {
    methods::RunOptions run;
    run.seed = asked_.method.seed ? asked_.method.seed : asked_.seed;
    if (passes_ > 0) run.seed = hash_ids(run.seed, Stage::passes, static_cast<std::uint64_t>(passes_));
    run.target_error = asked_.method.target_error;
    run.sinks = sinks_;
    if (previews_ && passes_ == 0)
      run.on_estimate = [&](std::span<const Rgb> sums) {
        if (throttle_.due()) throttle_.show(to_picture(picture_of(*prepared_, sums)));
      };
    const Timer timer;
    const matrix::MeteredMatrix metered(*prepared_->matrix);
    estimate_ = task_.method->run(metered, run);
    cost_ += metered.total();
    seconds_["method"] += timer.seconds();
    result_.interrupted = estimate_.interrupted;
    const ErrorAsked asked{asked_.method.target_error, plan_.lights, "--lights",
                           task_.info->error_parameters};
    if (const std::string advice = error_advice(asked, estimate_.trace.numbers); !advice.empty()) {
      sinks_.warn(advice);
      estimate_.trace.notes["error.advice"] = advice;
    }
  }

  void report() {
    const transport::Receivers& rows = prepared_->rows;
    const transport::LightsInMedia& lights = prepared_->lights;
    const transport::MediaMatrix& sampled = *prepared_->matrix;
    Report& report = result_.report = begin_report(task_.info->name, asked_);
    report.numbers = estimate_.trace.numbers, report.notes = estimate_.trace.notes;
    report.notes["method.why"] = task_.why;
    if (report.numbers.contains("error.estimate")) report.notes["error.of"] = "the light that columns carry";
    report.numbers["receivers_per_pixel"] = recipe_.spp;
    report.numbers["passes"] = passes_;
    report.choices = choices_.made();
    report.numbers["clamp.removed_fraction"] = matrix::clamped_fraction(cost_);
    report.numbers["eye_segments"] = static_cast<double>(rows.segments.size());
    report.numbers["ray_lights"] = static_cast<double>(prepared_->whole_rays);
    report.numbers["light_segments"] = static_cast<double>(lights.rays.size());
    const double all =
        static_cast<double>(sampled.rows()) * static_cast<double>(sampled.columns()) * std::max(1, passes_);
    Report::Cost cost{cost_.entries, cost_.culled, cost_.rays, 0};
    if (const auto own = report.numbers.find("sampling_rate"); own != report.numbers.end())
      cost.sampling_rate = own->second, report.numbers.erase(own);
    else
      cost.sampling_rate = all > 0 ? static_cast<double>(cost.entries) / all : 0;
    report.cost = cost;
    report.sizes = Report::Sizes{
        static_cast<std::uint64_t>(task_.view.width) * static_cast<std::uint64_t>(task_.view.height),
        sampled.rows(),
        sampled.columns(),
        plan_.lights,
        lights.points.direct_count,
        lights.points.paths};
    report.memory = {peak_memory_bytes(), task_.world->info().memory_bytes, rows.memory_bytes(),
                     lights.points.memory_bytes() + lights.rays.memory_bytes(), sampled.memory_bytes()};
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
  MediaPlan plan_;
  std::shared_ptr<const PreparedMedia> prepared_;
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
  methods::require_capabilities(method, transport::MediaMatrix::kCapabilities);
  check_media(settings);
}

void check_media(const RenderSettings& settings) {
  const std::string there = " in a scene with participating media";
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
