// Wall-clock seconds, for reports and --time; no result depends on it unless --time is given.
#pragma once

#include <chrono>

namespace lumirank {

class Timer {
 public:
  double seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace lumirank
