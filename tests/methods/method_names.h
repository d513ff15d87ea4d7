// Names for tests that run once for every method.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "methods/method.h"

namespace lumirank::methods::test {

inline std::vector<std::string> method_names() {
  std::vector<std::string> names;
  for (const MethodInfo& m : all_methods()) names.push_back(m.name);
  return names;
}

// As a part of a test's name, which has letters, digits and underscores alone.
inline std::string name_of_test(const testing::TestParamInfo<std::string>& method) {
  std::string name = method.param;
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
}

}  // namespace lumirank::methods::test
