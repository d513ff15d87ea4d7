// What tests of whole renders share: example scenes, and what a render gave.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "lumirank/lumirank.h"

namespace lumirank::test {

inline constexpr double kAlpha = 1e-3;         // false alarms of each test
inline constexpr double kAlphaOfAFile = 1e-4;  // of all tests of one file together

inline Scene example(const std::string& file) {
  return Scene::load(std::string(LUMIRANK_EXAMPLES) + "/" + file);
}
inline Scene box() { return example("box.xml"); }

inline nlohmann::json report_of(const RenderResult& result) {
  return nlohmann::json::parse(result.report.json());
}

// Mean of all pixels and channels.
inline double mean_value(const Picture& picture) {
  double sum = 0;
  for (const float x : picture.planes[0].rgb) sum += x;
  return sum / static_cast<double>(picture.planes[0].rgb.size());
}

}  // namespace lumirank::test
