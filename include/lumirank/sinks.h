// Sinks for messages, progress and the question whether to stop. Passed in by the host; the library itself
// never prints.
#pragma once

#include <atomic>
#include <functional>
#include <string>

namespace lumirank {

// All members may be empty. They may be called from any thread, one call at a time per stage.
struct Sinks {
  std::function<void(const std::string& message)> info;
  std::function<void(const std::string& message)> warning;
  // `fraction` of the named phase in [0, 1].
  std::function<void(const char* phase, double fraction)> progress;
  // Set by the host (a signal handler, say) to stop early; checked between blocks of work.
  const std::atomic<bool>* cancel = nullptr;

  void say(const std::string& m) const {
    if (info) info(m);
  }
  void warn(const std::string& m) const {
    if (warning) warning(m);
  }
  void report(const char* phase, double fraction) const {
    if (progress) progress(phase, fraction);
  }
  bool cancelled() const { return cancel && cancel->load(std::memory_order_relaxed); }
};

}  // namespace lumirank
