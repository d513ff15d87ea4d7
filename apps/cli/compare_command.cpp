#include <charconv>
#include <cstdio>
#include <memory>

#include "commands.h"
#include "values.h"

namespace lumirank::cli {
namespace {

struct CompareOptions {
  CommonOptions common;
  CompareSettings settings;
  std::string folder, methods = "instant-radiosity,power-sampling,row-column-sampling";
  std::vector<std::string> sweeps;
};

std::vector<std::string> split(const std::string& text, char separator) {
  std::vector<std::string> parts;
  std::size_t begin = 0;
  while (true) {
    const std::size_t end = text.find(separator, begin);
    parts.push_back(text.substr(begin, end == std::string::npos ? end : end - begin));
    if (end == std::string::npos) return parts;
    begin = end + 1;
  }
}

// "METHOD.KEY1:KEY2=V1:W1,V2:W2", "lights=…", "spp=…".
ComparisonSweep read_sweep(const std::string& text) {
  const auto [key, values] = split_assignment(text, "--sweep");
  if (values.empty()) throw InputError("the sweep of '" + key + "' has no values", "give KEY=V1,V2");
  const std::size_t dot = key.find('.');
  ComparisonSweep sweep;
  if (dot != std::string::npos) sweep.method = key.substr(0, dot);
  sweep.keys = split(dot == std::string::npos ? key : key.substr(dot + 1), ':');
  for (const std::string& value : read_list("--sweep", values)) sweep.values.push_back(split(value, ':'));
  return sweep;
}

// "path", "brute-force", "brute-force:N", or else a file.
void read_reference(const std::string& text, ComparisonReference& reference) {
  using Kind = ComparisonReference::Kind;
  constexpr std::string_view kReceivers = "brute-force:";
  if (text == "path" || text == "brute-force") {
    reference.kind = text == "path" ? Kind::path : Kind::brute_force;
  } else if (text.starts_with(kReceivers)) {
    const std::string number = text.substr(kReceivers.size());
    const auto [end, status] =
        std::from_chars(number.data(), number.data() + number.size(), reference.receivers);
    if (status != std::errc{} || end != number.data() + number.size())
      throw InputError("'" + text + "' is not a reference", "write brute-force:N with N at least 64");
    reference.kind = Kind::receivers;
  } else {
    reference.kind = Kind::file, reference.file = text;
  }
}

EqualCost read_equal(const std::string& text) {
  return text == "time" ? EqualCost::time : text == "rays" ? EqualCost::rays : EqualCost::error;
}

int run_compare(CompareOptions& options, Streams streams) {
  CompareSettings& settings = options.settings;
  settings.base = options.common.render_settings();
  settings.methods = read_list("--methods", options.methods);
  for (const std::string& text : options.sweeps) settings.sweeps.push_back(read_sweep(text));
  Console console(options.common.verbosity(), streams.err);
  const Scene scene = Scene::load(options.common.scene, options.common.load_options(), console.sinks());
  const Comparison comparison = compare(scene, settings, options.folder, console.sinks());
  console.clear();
  if (comparison.interrupted) {
    std::fprintf(streams.err, "interrupted: the runs that were finished are in %s\n", options.folder.c_str());
    return 130;
  }
  if (!options.common.quiet) std::fprintf(streams.out, "wrote %s/index.html\n", options.folder.c_str());
  return 0;
}

}  // namespace

void add_compare(CLI::App& app, Action& action) {
  auto options = std::make_shared<CompareOptions>();
  CLI::App* command =
      app.add_subcommand("compare", "several methods against one reference: tables, plots, one page");
  add_scene_options(*command, options->common);
  add_moment_options(*command, options->common);
  command
      ->add_option("-o,--output", options->folder,
                   "folder for results.json, results.csv, images and index.html")
      ->required();
  add_setting_options(*command, options->common, {});
  // What a comparison sets by itself, or has no use for.
  for (const char* other : {"--time", "--method", "--aov", "--compensate", "--shutter", "--shutter-samples"})
    command->remove_option(command->get_option(other));
  command->add_option("--methods", options->methods, "names, separated by commas");
  command->add_option_function<std::string>(
      "--reference",
      [options](const std::string& text) { read_reference(text, options->settings.reference); },
      "FILE.exr, path, brute-force (all columns) or brute-force:N (all columns at N receivers)");
  add_number(*command, "--reference-time", options->settings.reference.seconds, {0, 1e7, true, "seconds"},
             "seconds for --reference path (default 60)");
  command->add_option_function<std::string>(
      "--times",
      [options](const std::string& text) {
        for (const auto& time : read_list("--times", text))
          options->settings.times.push_back(read_number("--times", time, {0, 1e7, true, "seconds"}));
      },
      "time budgets in seconds, separated by commas: one run each");
  command
      ->add_option("--sweep", options->sweeps,
                   "METHOD.KEY=V1,V2,… or METHOD.KEY1:KEY2=V1:W1,V2:W2,… or lights=… or spp=…; repeatable")
      ->allow_extra_args(false);
  add_count(*command, "--seeds", options->settings.seeds, 1, 1000, "runs per setting, with different seeds");
  command->add_flag("--singular-values", options->settings.singular_values,
                    "the singular values of a small matrix (2007, Figure 3)");
  add_choice(
      *command, "--equal", [options](const std::string& what) { options->settings.equal = read_equal(what); },
      {"time", "rays", "error"},
      "compare at equal time, rays or error: the runs nearest to the first method's are marked");
  command->footer(
      "Examples:\n"
      "  lumirank compare room.xml -o out --times 1,2,4,8\n"
      "  lumirank compare room.xml -o out --methods row-column-sampling --reference brute-force \\\n"
      "      --sweep row-column-sampling.rows:columns=100:200,200:400,300:600 --seeds 5\n");
  command->callback(
      [options, &action] { action = [options](Streams streams) { return run_compare(*options, streams); }; });
}

}  // namespace lumirank::cli
