// The command line: a thin main over the public headers. Exit codes: 0 done, 1 internal error, 2 bad input,
// 130 interrupted.
#include <cstdio>
#include <exception>
#include <string>

#include "commands.h"

int main(int argc, char** argv) {
  using namespace lumirank;
  cli::install_signal_handlers();
  CLI::App app{"Lumirank: global illumination by sampling the many-light matrix"};
  app.name("lumirank");
  app.set_version_flag("--version", version());
  app.require_subcommand(1);
  cli::Action action;
  cli::add_render(app, action);
  cli::add_reference(app, action);
  cli::add_compare(app, action);
  cli::add_error(app, action);
  cli::add_info(app, action);
  cli::add_convert(app, action);
  cli::add_methods(app, action);
  app.footer(
      "Examples:\n"
      "  lumirank render room.xml -o room.png\n"
      "  lumirank render --help\n");
  if (argc < 2) {
    std::fputs(app.help().c_str(), stderr);
    return 2;
  }
  if (argv[1][0] != '-') {
    bool known = false;
    std::string commands;
    for (const CLI::App* command : app.get_subcommands([](CLI::App*) { return true; })) {
      known = known || command->get_name() == argv[1];
      commands += (commands.empty() ? "" : ", ") + command->get_name();
    }
    if (!known) {
      std::fprintf(stderr, "lumirank: there is no command '%s'; the commands are %s\n", argv[1],
                   commands.c_str());
      return 2;
    }
  }
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& e) {
    const int code = app.exit(e);
    return code == 0 ? 0 : 2;
  } catch (const InputError& e) {
    std::fprintf(stderr, "lumirank: %s\n", e.what());
    return 2;
  }
  try {
    return action();
  } catch (const InputError& e) {
    std::fprintf(stderr, "lumirank: %s\n", e.what());
    return 2;
  } catch (const Cancelled&) {
    std::fprintf(stderr, "lumirank: interrupted before anything was finished; nothing was written\n");
    return 130;
  } catch (const std::exception& e) {
    std::fprintf(stderr, "lumirank: internal error: %s\n", e.what());
    return 1;
  }
}
