// Scenes that move, as they are at a moment.
#pragma once

#include "scenedesc/readers.h"

namespace lumirank::scenedesc {

inline ReadOptions moment(double seconds) {
  ReadOptions options;
  options.time = seconds;
  return options;
}

}  // namespace lumirank::scenedesc
