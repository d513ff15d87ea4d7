// Numbered frames of a scene that moves, and a film of them by ffmpeg.
#include <spawn.h>
#include <sys/wait.h>

#include <cstdio>
#include <cstring>
#include <map>
#include <memory>

#include "commands.h"
#include "lumirank/animate.h"
#include "values.h"

extern char** environ;

namespace lumirank::cli {
namespace {

struct AnimateOptions {
  CommonOptions common;
  AnimateSettings settings;
  std::string folder, frames, formats = "exr,png", video;
};

void read_frames(const std::string& text, AnimateSettings& settings) {
  const std::size_t colon = text.find(':');
  settings.first = read_count("--frames", text.substr(0, colon), 0, 10'000'000);
  settings.last = colon == std::string::npos ? settings.first
                                             : read_count("--frames", text.substr(colon + 1), 0, 10'000'000);
}

// All PNG frames from the first one on, as H.264 at a quality that shows no blocks.
void make_video(const AnimateOptions& options, Streams streams) {
  char rate[32], first[16];
  std::snprintf(rate, sizeof rate, "%g", options.settings.frames_per_second);
  std::snprintf(first, sizeof first, "%d", options.settings.first);
  const std::string frames = options.folder + "/frame_%04d.png";
  // Even numbers of pixels are what players can show.
  const char* words[] = {"ffmpeg",
                         "-y",
                         "-loglevel",
                         "error",
                         "-framerate",
                         rate,
                         "-start_number",
                         first,
                         "-i",
                         frames.c_str(),
                         "-vf",
                         "pad=ceil(iw/2)*2:ceil(ih/2)*2",
                         "-c:v",
                         "libx264",
                         "-crf",
                         "16",
                         "-pix_fmt",
                         "yuv420p",
                         options.video.c_str(),
                         nullptr};
  pid_t process = 0;
  int status = 0;
  if (const int error =
          posix_spawnp(&process, "ffmpeg", nullptr, nullptr, const_cast<char**>(words), environ))
    throw InputError(std::string("the film was not made: ffmpeg cannot be started (") + std::strerror(error) +
                         "); the frames are there",
                     "install ffmpeg, or leave out --video");
  if (waitpid(process, &status, 0) < 0 || status != 0)
    throw InputError("the film was not made: ffmpeg failed; the frames are there", "see what it says above");
  if (!options.common.quiet) std::fprintf(streams.out, "wrote %s\n", options.video.c_str());
}

TensorSettings::Carrying read_carrying(const std::string& value) {
  using enum TensorSettings::Carrying;
  if (value == "auto") return automatic;
  if (value == "on") return always;
  if (value == "off") return never;
  throw InputError("--set carry is auto, on or off, not '" + value + "'",
                   "give off to have every frame computed by itself");
}

// `--method tensor-clustering`: its parameters are given with --set as those of the other methods.
TensorSettings read_tensor(const std::map<std::string, std::string>& parameters) {
  TensorSettings tensor;
  for (const auto& [key, value] : parameters) {
    const std::string option = "--set " + key;
    if (key == "chunk")
      tensor.chunk = read_count(option, value, 1, 1000);
    else if (key == "rows")
      tensor.rows = read_count(option, value, 1, 10'000);
    else if (key == "columns")
      tensor.columns = read_count(option, value, 0, 1'000'000);
    else if (key == "initial-clusters")
      tensor.initial_clusters = read_count(option, value, 1, 1'000'000);
    else if (key == "time-weight")
      tensor.time_weight = read_number(option, value, {0, 1e9});
    else if (key == "overlap")
      tensor.overlap = read_count(option, value, 0, 1000);
    else if (key == "memory")
      tensor.memory = read_number(option, value, {0, 1e9});
    else if (key == "max-change")
      tensor.max_change = read_number(option, value, {0, 1e9});
    else if (key == "max-peak")
      tensor.max_peak = read_number(option, value, {0, 1e9});
    else if (key == "carry")
      tensor.carrying = read_carrying(value);
    else if (key == "max-distance")
      tensor.max_distance = read_number(option, value, {0, 1e9});
    else if (key == "filter")
      tensor.filter = read_count(option, value, 0, 100);
    else if (key == "representatives" && (value == "central" || value == "largest"))
      tensor.largest_representatives = value == "largest";
    else if (key == "representatives")
      throw InputError("'" + value + "' names no representatives", "give central or largest");
    else if (key == "clusters" && (value == "on" || value == "off"))
      tensor.write_clusters = value == "on";
    else if (key == "clusters")
      throw InputError("--set clusters is on or off, not '" + value + "'", "give on to have them written");
    else if (key == "bits")
      tensor.bits = read_count(option, value, 16, 32);
    else
      throw InputError("tensor-clustering has no parameter '" + key + "'",
                       "it has chunk, overlap, memory, rows, columns, initial-clusters, time-weight, carry, "
                       "max-distance, max-change, max-peak, filter, representatives, bits and clusters");
  }
  return tensor;
}

int run_animate(AnimateOptions& options, Streams streams) {
  AnimateSettings& settings = options.settings;
  settings.render = options.common.render_settings();
  if (MethodSettings& method = settings.render.method; method.name == "tensor-clustering") {
    settings.tensor = read_tensor(method.parameters);
    method.name = MethodSettings{}.name, method.parameters.clear();
  }
  settings.frames_per_second = options.common.fps;
  if (!options.frames.empty()) read_frames(options.frames, settings);
  settings.endings.clear();
  for (const std::string& format : read_list("--format", options.formats)) {
    if (format != "exr" && format != "png" && format != "pfm")
      throw InputError("'" + format + "' is no format of frames", "exr, png and pfm are");
    settings.endings.push_back("." + format);
  }
  if (!options.video.empty() && options.formats.find("png") == std::string::npos)
    throw InputError("a film is made of PNG frames", "add png to --format");
  Console console(options.common.verbosity(), streams.err);
  const Scene scene = Scene::load(options.common.scene, options.common.load_options(), console.sinks());
  choose_shot_method(scene, settings);
  const AnimationResult result = animate(scene, settings, options.folder, console.sinks());
  console.clear();
  if (!options.common.quiet || result.interrupted)
    std::fprintf(
        result.interrupted ? streams.err : streams.out, "%s%d frames rendered, %d were there already: %s\n",
        result.interrupted ? "interrupted: " : "", result.rendered, result.kept, options.folder.c_str());
  if (result.interrupted) return 130;
  if (!options.video.empty()) make_video(options, streams);
  return 0;
}

}  // namespace

void add_animate(CLI::App& app, Action& action) {
  auto options = std::make_shared<AnimateOptions>();
  CLI::App* command =
      app.add_subcommand("animate", "numbered frames of a scene that moves; goes on where it stopped");
  add_scene_options(*command, options->common);
  command->add_option("-o,--output", options->folder, "folder for frame_0000.exr, frame_0000.png, …")
      ->required();
  add_setting_options(*command, options->common, {});
  CLI::Option* const method = command->get_option("--method");
  method->description(method->get_description() +
                      "; also tensor-clustering, which is auto's choice where something moves");
  command->add_option("--frames", options->frames,
                      "FIRST:LAST, counted from 0 at second 0 (default: the whole motion)");
  add_number(*command, "--fps", options->common.fps, {0, 1000, true, "frames per second"},
             "frames per second (default 24)");
  command->add_option("--clip", options->common.clip,
                      "glTF: the animation to show, by name or number; '*': all (default: the first)");
  command->add_option("--format", options->formats,
                      "exr, png and pfm, separated by commas (default exr,png)");
  command->add_option("--video", options->video,
                      "FILE.mp4, made of the PNG frames by ffmpeg, if it is installed");
  add_number(*command, "--exposure", options->settings.display.exposure, {-100, 100, false, "stops"},
             "stops, for PNG (default 0)");
  add_choice(
      *command, "--tonemap",
      [options](const std::string& name) { options->settings.display.tonemap = tone_map(name); },
      {"none", "reinhard", "agx"}, "for PNG: none, reinhard or agx (default none)");
  command->footer(
      "Examples:\n"
      "  lumirank animate fox.glb -o frames --clip Walk --fps 25 --video fox.mp4\n"
      "  lumirank animate fox.glb -o frames --clip Walk --fps 25 --frames 8:15    (another process, the same "
      "folder)\n");
  command->callback(
      [options, &action] { action = [options](Streams streams) { return run_animate(*options, streams); }; });
}

}  // namespace lumirank::cli
