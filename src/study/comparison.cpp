// Runs the plan of a comparison on one prepared scene, and writes every result as soon as it exists.
#include "study/comparison.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <set>
#include <span>
#include <utility>

#include "base/error.h"
#include "base/parallel.h"
#include "base/random.h"
#include "base/timer.h"
#include "base/version.h"
#include "image/atomic_file.h"
#include "image/file_identity.h"
#include "image/image_io.h"
#include "image/metrics.h"
#include "matrix/metered_matrix.h"
#include "pages/page.h"
#include "pipeline/develop.h"
#include "pipeline/error_advice.h"
#include "pipeline/media_parts.h"
#include "pipeline/media_run.h"
#include "pipeline/memory.h"
#include "pipeline/noise_metric.h"
#include "pipeline/pass_run.h"
#include "pipeline/prepared.h"
#include "pipeline/sound_pixels.h"
#include "study/equal_cost.h"
#include "study/run_plan.h"
#include "study/singular_values.h"
#include "study/study_reference.h"
#include "study/subject.h"

namespace lumirank::study {
namespace {

using namespace pipeline;
using namespace pages;
namespace fs = std::filesystem;

class Study {
 public:
  Study(const StudiedScene& scene, const CompareSettings& settings, const std::string& folder,
        const Sinks& sinks)
      : settings_(settings),
        folder_(folder),
        sinks_(sinks),
        plan_(plan_runs(settings)),
        in_media_(some_scatter(scene.desc)),
        world_(std::make_shared<world::World>(
            world::World::build(scene.desc, {.strict = scene.strict, .media = in_media_}, warnings_, sinks))),
        view_(make_view(scene.desc, settings.base.view)),
        reference_(settings, view_),
        subjects_(settings, world_, view_, in_media_) {
    const fs::path file = fs::absolute(scene.desc.source_file);
    results_.scene = (file.parent_path().filename() / file.filename()).string();
    results_.version = program_version();
    results_.width = view_.width, results_.height = view_.height;
    for (const PlannedRun& run : plan_)
      if (const methods::MethodInfo& info = methods::find_method(run.method); in_media_)
        check_media(info, settings.base);
      else
        methods::require_capabilities(info, transport::SceneMatrix::kCapabilities);
    if (in_passes()) require_sound_passes();
    require_memory_of_runs();
    require_outputs(scene.files);
  }

  Comparison run() {
    check_metric(settings_.base.method, in_passes());
    // Passes have rows and columns of their own.
    if (!in_passes()) prepare_as_asked();
    // Not before: a comparison that is refused leaves nothing behind.
    std::error_code code;
    const bool made = fs::create_directories(folder_, code);
    if (code)
      throw InputError({folder_, 0}, "the folder cannot be made: " + code.message(), "choose another place");
    warn_of_errors();
    try {
      run_all();
    } catch (const InputError& error) {  // a full disk
      if (written_) throw InputError(error.what(), "what was finished before is in " + folder_);
      if (made) fs::remove(folder_, code);
      throw;
    }
    return std::move(results_);
  }

 private:
  void run_all() {
    try {
      make_reference();
      for (std::size_t k = 0; k < plan_.size(); ++k) {
        sinks_.report("compare", static_cast<double>(k) / static_cast<double>(plan_.size()));
        if (!run_one(plan_[k])) return finish(false);
        write_results_json(folder_, results_);
      }
      if (settings_.singular_values) find_singular_values();
    } catch (const Cancelled&) {
      return finish(false);
    }
    return finish(true);
  }

  // Whether runs are whole pictures in passes, as a render has them, instead of estimates of one matrix.
  bool in_passes() const { return settings_.base.passes > 0 || settings_.base.denoise == Denoise::on; }

