// The list of methods: typed, as text and as JSON.
#include <nlohmann/json.hpp>

#include "api/tensor_parameters.h"
#include "lumirank/info.h"
#include "methods/method.h"

namespace lumirank {

std::vector<MethodDescription> list_methods() {
  std::vector<MethodDescription> list;
  for (const auto& m : methods::all_methods()) {
    MethodDescription& d = list.emplace_back(MethodDescription{m.name, m.summary, m.paper, {}, false});
    for (const auto& p : m.parameters)
      d.parameters.push_back({p.key, p.type, p.default_text, p.range, p.unit, p.help, p.experiment});
  }
  list.push_back(api::describe_tensor_clustering());
  return list;
}

std::string methods_json(bool all) {
  nlohmann::ordered_json json = nlohmann::json::array();
  for (const MethodDescription& m : list_methods()) {
    nlohmann::ordered_json parameters = nlohmann::json::array();
    for (const auto& p : m.parameters)
      if (all || !p.experiment)
        parameters.push_back({{"key", p.key},
                              {"type", p.type},
                              {"default", p.default_text},
                              {"range", p.range},
                              {"unit", p.unit},
                              {"help", p.help},
                              {"experiment", p.experiment}});
    json.push_back({{"name", m.name},
                    {"summary", m.summary},
                    {"paper", m.paper},
                    {"of_shots", m.of_shots},
                    {"parameters", parameters}});
  }
  return json.dump(1) + "\n";
}

std::string methods_text(bool all) {
  std::string text;
  for (const MethodDescription& m : list_methods()) {
    text += m.name + "\n  " + m.summary + "\n";
    if (!m.paper.empty()) text += "  " + m.paper + "\n";
    std::size_t hidden = 0;
    for (const auto& p : m.parameters) {
      if (p.experiment && !all) {
        ++hidden;
        continue;
      }
      text += "    --set " + p.key + "=" + (p.default_text.empty() ? "…" : p.default_text) + "  (" + p.type;
      if (!p.range.empty()) text += ", " + p.range;
      if (!p.unit.empty()) text += ", " + p.unit;
      text += ")  " + p.help + (p.experiment ? " For experiments." : "") + "\n";
    }
    if (hidden > 0) text += "    and " + std::to_string(hidden) + " for experiments, which --all lists\n";
    text += "\n";
  }
  return text;
}

}  // namespace lumirank
