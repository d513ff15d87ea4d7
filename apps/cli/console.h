// The terminal: warnings, a progress bar with the remaining time, and Ctrl-C.
#pragma once

#include <atomic>
#include <mutex>
#include <string>

#include "lumirank/sinks.h"

namespace lumirank::cli {

enum class Verbosity { quiet, normal, verbose };

class Console {
 public:
  explicit Console(Verbosity verbosity);
  ~Console();
  Sinks sinks();
  // Removes the bar, so that other text can be printed.
  void clear();

 private:
  void draw(const char* phase, double fraction);

  Verbosity verbosity_;
  bool terminal_;
  std::mutex mutex_;
  std::string phase_;
  double phase_start_ = 0, last_draw_ = 0, furthest_ = 0;
  bool drawn_ = false;
};

// Set by SIGINT and SIGTERM; a second signal ends the program at once.
extern std::atomic<bool> g_interrupted;
void install_signal_handlers();

}  // namespace lumirank::cli
