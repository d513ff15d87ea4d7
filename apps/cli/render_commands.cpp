#include <chrono>
#include <cstdio>
#include <memory>

#include "commands.h"
#include "values.h"

namespace lumirank::cli {

void add_render(CLI::App& app, Action& action) {
  struct Options {
    CommonOptions common;
    OutputOptions outputs;
  };
  auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand("render", "render one image");
  add_scene_options(*command, options->common);
  add_moment_options(*command, options->common);
  add_output_options(*command, options->outputs);
  add_setting_options(*command, options->common, {});
  command->footer(
      "Examples:\n"
      "  lumirank render room.xml -o room.png\n"
      "  lumirank render room.xml -o room.exr --size 800x600 --set rows=300 --set columns=900 --report "
      "room.json\n"
      "  lumirank render room.xml -o room.exr --time 10 --preview room.png --aov light:*\n");
  command->callback([options, &action] {
    action = [options](Streams streams) {
      const CommonOptions& common = options->common;
      RenderSettings settings = common.render_settings();
      validate(settings);
      check_outputs(options->outputs, settings);
      Console console(common.verbosity(), streams.err);
      const auto start = std::chrono::steady_clock::now();
      const Scene scene = Scene::load(common.scene, common.load_options(), console.sinks());
      settings.time_spent = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
      check_inputs(options->outputs, settings, common, scene);
      const RenderResult result = render(scene, settings, console.sinks(), preview_writer(options->outputs));
      return write_outputs(options->outputs, result, console, common.quiet, streams);
    };
  });
}

void add_reference(CLI::App& app, Action& action) {
  struct Options {
    CommonOptions common;
    OutputOptions outputs;
    ReferenceSettings how;
  };
  auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand("reference", "ground truth by path tracing; states its own error");
  add_scene_options(*command, options->common);
  add_moment_options(*command, options->common);
  add_output_options(*command, options->outputs);
  add_setting_options(*command, options->common,
                      {"size", "max-depth", "only", "seed", "threads", "camera", "crop", "aov", "shutter",
                       "shutter-samples"});
  command->get_option("--aov")->description(
      "direct, indirect or emission: a layer beside the picture; repeatable");
  add_count(*command, "--spp", options->how.spp, 1, 1 << 20,
            "paths per pixel (default 64 if neither --time nor --error is given)");
  add_number(*command, "--time", options->how.time, {0, 1e7, true, "seconds"}, "seconds");
  add_number(*command, "--error", options->how.error, {0, 10, true},
             "stop when the stated relative L1 error is below");
  add_choice(
      *command, "--paths", [options](const std::string& name) { options->how.paths = reference_paths(name); },
      {"all", "columns", "rest"}, "all, columns (those that the matrix carries) or rest");
  command->footer(
      "Examples:\n"
      "  lumirank reference room.xml -o truth.exr --spp 1024\n"
      "  lumirank reference room.xml -o truth.exr --paths columns --error 0.01\n");
  command->callback([options, &action] {
    action = [options](Streams streams) {
      const CommonOptions& common = options->common;
      const RenderSettings settings = common.render_settings();
      check_outputs(options->outputs, settings);
      Console console(common.verbosity(), streams.err);
      const Scene scene = Scene::load(common.scene, common.load_options(), console.sinks());
      check_inputs(options->outputs, settings, common, scene);
      const RenderResult result =
          reference(scene, settings, options->how, console.sinks(), preview_writer(options->outputs));
      const int code = write_outputs(options->outputs, result, console, common.quiet, streams);
      if (!common.quiet) std::fprintf(streams.out, "%s\n", result.summary.c_str());
      return code;
    };
  });
}

void add_error(CLI::App& app, Action& action) {
  auto files = std::make_shared<std::pair<std::string, std::string>>();
  CLI::App* command = app.add_subcommand("error", "how far an image is from a reference, as JSON");
  command->add_option("image", files->first, "image file")->required();
  command->add_option("reference", files->second, "reference file")->required();
  command->footer("Example:\n  lumirank error room.exr truth.exr\n");
  command->callback([files, &action] {
    action = [files](Streams streams) {
      print(streams, error_of_file(files->first, files->second).json());
      return 0;
    };
  });
}

void add_info(CLI::App& app, Action& action) {
  struct Options {
    CommonOptions common;
    bool json = false;
  };
  auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand("info", "what was loaded, and what was replaced");
  add_scene_options(*command, options->common);
  add_moment_options(*command, options->common);
  command->add_flag("--json", options->json, "as JSON");
  command->footer("Example:\n  lumirank info room.xml\n");
  command->callback([options, &action] {
    action = [options](Streams streams) {
      Console console(options->common.verbosity(), streams.err);
      Sinks sinks = console.sinks();
      sinks.warning = {};  // the listing has them
      const Scene scene = Scene::load(options->common.scene, options->common.load_options(), sinks);
      const SceneInfo info = scene.info(sinks);
      const std::string text = options->json ? info.json() : info.text();
      console.clear();
      print(streams, text);
      return 0;
    };
  });
}

void add_methods(CLI::App& app, Action& action) {
  struct Options {
    bool json = false, all = false;
  };
  auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand("methods", "the methods with their parameters, defaults and papers");
  command->add_flag("--json", options->json, "as JSON");
  command->add_flag("--all", options->all,
                    "also the parameters that switch off steps of a method, for experiments");
  command->footer("Examples:\n  lumirank methods --json\n  lumirank methods --all\n");
  command->callback([options, &action] {
    action = [options](Streams streams) {
      print(streams, options->json ? methods_json(options->all) : methods_text(options->all));
      return 0;
    };
  });
}

}  // namespace lumirank::cli
