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

int run_compare(CompareOptions& options, Streams streams) {
  CompareSettings& settings = options.settings;
  settings.base = options.common.render_settings();
  settings.methods = read_list("--methods", options.methods);
  for (const auto& text : options.sweeps) {
    const auto [key, values] = split_assignment(text, "--sweep");
    if (values.empty()) throw InputError("the sweep of '" + key + "' has no values", "give KEY=V1,V2");
    settings.sweeps.push_back({key, read_list("--sweep", values)});
  }
  Console console(options.common.verbosity(), streams.err);
  const Scene scene = Scene::load(options.common.scene, options.common.load_options(), console.sinks());
  const bool whole = compare(scene, settings, options.folder, console.sinks());
  console.clear();
  if (!whole) {
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
  command
      ->add_option("-o,--output", options->folder,
                   "folder for results.json, results.csv, images and index.html")
      ->required();
  add_setting_options(*command, options->common, {});
  // What a comparison sets by itself, or has no use for.
  for (const char* other : {"--time", "--method", "--aov", "--compensate"})
    command->remove_option(command->get_option(other));
  command->add_option("--methods", options->methods, "names, separated by commas");
  command->add_option(
      "--reference", options->settings.reference,
      "FILE.exr, path, brute-force (all columns) or brute-force:N (all columns at N receivers)");
  add_number(*command, "--reference-time", options->settings.reference_time, {0, 1e7, true, "seconds"},
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
      *command, "--equal", [options](const std::string& what) { options->settings.equal = what; },
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
