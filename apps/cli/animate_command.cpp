// Numbered frames of a scene that moves, and a film of them by ffmpeg.
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <cstring>
#include <filesystem>
#include <memory>

#include "commands.h"
#include "lumirank/animate.h"
#include "values.h"

extern char** environ;

namespace lumirank::cli {
namespace {

namespace fs = std::filesystem;

struct AnimateOptions {
  CommonOptions common;
  AnimateSettings settings;
  std::string folder, frames, formats = "exr,png", video;
  int chunk = 0;  // 0: as the method has it
};

void read_frames(const std::string& text, AnimateSettings& settings) {
  const std::size_t colon = text.find(':');
  settings.first = read_count("--frames", text.substr(0, colon), 0, 10'000'000);
  settings.last = colon == std::string::npos ? settings.first
                                             : read_count("--frames", text.substr(colon + 1), 0, 10'000'000);
}

// Before any frame is rendered for it.
void check_video(const AnimateOptions& options) {
  if (options.video.empty()) return;
  if (options.formats.find("png") == std::string::npos)
    throw InputError("a film is made of PNG frames", "add png to --format");
  const fs::path file(options.video);
  if (file.extension().empty())
    throw InputError({options.video, 0}, "the film's name has no ending", "give --video FILE.mp4");
  std::error_code error;
  const fs::path folder = fs::absolute(file).lexically_normal().parent_path(),
                 frames = fs::absolute(fs::path(options.folder) / "x").lexically_normal().parent_path();
  if (folder != frames && !fs::is_directory(folder, error))  // that of the frames is made
    throw InputError({options.video, 0}, "its folder does not exist", "make it, or choose another place");
  if (fs::is_directory(file, error)) throw InputError({options.video, 0}, "is a folder", "name a file in it");
}

// The PNG frames that were asked for, as H.264 at a quality that shows no blocks. The file is whole or as
// it was.
void make_video(const AnimateOptions& options, const AnimationResult& result, Streams streams) {
  // ffmpeg goes by the ending.
  const std::string unfinished =
      options.video + ".part-" + std::to_string(getpid()) + fs::path(options.video).extension().string();
  char rate[32];
  std::snprintf(rate, sizeof rate, "%g", options.settings.frames_per_second);
  const std::string first = std::to_string(result.first),
                    count = std::to_string(result.last - result.first + 1);
  const std::string frames = options.folder + "/frame_%04d.png";
  // Even numbers of pixels are what players can show.
  const char* words[] = {"ffmpeg",
                         "-y",
                         "-loglevel",
                         "error",
                         "-framerate",
                         rate,
                         "-start_number",
                         first.c_str(),
                         "-i",
                         frames.c_str(),
                         "-frames:v",
                         count.c_str(),
                         "-vf",
                         "pad=ceil(iw/2)*2:ceil(ih/2)*2",
                         "-c:v",
                         "libx264",
                         "-crf",
                         "16",
                         "-pix_fmt",
                         "yuv420p",
                         unfinished.c_str(),
                         nullptr};
  pid_t process = 0;
  int status = 0;
  if (const int error =
          posix_spawnp(&process, "ffmpeg", nullptr, nullptr, const_cast<char**>(words), environ))
    throw InputError(std::string("the film was not made: ffmpeg cannot be started (") + std::strerror(error) +
                         "); the frames are there",
                     "install ffmpeg, or leave out --video");
  const bool made = waitpid(process, &status, 0) >= 0 && status == 0;
  std::error_code error_of_file;
  if (made) fs::rename(unfinished, options.video, error_of_file);
  if (!made || error_of_file) {
    std::error_code ignored;
    fs::remove(unfinished, ignored);
    throw InputError("the film was not made: " + (made ? error_of_file.message() : "ffmpeg failed") +
                         "; the frames are there",
                     made ? "choose another place" : "see what it says above");
  }
  if (!options.common.quiet) std::fprintf(streams.out, "wrote %s\n", options.video.c_str());
}

int run_animate(AnimateOptions& options, Streams streams) {
  AnimateSettings& settings = options.settings;
  settings.render = options.common.render_settings();
  if (MethodSettings& method = settings.render.method; method.name == "tensor-clustering") {
    // Its parameters are given with --set as those of the other methods.
    settings.tensor = tensor_settings(method.parameters);
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
  check_video(options);
  Console console(options.common.verbosity(), streams.err);
  const Scene scene = Scene::load(options.common.scene, options.common.load_options(), console.sinks());
  choose_shot_method(scene, settings);
  if (options.chunk > 0) {
    if (!settings.tensor)
      throw InputError("--chunk is of tensor clustering alone: frames are rendered one by one here",
                       "leave it out, or give --method tensor-clustering");
    settings.tensor->chunk = options.chunk;
  }
  const AnimationResult result = animate(scene, settings, options.folder, console.sinks());
  console.clear();
  if (!options.common.quiet || result.interrupted)
    std::fprintf(
        result.interrupted ? streams.err : streams.out, "%s%d frames rendered, %d were there already: %s\n",
        result.interrupted ? "interrupted: " : "", result.rendered, result.kept, options.folder.c_str());
  if (result.interrupted) return 130;
  if (!options.video.empty()) make_video(options, result, streams);
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
                      "; also tensor-clustering, which computes columns for many frames");
  command->add_option("--frames", options->frames,
                      "FIRST:LAST, counted from 0 at second 0 (default: the whole motion)");
  add_number(*command, "--fps", options->common.fps, {0, 1000, true, "frames per second"},
             "frames per second (default 24)");
  add_count(*command, "--chunk", options->chunk, 1, 1000,
            "frames that tensor clustering makes together, as --set chunk=… (default 40)");
  add_count(*command, "--temporal-filter", options->settings.temporal_filter, 0, 100,
            "frames before and after that each one is averaged with, where frames are rendered one by one "
            "(default 3, with a named --method 0)");
  command->add_flag("--refit", options->settings.refit,
                    "for previews of large meshes that deform, frame by frame: the structures that rays are "
                    "traced in follow the vertices, which is faster to build and slower to trace");
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
