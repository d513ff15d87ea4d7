#include <cstdio>
#include <memory>

#include "commands.h"

namespace lumirank::cli {

void add_render(CLI::App& app, Action& action) {
  struct Options {
    CommonOptions common;
    OutputOptions outputs;
  };
  auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand("render", "render one image");
  add_scene_options(*command, options->common);
  add_output_options(*command, options->outputs);
  add_setting_options(*command, options->common, {});
  command->footer(
      "Examples:\n"
      "  lumirank render room.xml -o room.png\n"
      "  lumirank render room.xml -o room.exr --size 800x600 --set rows=300 --set columns=900 --report "
      "room.json\n"
      "  lumirank render room.xml -o room.exr --time 10 --preview room.png --aov light:*\n");
  command->callback([options, &action] {
    action = [options] {
      const CommonOptions& common = options->common;
      const RenderSettings settings = common.render_settings();
      validate(settings);
      check_outputs(options->outputs, settings);
      Console console(common.verbosity());
      const Scene scene = Scene::load(common.scene, common.load_options(), console.sinks());
      const RenderResult result = render(scene, settings, console.sinks(), preview_writer(options->outputs));
      return write_outputs(options->outputs, result, console, common.quiet);
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
  add_output_options(*command, options->outputs);
  add_setting_options(*command, options->common,
                      {"size", "max-depth", "only", "seed", "threads", "camera", "crop", "aov"});
  command
      ->add_option("--spp", options->how.spp,
                   "paths per pixel (default 64 if neither --time nor --error is given)")
      ->check(CLI::Range(1, 1 << 20));
  command->add_option("--time", options->how.time, "seconds")->check(CLI::PositiveNumber);
  command->add_option("--error", options->how.error, "stop when the stated relative L1 error is below")
      ->check(CLI::PositiveNumber);
  command->add_option("--paths", options->how.paths, "all, columns (those that the matrix carries) or rest")
      ->check(CLI::IsMember({"all", "columns", "rest"}));
  command->footer(
      "Examples:\n"
      "  lumirank reference room.xml -o truth.exr --spp 1024\n"
      "  lumirank reference room.xml -o truth.exr --paths columns --error 0.01\n");
  command->callback([options, &action] {
    action = [options] {
      const CommonOptions& common = options->common;
      const RenderSettings settings = common.render_settings();
      check_outputs(options->outputs, settings);
      Console console(common.verbosity());
      const Scene scene = Scene::load(common.scene, common.load_options(), console.sinks());
      const RenderResult result =
          reference(scene, settings, options->how, console.sinks(), preview_writer(options->outputs));
      const int code = write_outputs(options->outputs, result, console, common.quiet);
      if (!common.quiet) std::printf("%s\n", result.summary.c_str());
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
    action = [files] {
      std::fputs(error_json(files->first, files->second).c_str(), stdout);
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
  command->add_flag("--json", options->json, "as JSON");
  command->footer("Example:\n  lumirank info room.xml\n");
  command->callback([options, &action] {
    action = [options] {
      Console console(options->common.verbosity());
      Sinks sinks = console.sinks();
      sinks.warning = {};  // the listing has them
      const Scene scene = Scene::load(options->common.scene, options->common.load_options(), sinks);
      const std::string text = options->json ? scene.info_json(sinks) : scene.info_text(sinks);
      console.clear();
      std::fputs(text.c_str(), stdout);
      return 0;
    };
  });
}

void add_methods(CLI::App& app, Action& action) {
  auto json = std::make_shared<bool>(false);
  CLI::App* command = app.add_subcommand("methods", "the methods with their parameters, defaults and papers");
  command->add_flag("--json", *json, "as JSON");
  command->footer("Example:\n  lumirank methods --json\n");
  command->callback([json, &action] {
    action = [json] {
      std::fputs((*json ? methods_json() : methods_text()).c_str(), stdout);
      return 0;
    };
  });
}

}  // namespace lumirank::cli
