// What an InputError says to the one who caused it.
#pragma once

#include <string>

#include "base/error.h"

namespace lumirank::test {

// Empty if nothing was refused.
template <typename Work>
std::string refused(const Work& work) {
  try {
    work();
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

}  // namespace lumirank::test
