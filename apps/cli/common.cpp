// What several commands share: the scene and the render settings.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "commands.h"
#include "values.h"

namespace lumirank::cli {
namespace {

// In the settings themselves an empty text stands for the default; on the command line it is a variable of a
// script that was not set.
void require_text(const std::string& key, const std::string& value) {
  if (value.empty()) throw InputError("--" + key + " is empty", "leave it out for its default");
}

}  // namespace

std::pair<std::string, std::string> split_assignment(const std::string& text, const char* option) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos || equals == 0)
    throw InputError("'" + text + "' is not KEY=VALUE", std::string("write it as ") + option + " KEY=VALUE");
  return {text.substr(0, equals), text.substr(equals + 1)};
}

LoadOptions CommonOptions::load_options() const {
  LoadOptions options;
  options.strict = strict;
  options.environment = environment;
  options.allow_missing = allow_missing;
  options.clip = clip;
  options.frames_per_second = fps;
  if (!at.empty() && frame >= 0) throw InputError("--at and --frame both say when", "give one of them");
  if (!at.empty()) options.time = read_number("--at", at, {-1e7, 1e7, false, "seconds"});
  if (frame >= 0) options.time = frame / fps;
  for (const auto& text : defines)
    options.defines.insert_or_assign(split_assignment(text, "--define").first,
                                     split_assignment(text, "--define").second);
  return options;
}

RenderSettings CommonOptions::render_settings() const {
  RenderSettings settings;
  if (!replay.empty()) {
    std::ifstream in(replay, std::ios::binary);
    std::ostringstream text;
    text << in.rdbuf();
    if (std::error_code error; !in || std::filesystem::is_directory(replay, error))
      throw InputError({replay, 0}, "cannot be read", "give the report of an earlier render");
    settings = render_settings_from_report(text.str());
  }
  // A budget beside it is a wish for another picture.
  if (fields.contains("time")) settings.choices.clear();
  for (const auto& [key, value] : fields) set_field(settings, key, value);
  for (const auto& text : method_settings) {
    const auto [key, value] = split_assignment(text, "--set");
    settings.method.parameters[key] = value;
  }
  return settings;
}

Verbosity CommonOptions::verbosity() const {
  return quiet ? Verbosity::quiet : (verbose ? Verbosity::verbose : Verbosity::normal);
}

void add_scene_options(CLI::App& command, CommonOptions& common) {
  command.add_option("scene", common.scene, "scene file (Mitsuba XML 0.6 or 3, pbrt-v4, glTF 2.0)")
      ->required();
  command.add_option("--define", common.defines, "NAME=VALUE: a value for $NAME in the scene; repeatable")
      ->allow_extra_args(false);
  command.add_option("--environment", common.environment,
                     "FILE.exr (or .hdr): light from all around, in place of the scene's own environment");
  command.add_flag("--allow-missing", common.allow_missing,
                   "files that do not exist: a warning and a stand-in instead of an error");
  command.add_flag("--strict", common.strict, "warnings about the scene are errors");
  auto* quiet = command.add_flag("--quiet", common.quiet, "print nothing but errors");
  command.add_flag("--verbose", common.verbose, "say more")->excludes(quiet);
}

void add_moment_options(CLI::App& command, CommonOptions& common) {
  command.add_option("--at", common.at,
                     "SECONDS: the moment of a scene that moves (default: as the file stands)");
  add_count(command, "--frame", common.frame, 0, 10'000'000, "the moment by its number, from 0 at second 0");
  add_number(command, "--fps", common.fps, {0, 1000, true, "frames per second"},
             "frames per second of --frame and --shutter (default 24)");
  command.add_option("--clip", common.clip,
                     "glTF: the animation to show, by name or number; '*': all (default: the first)");
}

void add_setting_options(CLI::App& command, CommonOptions& common, const std::vector<std::string>& keys) {
  for (const Field& field : render_fields()) {
    if (!keys.empty() && std::find(keys.begin(), keys.end(), field.key) == keys.end()) continue;
    std::string help = field.help;
    if (!field.range.empty()) help += " [" + field.range + "]";
    if (!field.default_text.empty()) help += " (default " + field.default_text + ")";
    const std::string key = field.key;
    if (field.type == "list") {
      command
          .add_option_function<std::vector<std::string>>(
              "--" + key,
              [&common, key](const std::vector<std::string>& values) {
                for (const auto& value : values) require_text(key, value);
                std::string joined;
                for (const auto& v : values) joined += (joined.empty() ? "" : ",") + v;
                common.fields[key] = joined;
              },
              help)
          ->allow_extra_args(false);
    } else {
      command.add_option_function<std::string>(
          "--" + key,
          [&common, key](const std::string& value) {
            require_text(key, value);
            common.fields[key] = value;
          },
          help);
    }
  }
  if (keys.empty()) {
    command.add_option("--set", common.method_settings, "KEY=VALUE: a parameter of the method; repeatable")
        ->allow_extra_args(false);
    command.add_option(
        "--replay", common.replay,
        "REPORT.json: the same settings again, and what the clock decided under --time; other options "
        "win over it");
  }
}

}  // namespace lumirank::cli