  void require_sound_passes() const {
    if (in_media_)
      throw InputError("scenes with participating media are not rendered in passes",
                       "leave out --passes and --denoise");
    if (reference_.is_of_columns())
      throw InputError(
          "passes have lights of their own, which all columns of one matrix are no reference for",
          "give --reference path or a file, or leave out --passes and --denoise");
    if (settings_.base.view.spp || sweeps("spp"))
      throw InputError("passes have one receiver per pixel each", "give --passes instead of spp");
    check_passes(settings_.base);
  }

  bool sweeps(const std::string& key) const {
    for (const ComparisonSweep& sweep : settings_.sweeps)
      if (sweep.method.empty() && std::ranges::count(sweep.keys, key) > 0) return true;
    return false;
  }

  // Of methods that --error does not steer, once each.
  void warn_of_errors() const {
    if (in_passes()) return;
    std::set<std::string> warned;
    for (const PlannedRun& run : plan_)
      if (const auto& info = methods::find_method(run.method); warned.insert(run.method).second)
        if (const std::string text = error_not_aimed_at(info, settings_.base.method.target_error);
            !text.empty())
          sinks_.warn(text);
  }

  std::string path(const std::string& name) const { return (fs::path(folder_) / name).string(); }

  // Runs against all columns sample the very matrix that these were summed of.
  void prepare(SubjectWanted wanted, const PlannedRun* run = nullptr) {
    if (run && !reference_.is_of_columns())
      wanted.segments = segments_for(methods::find_method(run->method), run->method_settings);
    subject_ = subjects_.make(wanted, sinks_);
  }
  void prepare_as_asked() {
    prepare({settings_.base.lights.count_or_default(), settings_.base.view.spp_or_default(),
             settings_.base.seed});
  }

  void save(const std::string& name, const image::Image& image) const {
    check_pixels(image);
    image::LayeredImage layers;
    layers.color = image;
    image::write_image(path(name), layers);
  }

  // The reference's file may be the one that an earlier comparison left here.
  bool reference_is_kept() const {
    return reference_.is_file() &&
           image::file_identity(settings_.reference.file) == image::file_identity(path("reference.exr"));
  }

  static std::string stem_of(std::size_t run) { return "run_" + std::to_string(run); }

  // Before any work: none of them is a file that is read, or one that cannot be written.
  void require_outputs(std::vector<std::string> inputs) const {
    std::vector<std::string> outputs = {path("results.json"), path("results.csv"), path("index.html")};
    if (reference_.is_picture()) {
      outputs.push_back(path("reference.png"));
      if (!reference_is_kept()) outputs.push_back(path("reference.exr"));
    }
    for (std::size_t k = 0; k < plan_.size(); ++k)
      for (const char* ending : {".png", "_error.png"}) outputs.push_back(path(stem_of(k) + ending));
    if (reference_.is_file()) inputs.push_back(settings_.reference.file);
    image::require_distinct(outputs, inputs);
    if (std::error_code error; !fs::is_directory(folder_, error)) {
      fs::path there = fs::absolute(folder_, error).lexically_normal();
      while (!fs::exists(there, error) && there.has_relative_path()) there = there.parent_path();
      if (!fs::is_directory(there, error))
        throw InputError({folder_, 0}, "the folder cannot be made: " + there.string() + " is not a folder",
                         "choose another place");
      return;
    }
    for (const std::string& output : outputs) const image::AtomicFile probe(output);
  }

  // The largest of the runs, as far as it is known before them.
  void require_memory_of_runs() const {
    double max_bytes = 0;
    for (const PlannedRun& run : plan_) {
      const double samples = static_cast<double>(view_.width) * static_cast<double>(view_.height) * run.spp;
      require_countable(samples);
      max_bytes = std::max(max_bytes, memory_of_picture(samples, static_cast<double>(run.lights), false));
    }
    require_memory(max_bytes, kSmallerPicture);
  }

