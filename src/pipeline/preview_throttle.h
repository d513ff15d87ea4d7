// Previews while an estimate improves, but not too many of them.
#pragma once

#include "base/timer.h"
#include "lumirank/lumirank.h"

namespace lumirank::pipeline {

// Calls back at most about twice a second: developing and encoding a picture costs more than many columns.
class PreviewThrottle {
 public:
  explicit PreviewThrottle(const PreviewCallback& callback) : callback_(callback) {}
  bool due() {
    if (!callback_ || (shown_ && timer_.seconds() < 0.5)) return false;
    timer_ = Timer();
    return shown_ = true;
  }
  void show(const Picture& picture) const { callback_(picture); }

 private:
  const PreviewCallback& callback_;
  Timer timer_;
  bool shown_ = false;
};

}  // namespace lumirank::pipeline
