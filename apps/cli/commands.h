// One function per sub-command: adds its options to the parser and sets what runs when it was chosen.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "console.h"
#include "lumirank/compare.h"
#include "lumirank/lumirank.h"
#include "run.h"

namespace lumirank::cli {

// Returns the exit code.
using Action = std::function<int(Streams)>;

void add_render(CLI::App& app, Action& action);
void add_reference(CLI::App& app, Action& action);
void add_animate(CLI::App& app, Action& action);
void add_compare(CLI::App& app, Action& action);
void add_error(CLI::App& app, Action& action);
void add_convert(CLI::App& app, Action& action);
void add_info(CLI::App& app, Action& action);
void add_methods(CLI::App& app, Action& action);

// What several commands share, collected as text and turned into settings when the command runs.
struct CommonOptions {
  std::string scene, environment;
  std::vector<std::string> defines;
  bool strict = false, allow_missing = false, quiet = false, verbose = false;
  std::string at, clip;  // "": as the file stands; the first clip
  int frame = -1;        // -1: not given
  double fps = 24;
  std::map<std::string, std::string> fields;  // render settings that were given, by key
  std::vector<std::string> method_settings;   // KEY=VALUE
  std::string replay;

  LoadOptions load_options() const;
  RenderSettings render_settings() const;
  Verbosity verbosity() const;
};

// Scene, --define, --environment, --strict, --quiet, --verbose.
void add_scene_options(CLI::App& command, CommonOptions& common);
// --at, --frame, --fps, --clip: which moment of a scene that moves.
void add_moment_options(CLI::App& command, CommonOptions& common);
// An option for each of the named render settings ("" keys: all of them), --set and --replay.
void add_setting_options(CLI::App& command, CommonOptions& common, const std::vector<std::string>& keys);

struct OutputOptions {
  std::vector<std::string> images;
  std::string report, preview;
  DisplaySettings display;
};
void add_output_options(CLI::App& command, OutputOptions& outputs);
// Throws InputError before any work is done if something could not be written.
void check_outputs(const OutputOptions& outputs, const RenderSettings& settings);
// The same once the scene is known: none of its files, nor any other input, is written over.
void check_inputs(const OutputOptions& outputs, const RenderSettings& settings, const CommonOptions& common,
                  const Scene& scene);
PreviewCallback preview_writer(const OutputOptions& outputs);
// Writes images and report, all or none, and says so; exit code 130 if the run was interrupted.
int write_outputs(const OutputOptions& outputs, const RenderResult& result, Console& console, bool quiet,
                  Streams streams);

std::pair<std::string, std::string> split_assignment(const std::string& text, const char* option);

}  // namespace lumirank::cli
