#include "methods/parameters.h"

#include <charconv>
#include <cmath>

#include "base/error.h"

namespace lumirank::methods {

bool parse_count(const std::string& text, std::size_t min_value, std::size_t max_value, std::size_t& value) {
  std::size_t v = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), v);
  if (error != std::errc() || end != text.data() + text.size() || v < min_value || v > max_value)
    return false;
  value = v;
  return true;
}

bool parse_number(const std::string& text, double min_value, double max_value, double& value) {
  double v = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), v);
  if (error != std::errc() || end != text.data() + text.size() || !(v >= min_value && v <= max_value))
    return false;
  value = v;
  return true;
}

std::string number_text(double value) {
  char buffer[32];
  const auto [end, error] = std::to_chars(buffer, buffer + sizeof buffer, value);
  return error == std::errc() ? std::string(buffer, end) : std::string();
}

void throw_unknown_key(const std::string& method, const std::string& key,
                       const std::vector<Parameter>& valid) {
  std::string list;
  for (const Parameter& p : valid) list += (list.empty() ? "" : ", ") + p.key;
  throw InputError(method + " has no parameter '" + key + "'",
                   valid.empty() ? "it has none" : "valid parameters: " + list);
}

void throw_wrong_value(const std::string& method, const Parameter& parameter, const std::string& value) {
  const std::string kind = parameter.type == "choice"    ? "one of "
                           : parameter.type == "integer" ? "an integer in "
                                                         : "a " + parameter.type + " in ";
  throw InputError(method + ": '" + value + "' is not a value of '" + parameter.key + "'",
                   "give " + kind + parameter.range);
}

SettingsMap effective_settings(const MethodInfo& method, const SettingsMap& settings) {
  method.make(settings);
  SettingsMap all;
  for (const Parameter& p : method.parameters) all[p.key] = p.default_text;
  for (const auto& [key, value] : settings) all[key] = value;
  return all;
}

}  // namespace lumirank::methods
