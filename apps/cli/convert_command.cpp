#include <cstdio>
#include <memory>

#include "commands.h"
#include "lumirank/convert.h"

namespace lumirank::cli {

void add_convert(CLI::App& app, Action& action) {
  struct Options {
    CommonOptions common;
    std::string output;
  };
  auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand("convert", "write the scene as Mitsuba 3 XML");
  add_scene_options(*command, options->common);
  add_moment_options(*command, options->common);
  command->add_option("output", options->output, "OUT.xml; meshes and pictures are written beside it")
      ->required();
  command->footer("Example:\n  lumirank convert room.glb room.xml\n");
  command->callback([options, &action] {
    action = [options](Streams streams) {
      Console console(options->common.verbosity(), streams.err);
      const Scene scene = Scene::load(options->common.scene, options->common.load_options(), console.sinks());
      const auto files = convert(scene, options->output, console.sinks());
      console.clear();
      if (!options->common.quiet)
        std::fprintf(streams.out, "wrote %s and %zu files beside it\n", files.back().c_str(),
                     files.size() - 1);
      return 0;
    };
  });
}

}  // namespace lumirank::cli
