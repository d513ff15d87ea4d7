#include <cstdio>
#include <memory>
#include <sstream>

#include "commands.h"

namespace lumirank::cli {
namespace {

std::vector<std::string> split_list(const std::string& text) {
  std::vector<std::string> parts;
  std::stringstream stream(text);
  for (std::string part; std::getline(stream, part, ',');)
    if (!part.empty()) parts.push_back(part);
  return parts;
}

}  // namespace

void add_compare(CLI::App& app, Action& action) {
  struct Options {
    CommonOptions common;
    CompareSettings settings;
    std::string folder, methods = "instant-radiosity,power-sampling,row-column-sampling";
    std::vector<std::string> sweeps;
    std::vector<double> times;
  };
  auto options = std::make_shared<Options>();
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
  command
      ->add_option("--reference-time", options->settings.reference_time,
                   "seconds for --reference path (default 60)")
      ->check(CLI::PositiveNumber);
  command->add_option("--times", options->times, "time budgets in seconds, separated by commas: one run each")
      ->delimiter(',');
  command
      ->add_option("--sweep", options->sweeps,
                   "METHOD.KEY=V1,V2,… or METHOD.KEY1:KEY2=V1:W1,V2:W2,… or lights=… or spp=…; repeatable")
      ->allow_extra_args(false);
  command->add_option("--seeds", options->settings.seeds, "runs per setting, with different seeds")
      ->check(CLI::Range(1, 1000));
  command->add_flag("--singular-values", options->settings.singular_values,
                    "the singular values of a small matrix (2007, Figure 3)");
  command
      ->add_option("--equal", options->settings.equal,
                   "compare at equal time, rays or error: the runs nearest to the first method's are marked")
      ->check(CLI::IsMember({"time", "rays", "error"}));
  command->footer(
      "Examples:\n"
      "  lumirank compare room.xml -o out --times 1,2,4,8\n"
      "  lumirank compare room.xml -o out --methods row-column-sampling --reference brute-force \\\n"
      "      --sweep row-column-sampling.rows:columns=100:200,200:400,300:600 --seeds 5\n");
  command->callback([options, &action] {
    action = [options] {
      CompareSettings& settings = options->settings;
      settings.base = options->common.render_settings();
      settings.methods = split_list(options->methods);
      settings.times = options->times;
      for (const auto& text : options->sweeps) {
        const auto [key, values] = split_assignment(text, "--sweep");
        settings.sweeps.push_back({key, split_list(values)});
      }
      Console console(options->common.verbosity());
      const Scene scene = Scene::load(options->common.scene, options->common.load_options(), console.sinks());
      const bool whole = compare(scene, settings, options->folder, console.sinks());
      console.clear();
      if (!whole) {
        std::fprintf(stderr, "interrupted: the runs that were finished are in %s\n", options->folder.c_str());
        return 130;
      }
      if (!options->common.quiet) std::printf("wrote %s/index.html\n", options->folder.c_str());
      return 0;
    };
  });
}

}  // namespace lumirank::cli
