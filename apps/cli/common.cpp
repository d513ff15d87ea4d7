#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "commands.h"

namespace lumirank::cli {

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
    if (!in) throw InputError({replay, 0}, "cannot be read", "give the report of an earlier render");
    settings = render_settings_from_report(text.str());
  }
  // A budget beside it is a wish for another picture.
  if (fields.contains("time")) settings.choices.clear();
  for (const auto& [key, value] : fields) set_field(settings, key, value);
  for (const auto& text : method_settings) {
    const auto [key, value] = split_assignment(text, "--set");
    settings.method_settings[key] = value;
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
                std::string joined;
                for (const auto& v : values) joined += (joined.empty() ? "" : ",") + v;
                common.fields[key] = joined;
              },
              help)
          ->allow_extra_args(false);
    } else {
      command.add_option_function<std::string>(
          "--" + key, [&common, key](const std::string& value) { common.fields[key] = value; }, help);
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

namespace {

void read_range(const std::string& text, DisplaySettings& display) {
  std::istringstream in(text);
  char colon = 0;
  if (!(in >> display.lux_low >> colon >> display.lux_high) || colon != ':' || in.peek() != EOF ||
      !(display.lux_low >= 0 && display.lux_high > display.lux_low && display.lux_high < 1e12))
    throw InputError("'" + text + "' is not a range of lux", "write it as LOW:HIGH with 0 ≤ LOW < HIGH");
}

// Beside each PNG picture: room.png → room.illuminance.png.
std::vector<std::string> illuminance_files(const OutputOptions& outputs) {
  std::vector<std::string> files;
  for (const auto& image : outputs.images) {
    std::filesystem::path file(image);
    if (file.extension() == ".png") files.push_back(file.replace_extension(".illuminance.png").string());
  }
  return files;
}

}  // namespace

void add_output_options(CLI::App& command, OutputOptions& outputs) {
  command.add_option("-o,--output", outputs.images, "image file: .exr, .png or .pfm; repeatable")
      ->required()
      ->allow_extra_args(false);
  command.add_option("--report", outputs.report, "JSON file for times, counts and settings");
  command.add_option("--preview", outputs.preview, "PNG file that is rewritten while the estimate improves");
  command.add_option("--exposure", outputs.display.exposure, "stops, for PNG (default 0)");
  command.add_option("--tonemap", outputs.display.tonemap, "for PNG: none, reinhard or agx (default none)")
      ->check(CLI::IsMember({"none", "reinhard", "agx"}));
  command.add_option_function<std::string>(
      "--illuminance-range", [&outputs](const std::string& text) { read_range(text, outputs.display); },
      "LOW:HIGH, lux: the scale of the false colours of --aov illuminance (default: 0 to a round number)");
}

void check_outputs(const OutputOptions& outputs, const RenderSettings& settings) {
  const bool illuminance = std::count(settings.aovs.begin(), settings.aovs.end(), "illuminance") > 0;
  if (!(std::abs(outputs.display.exposure) <= 100))  // also what is not a number
    throw InputError("--exposure must lie between -100 and 100 stops");
  for (const auto& file : outputs.images) check_writable(file);
  if (illuminance)
    for (const auto& file : illuminance_files(outputs)) check_writable(file);
  if (!outputs.preview.empty()) check_writable(outputs.preview);
  if (!outputs.report.empty()) check_text_writable(outputs.report);
}

PreviewCallback preview_writer(const OutputOptions& outputs) {
  if (outputs.preview.empty()) return {};
  return [outputs](const Picture& picture) { write_picture(outputs.preview, picture, outputs.display); };
}

int write_outputs(const OutputOptions& outputs, const RenderResult& result, Console& console, bool quiet) {
  for (const auto& file : outputs.images) write_picture(file, result.picture, outputs.display);
  const auto& planes = result.picture.planes;
  std::vector<std::string> written = outputs.images;
  if (std::any_of(planes.begin(), planes.end(), [](const Plane& p) { return p.name == "illuminance"; }))
    for (const auto& file : illuminance_files(outputs))
      write_illuminance(file, result.picture, outputs.display), written.push_back(file);
  if (!outputs.preview.empty()) write_picture(outputs.preview, result.picture, outputs.display);
  if (!outputs.report.empty()) write_text(outputs.report, result.report_json);
  console.clear();
  if (result.interrupted)
    std::fprintf(stderr, "interrupted: what was finished has been written to %s\n",
                 outputs.images.front().c_str());
  else if (!quiet)
    for (const auto& file : written) std::printf("wrote %s\n", file.c_str());
  return result.interrupted ? 130 : 0;
}

}  // namespace lumirank::cli
