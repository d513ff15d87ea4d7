// Seconds for reports and --time; no result depends on them unless --time is given.
#pragma once

#include <chrono>
#include <ctime>

namespace lumirank {

// Of the wall clock.
class Timer {
 public:
  Timer() : Timer(0) {}
  // As if it had been started `elapsed` seconds ago.
  explicit Timer(double elapsed)
      : start_(std::chrono::steady_clock::now() -
               std::chrono::duration_cast<std::chrono::steady_clock::duration>(
                   std::chrono::duration<double>(elapsed))) {}
  double seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }

 private:
  std::chrono::steady_clock::time_point start_;
};

// Of the calling thread's processor time, so that what others run beside it does not count.
class ThreadTimer {
 public:
  double seconds() const { return now() - start_; }

 private:
  static double now() {
    std::timespec t{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
  }
  double start_ = now();
};

}  // namespace lumirank