  void make_reference() {
    reference_.make(*world_, subject_.get(), sinks_, results_);
    if (!reference_.is_picture()) return;
    results_.reference_image = "reference.png";
    image::FilesTogether together;
    save("reference.png", reference_.picture());
    if (!reference_is_kept()) save("reference.exr", reference_.picture());
    together.commit();
    written_ = true;
  }

  // Methods without a clock of their own get as many columns as fit into the budget, by the pace of a few.
  void fit_to_time(PlannedRun& run, std::map<std::string, std::string>& method_settings) {
    const bool by_lights = run.method == "instant-radiosity" || run.method == "virtual-ray-lights";
    if (run.time <= 0 || (!by_lights && run.method != "power-sampling")) return;
    if (columns_per_second_ <= 0) {
      std::vector<matrix::ScaledColumn> few;
      for (std::uint64_t k = 0; k < 48; ++k)
        few.push_back(
            {static_cast<matrix::Index>(
                 Rng(settings_.base.seed, Stage::benchmark, k).next_below(subject_->matrix().columns())),
             Rgb(1)});
      std::vector<Rgb> sums(subject_->matrix().rows());
      const Timer timer;
      subject_->matrix().accumulate(few, sums, sinks_);
      columns_per_second_ = 48 / timer.seconds();
    }
    const auto fitting = static_cast<std::size_t>(std::max(1.0, columns_per_second_ * run.time));
    method_settings[by_lights ? "lights" : "columns"] = std::to_string(fitting);
  }

  static ComparisonRun result_of(const PlannedRun& run) {
    ComparisonRun result;
    result.method = run.method, result.label = run.label, result.series = run.series, result.seed = run.seed;
    result.settings = run.method_settings;
    return result;
  }

  bool run_in_passes(const PlannedRun& run) {
    const methods::MethodInfo& info = methods::find_method(run.method);
    RenderSettings settings = settings_.base;
    settings.method.name = run.method, settings.method.parameters = run.method_settings;
    settings.seed = run.seed, settings.time = run.time;
    // Passes have numbers of lights that suit them, unless it is told.
    if (sweeps("lights")) settings.lights.count = run.lights;
    if (const std::size_t wanted = info.lights_wanted ? info.lights_wanted(run.method_settings) : 0;
        wanted > 0)
      settings.lights.count = wanted;
    settings.traced.rest = RestOfPaths::skip;
    if (settings.denoise != Denoise::on) settings.denoise = Denoise::off;
    RenderTask task;
    task.world = world_, task.view = view_;
    task.info = &info, task.method = info.make(run.method_settings), task.why = "compared";
    Sinks quiet = sinks_;
    quiet.progress = {};
    const RenderResult rendered = pipeline::run_in_passes(std::move(task), settings, quiet, {});
    if (rendered.interrupted) return false;

    const Report& report = rendered.report;
    ComparisonRun result = result_of(run);
    result.seconds = report.seconds.at("total");
    if (report.cost) {
      result.rays = static_cast<double>(report.cost->shadow_rays);
      result.entries = static_cast<double>(report.cost->entries);
      result.sampling_rate = report.cost->sampling_rate;
    }
    result.numbers = report.numbers;
    result.phases = report.seconds;
    if (report.sizes) result.settings["lights"] = std::to_string(report.sizes->lights);
    keep(std::move(result), image_of(rendered.picture));
    return true;
  }

