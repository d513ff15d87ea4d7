#include "console.h"

#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>

#include "process.h"

namespace lumirank::cli {

namespace {
double now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}
}  // namespace

Console::Console(Verbosity verbosity, std::FILE* stream)
    : verbosity_(verbosity), stream_(stream), terminal_(isatty(fileno(stream)) != 0) {}

Console::~Console() { clear(); }

Sinks Console::sinks() {
  Sinks sinks;
  if (verbosity_ == Verbosity::verbose)
    sinks.info = [this](const std::string& m) {
      clear();
      std::fprintf(stream_, "%s\n", m.c_str());
    };
  if (verbosity_ != Verbosity::quiet)
    sinks.warning = [this](const std::string& m) {
      clear();
      std::fprintf(stream_, "warning: %s\n", m.c_str());
    };
  if (verbosity_ != Verbosity::quiet && terminal_)
    sinks.progress = [this](const char* phase, double fraction) { draw(phase, fraction); };
  sinks.cancel = &g_interrupted;
  return sinks;
}

void Console::clear() {
  const std::scoped_lock lock(mutex_);
  if (!drawn_) return;
  std::fprintf(stream_, "\r\033[K");
  drawn_ = false;
}

void Console::draw(const char* phase, double fraction) {
  const std::scoped_lock lock(mutex_);
  const double t = now();
  if (phase_ != phase || fraction < 0.5 * furthest_)
    phase_ = phase, phase_start_ = t, last_draw_ = 0, furthest_ = 0;
  furthest_ = std::max(furthest_, fraction);
  if (t - last_draw_ < 0.1 && furthest_ < 1) return;
  last_draw_ = t;
  constexpr int kWidth = 30;
  const int filled = static_cast<int>(std::clamp(furthest_, 0.0, 1.0) * kWidth);
  char bar[kWidth + 1];
  for (int k = 0; k < kWidth; ++k) bar[k] = k < filled ? '#' : '-';
  bar[kWidth] = 0;
  const double elapsed = t - phase_start_;
  if (furthest_ > 0.01 && elapsed > 0.3) {
    std::fprintf(stream_, "\r\033[K%-16s [%s] %3.0f %%  %.0f s left", phase, bar, 100 * furthest_,
                 elapsed * (1 - furthest_) / furthest_);
  } else {
    std::fprintf(stream_, "\r\033[K%-16s [%s] %3.0f %%", phase, bar, 100 * furthest_);
  }
  std::fflush(stream_);
  drawn_ = true;
}

}  // namespace lumirank::cli
