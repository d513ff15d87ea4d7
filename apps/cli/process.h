// The process around the commands: signals, standard streams, and the last resort.
#pragma once

#include <atomic>

namespace lumirank::cli {

// Set by SIGINT, SIGTERM and SIGHUP; a second signal ends the program at once, without its temporary files.
extern std::atomic<bool> g_interrupted;

// To be called before anything else.
void prepare_process();

// Whoever reads our output has gone (`| head`): ends the process as that signal would have.
[[noreturn]] void end_by_broken_pipe();

}  // namespace lumirank::cli
