// The list of methods, as text and as JSON.
#include <nlohmann/json.hpp>

#include "lumirank/lumirank.h"
#include "methods/method.h"

namespace lumirank {

std::string methods_json() {
  nlohmann::ordered_json json = nlohmann::json::array();
  for (const auto& m : methods::all_methods()) {
    nlohmann::ordered_json parameters = nlohmann::json::array();
    for (const auto& p : m.parameters)
      parameters.push_back({{"key", p.key},
                            {"type", p.type},
                            {"default", p.default_text},
                            {"range", p.range},
                            {"unit", p.unit},
                            {"help", p.help}});
    json.push_back(
        {{"name", m.name}, {"summary", m.summary}, {"paper", m.paper}, {"parameters", parameters}});
  }
  return json.dump(1) + "\n";
}

std::string methods_text() {
  std::string text;
  for (const auto& m : methods::all_methods()) {
    text += m.name + "\n  " + m.summary + "\n";
    if (!m.paper.empty()) text += "  " + m.paper + "\n";
    for (const auto& p : m.parameters) {
      text += "    --set " + p.key + "=" + (p.default_text.empty() ? "…" : p.default_text) + "  (" + p.type;
      if (!p.range.empty()) text += ", " + p.range;
      if (!p.unit.empty()) text += ", " + p.unit;
      text += ")  " + p.help + "\n";
    }
    text += "\n";
  }
  return text;
}

}  // namespace lumirank