  bool run_one(PlannedRun run) {
    if (in_passes()) return run_in_passes(run);
    const methods::MethodInfo& info = methods::find_method(run.method);
    // Otherwise all runs sample the reference's own matrix.
    const bool new_lights = !reference_.is_of_columns();
    prepare({run.lights, run.spp, new_lights ? run.seed : settings_.base.seed}, &run);
    auto method_settings = run.method_settings;
    fit_to_time(run, method_settings);
    if (info.lights_wanted)
      if (const std::size_t wanted = info.lights_wanted(method_settings); wanted > 0)
        prepare({wanted, run.spp, run.seed}, &run);

    methods::RunOptions options;
    options.seed = run.seed;
    options.time_seconds = run.time;
    options.target_error = settings_.base.method.target_error;
    options.sinks = sinks_;
    options.sinks.progress = {};
    const matrix::MeteredMatrix metered(subject_->matrix());
    const Timer timer;
    const methods::Estimate estimate = info.make(method_settings)->run(metered, options);
    if (estimate.interrupted) return false;

    ComparisonRun result = result_of(run);
    result.seconds = timer.seconds();
    for (const auto& [stage, seconds] : subject_->seconds()) result.setup_seconds += seconds;
    result.settings = method_settings;
    result.settings["lights"] = std::to_string(subject_->lights());
    result.settings["spp"] = std::to_string(run.spp);
    const matrix::Cost cost = metered.total();
    result.rays = static_cast<double>(cost.rays);
    result.entries = static_cast<double>(cost.entries);
    result.sampling_rate = result.entries / (static_cast<double>(subject_->matrix().rows()) *
                                             static_cast<double>(subject_->matrix().columns()));
    result.numbers = estimate.trace.numbers;
    for (const auto& [key, value] : estimate.trace.numbers)
      if (key.starts_with("seconds."))
        result.phases[key.substr(8)] = value;
      else if (key == "rows" || key == "columns")
        result.settings[key] = std::to_string(static_cast<long long>(value));

    keep(std::move(result), subject_->picture(estimate.sums), estimate.sums);
    return true;
  }

  // `sums` of rows, where errors are those at some of them.
  void keep(ComparisonRun result, const image::Image& image, std::span<const Rgb> sums = {}) {
    const std::string stem = stem_of(results_.runs.size());
    image::FilesTogether together;
    result.image_file = stem + ".png";
    save(result.image_file, image);
    if (const SampledTruth* sampled_truth = reference_.sampled()) {
      const auto sampled = sampled_truth->error_of(sums);
      result.error = sampled.metrics;
      result.settings["relative_l2 ±95 %"] = std::to_string(sampled.l2_half_width);
    } else {
      result.error = image::compare(image, reference_.picture());
      result.error_image_file = stem + "_error.png";
      save(result.error_image_file, image::false_color_error(image, reference_.picture()));
    }
    together.commit();
    written_ = true;
    results_.runs.push_back(std::move(result));
  }

  void find_singular_values() {
    prepare_as_asked();
    results_.singular_values = singular_values_of(subject_->matrix(), settings_.base.seed);
  }

  void finish(bool whole) {
    results_.interrupted = !whole;
    if (!whole)
      results_.notes.push_back("Interrupted: " + std::to_string(results_.runs.size()) + " of " +
                               std::to_string(plan_.size()) + " runs were finished.");
    note_equal_cost(settings_, results_);
    write_results_json(folder_, results_);
    write_results_csv(folder_, results_);
    write_comparison_page(folder_, results_);
  }

  const CompareSettings& settings_;
  std::string folder_;
  Sinks sinks_;
  std::vector<PlannedRun> plan_;
  std::vector<scenedesc::Warning> warnings_;
  bool in_media_;
  SharedWorld world_;
  View view_;
  StudyReference reference_;
  SubjectMaker subjects_;
  SharedSubject subject_;
  double columns_per_second_ = 0;
  bool written_ = false;  // something is in the folder
  Comparison results_;
};

}  // namespace

Comparison compare(const StudiedScene& scene, const CompareSettings& settings, const std::string& folder,
                   const Sinks& sinks) {
  if (settings.base.traced.compensate > 0)
    throw InputError("a comparison cannot compensate for clamping", "leave out 'compensate'");
  Comparison result;
  within_memory(kSmallerPicture, [&] {
    with_threads(settings.base.threads, [&] { result = Study(scene, settings, folder, sinks).run(); });
  });
  return result;
}

}  // namespace lumirank::study
