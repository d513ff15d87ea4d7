// The files that a command writes: checked before any work, written together.
#include <algorithm>
#include <charconv>
#include <cstdio>
#include <filesystem>

#include "commands.h"
#include "values.h"

namespace lumirank::cli {
namespace {

namespace fs = std::filesystem;

void read_range(const std::string& text, DisplaySettings& display) {
  const std::string option = "--illuminance-range";
  const std::size_t colon = text.find(':');
  if (colon == std::string::npos)
    throw InputError("'" + text + "' is not a range of lux", "write it as " + option + " LOW:HIGH");
  const Bounds lux{0, 1e12, false, "lux"};
  display.lux_low = read_number(option, text.substr(0, colon), lux);
  display.lux_high = read_number(option, text.substr(colon + 1), lux);
  if (!(display.lux_high > display.lux_low))
    throw InputError("'" + text + "' is an empty range of lux", "write it as LOW:HIGH with LOW < HIGH");
}

std::string lower_extension(const std::string& file) {
  std::string extension = fs::path(file).extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension;
}

// Beside each PNG picture: room.png → room.illuminance.png.
std::vector<std::string> illuminance_files(const OutputOptions& outputs) {
  std::vector<std::string> files;
  for (const auto& image : outputs.images)
    if (lower_extension(image) == ".png")
      files.push_back(fs::path(image).replace_extension(".illuminance.png").string());
  return files;
}

// All that will be written.
std::vector<std::string> files_of(const OutputOptions& outputs, const RenderSettings& settings) {
  std::vector<std::string> files = outputs.images;
  if (std::count(settings.layers.begin(), settings.layers.end(), "illuminance") > 0)
    for (auto& file : illuminance_files(outputs)) files.push_back(std::move(file));
  for (const auto& file : {outputs.preview, outputs.report})
    if (!file.empty()) files.push_back(file);
  return files;
}

}  // namespace

void add_output_options(CLI::App& command, OutputOptions& outputs) {
  command.add_option("-o,--output", outputs.images, "image file: .exr, .png or .pfm; repeatable")
      ->required()
      ->allow_extra_args(false);
  command.add_option("--report", outputs.report, "JSON file for times, counts and settings");
  command.add_option("--preview", outputs.preview, "PNG file that is rewritten while the estimate improves");
  add_number(command, "--exposure", outputs.display.exposure, {-100, 100, false, "stops"},
             "stops, for PNG (default 0; else what shows a picture that would be white or black)");
  add_choice(
      command, "--tonemap", [&outputs](const std::string& name) { outputs.display.tonemap = tone_map(name); },
      {"none", "reinhard", "agx"}, "for PNG: none, reinhard or agx (default none)");
  command.add_option_function<std::string>(
      "--illuminance-range", [&outputs](const std::string& text) { read_range(text, outputs.display); },
      "LOW:HIGH, lux: the scale of the false colors of --aov illuminance (default: 0 to a round number)");
}

void check_outputs(const OutputOptions& outputs, const RenderSettings& settings) {
  for (const auto& file : outputs.images) check_writable(file);
  if (std::count(settings.layers.begin(), settings.layers.end(), "illuminance") > 0)
    for (const auto& file : illuminance_files(outputs)) check_writable(file);
  if (!outputs.preview.empty()) {
    if (lower_extension(outputs.preview) != ".png")
      throw InputError({outputs.preview, 0}, "a preview is a PNG file", "give a name that ends in .png");
    // A pipe would be waited for at every preview.
    if (std::error_code error; fs::exists(outputs.preview, error) &&
                               !fs::is_directory(outputs.preview, error) &&
                               !fs::is_regular_file(outputs.preview, error))
      throw InputError({outputs.preview, 0}, "a preview is rewritten, which a pipe or device cannot be",
                       "give the name of a file");
    check_writable(outputs.preview);
  }
  if (!outputs.report.empty()) check_text_writable(outputs.report);
  check_distinct(files_of(outputs, settings), {});
}

void check_inputs(const OutputOptions& outputs, const RenderSettings& settings, const CommonOptions& common,
                  const Scene& scene) {
  std::vector<std::string> inputs = scene.files();
  for (const auto& file : {common.scene, common.environment, common.replay})
    if (!file.empty()) inputs.push_back(file);
  check_distinct(files_of(outputs, settings), inputs);
}

PreviewCallback preview_writer(const OutputOptions& outputs) {
  if (outputs.preview.empty()) return {};
  return [outputs](const Picture& picture) { write_picture(outputs.preview, picture, outputs.display); };
}

namespace {

void say_exposure(const OutputOptions& outputs, const Picture& picture, Streams streams) {
  const bool shown = std::any_of(outputs.images.begin(), outputs.images.end(),
                                 [](const std::string& file) { return lower_extension(file) == ".png"; });
  const double stops = shown && !outputs.display.exposure ? exposure_for(picture) : 0;
  if (stops != 0)
    std::fprintf(streams.out, "exposure: %+g stops, or the PNG would be %s (--exposure 0 leaves it so)\n",
                 stops, stops < 0 ? "white" : "black");
}

// It was wanted where it is found, and none was.
bool lacks_denoiser(const Report& report) {
  const auto note = report.notes.find("denoiser");
  return note != report.notes.end() && note->second == "none" &&
         report.settings.denoise == Denoise::automatic && report.notes.contains("denoiser.trouble");
}

}  // namespace

int write_outputs(const OutputOptions& outputs, const RenderResult& result, Console& console, bool quiet,
                  Streams streams) {
  FilesTogether together;
  for (const auto& file : outputs.images) write_picture(file, result.picture, outputs.display);
  const auto& planes = result.picture.planes;
  std::vector<std::string> written = outputs.images;
  if (std::any_of(planes.begin(), planes.end(), [](const Plane& p) { return p.name == "illuminance"; }))
    for (const auto& file : illuminance_files(outputs))
      write_illuminance(file, result.picture, outputs.display), written.push_back(file);
  if (!outputs.preview.empty()) write_picture(outputs.preview, result.picture, outputs.display);
  if (!outputs.report.empty()) write_text(outputs.report, result.report.json());
  together.commit();
  console.clear();
  if (result.interrupted)
    std::fprintf(streams.err, "interrupted: what was finished has been written to %s\n",
                 outputs.images.front().c_str());
  else if (!quiet) {
    for (const auto& file : written) std::fprintf(streams.out, "wrote %s\n", file.c_str());
    say_exposure(outputs, result.picture, streams);
    if (lacks_denoiser(result.report))
      std::fprintf(
          streams.out,
          "it has its noise still: `make denoiser` gets Open Image Denoise, which takes it out of this "
          "and all later pictures (--denoise off is content without)\n");
  }
  return result.interrupted ? 130 : 0;
}

}  // namespace lumirank::cli
