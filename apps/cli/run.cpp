#include "run.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <exception>
#include <new>
#include <sstream>
#include <system_error>

#include "commands.h"
#include "process.h"

namespace lumirank::cli {
namespace {

// Whatever is wrong with the options is said in the program's name, with the way to the right ones.
int refuse(Streams streams, const std::string& message) {
  std::fprintf(streams.err, "lumirank: %s\n", message.c_str());
  return 2;
}

std::string help_hint(const CLI::App& app) {
  const auto chosen = app.get_subcommands();
  return "`lumirank " + (chosen.empty() ? "" : chosen.front()->get_name() + " ") +
         "--help` lists what there is";
}

// CLI11 counts ("At Most 1 required but received 2"); a person wants to know what is there twice.
std::string repeated_option(const CLI::App& app) {
  for (const CLI::App* command : app.get_subcommands())
    for (const CLI::Option* option : command->get_options())
      if (option->get_items_expected_max() == 1 && option->results().size() > 1)
        return option->get_name() + " is given " +
               (option->results().size() == 2 ? "twice"
                                              : std::to_string(option->results().size()) + " times") +
               "; give it once";
  return {};
}

int refuse_options(Streams streams, const CLI::App& app, const CLI::ParseError& error) {
  const std::string repeated = repeated_option(app);
  if (!repeated.empty()) return refuse(streams, repeated);
  std::string what = error.what();
  if (dynamic_cast<const CLI::ExtrasError*>(&error)) {
    const auto extra = app.remaining(true);
    const auto option = std::find_if(extra.begin(), extra.end(),
                                     [](const std::string& word) { return word.starts_with('-'); });
    if (option != extra.end())
      what = "there is no option '" + *option + "'";
    else if (!extra.empty())
      what = "there is no use for the argument '" + extra.front() + "'";
  }
  // "--size: 1 required TEXT missing"
  if (dynamic_cast<const CLI::ArgumentMismatch*>(&error))
    what = what.substr(0, what.find(':')) + " needs a value";
  while (!what.empty() && (what.back() == '\n' || what.back() == ' ')) what.pop_back();
  return refuse(streams, what + "; " + help_hint(app));
}

// Without a word where the reader has gone: `| head` has had what it wanted.
std::string why_lost(int reason) {
  if (reason == EPIPE) end_by_broken_pipe();
  return "standard output cannot be written" + (reason ? std::string(": ") + std::strerror(reason) : "");
}

int run_command(const std::vector<std::string>& arguments, Streams streams) {
  CLI::App app{"Lumirank: global illumination by sampling the many-light matrix"};
  app.name("lumirank");
  app.set_version_flag("--version", version() + " (" + instruction_set() + ")");
  app.require_subcommand(1);
  Action action;
  add_render(app, action);
  add_reference(app, action);
  add_animate(app, action);
  add_compare(app, action);
  add_error(app, action);
  add_info(app, action);
  add_convert(app, action);
  add_methods(app, action);
  app.footer(
      "Examples:\n"
      "  lumirank render room.xml -o room.png\n"
      "  lumirank render --help\n");
  if (arguments.empty()) {
    std::fputs(app.help().c_str(), streams.err);
    return 2;
  }
  if (const std::string& first = arguments[0]; first != "--help" && first != "-h" && first != "--version") {
    bool known = false;
    std::string commands;
    for (const CLI::App* command : app.get_subcommands([](CLI::App*) { return true; })) {
      known = known || command->get_name() == first;
      commands += (commands.empty() ? "" : ", ") + command->get_name();
    }
    if (!known) return refuse(streams, "there is no command '" + first + "'; the commands are " + commands);
  }
  try {
    app.parse(std::vector<std::string>(arguments.rbegin(), arguments.rend()));
  } catch (const CLI::Success& asked) {  // help or version
    std::ostringstream text, unused;
    app.exit(asked, text, unused);
    print(streams, text.str());
    return 0;
  } catch (const CLI::ParseError& error) {
    return refuse_options(streams, app, error);
  }
  return action(streams);
}

}  // namespace

void print(Streams streams, const std::string& text) {
  errno = 0;
  if (std::fputs(text.c_str(), streams.out) < 0 || std::fflush(streams.out) != 0) throw OutputLost{errno};
}

int run(const std::vector<std::string>& arguments, Streams streams) {
  int code = 1;
  try {
    code = run_command(arguments, streams);
  } catch (const InputError& e) {
    code = refuse(streams, e.what());
  } catch (const OutputLost& lost) {
    code = refuse(streams, why_lost(lost.reason));
    std::clearerr(streams.out);
  } catch (const Cancelled&) {
    std::fprintf(streams.err, "lumirank: interrupted before anything was finished; nothing was written\n");
    code = 130;
  } catch (const std::bad_alloc&) {
    code = refuse(streams, "there is not enough memory; close other programs, or ask for less");
  } catch (const std::exception& e) {
    const auto* system = dynamic_cast<const std::system_error*>(&e);
    if (system && system->code() == std::errc::resource_unavailable_try_again)
      code = refuse(streams, "no thread can be started; close other programs, or raise the limits (ulimit)");
    else
      std::fprintf(streams.err, "lumirank: internal error: %s\n", e.what());
  }
  // Of commands whose results are files only the words about them are lost.
  errno = 0;
  if (std::fflush(streams.out) != 0 || std::ferror(streams.out))
    std::fprintf(streams.err, "warning: %s\n", why_lost(errno).c_str());
  std::fflush(streams.err);
  return code;
}

}  // namespace lumirank::cli
