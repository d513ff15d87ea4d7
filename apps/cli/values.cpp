#include "values.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <sstream>

#include "lumirank/error.h"

namespace lumirank::cli {
namespace {

std::string plain_text(double value) {
  std::ostringstream out;
  out.precision(12);
  out << value;
  return out.str();
}

template <typename T>
CLI::Option* add_any_count(CLI::App& command, const std::string& option, T& value, int low, int high,
                           const std::string& help) {
  return command
      .add_option_function<std::string>(
          option,
          [&value, option, low, high](const std::string& t) { value = read_count(option, t, low, high); },
          help)
      ->type_name("N");
}

}  // namespace

double read_number(const std::string& option, const std::string& text, const Bounds& bounds) {
  double value = 0;
  const auto [end, status] = std::from_chars(text.data(), text.data() + text.size(), value);
  const std::string unit = *bounds.unit ? std::string(" ") + bounds.unit : "";
  const std::string range =
      (bounds.open ? "above " : "from ") + plain_text(bounds.low) + " to " + plain_text(bounds.high) + unit;
  if (status != std::errc{} || end != text.data() + text.size() || !std::isfinite(value))
    throw InputError("'" + text + "' is not a number for " + option, "give one " + range);
  if (value < bounds.low || value > bounds.high || (bounds.open && value == bounds.low))
    throw InputError(option + " is " + text, "give a number " + range);
  return value;
}

int read_count(const std::string& option, const std::string& text, int low, int high) {
  int value = 0;
  const auto [end, status] = std::from_chars(text.data(), text.data() + text.size(), value);
  const std::string range = "from " + std::to_string(low) + " to " + std::to_string(high);
  if (status == std::errc::invalid_argument || end != text.data() + text.size())
    throw InputError("'" + text + "' is not a whole number for " + option, "give one " + range);
  if (status != std::errc{} || value < low || value > high)
    throw InputError(option + " is " + text, "give a whole number " + range);
  return value;
}

namespace {

template <typename Value>
CLI::Option* add_any_number(CLI::App& command, const std::string& option, Value& value, const Bounds& bounds,
                            const std::string& help) {
  return command
      .add_option_function<std::string>(
          option, [&value, option, bounds](const std::string& t) { value = read_number(option, t, bounds); },
          help)
      ->type_name("NUMBER");
}

}  // namespace

CLI::Option* add_number(CLI::App& command, const std::string& option, double& value, const Bounds& bounds,
                        const std::string& help) {
  return add_any_number(command, option, value, bounds, help);
}
CLI::Option* add_number(CLI::App& command, const std::string& option, std::optional<double>& value,
                        const Bounds& bounds, const std::string& help) {
  return add_any_number(command, option, value, bounds, help);
}

CLI::Option* add_count(CLI::App& command, const std::string& option, int& value, int low, int high,
                       const std::string& help) {
  return add_any_count(command, option, value, low, high, help);
}
CLI::Option* add_count(CLI::App& command, const std::string& option, std::optional<int>& value, int low,
                       int high, const std::string& help) {
  return add_any_count(command, option, value, low, high, help);
}

CLI::Option* add_choice(CLI::App& command, const std::string& option,
                        const std::function<void(const std::string&)>& take,
                        const std::vector<std::string>& choices, const std::string& help) {
  return command.add_option_function<std::string>(
      option,
      [take, option, choices](const std::string& text) {
        std::string list;
        for (const auto& choice : choices) list += (list.empty() ? "" : ", ") + choice;
        if (std::find(choices.begin(), choices.end(), text) == choices.end())
          throw InputError("'" + text + "' is not a value of " + option, "choose one of " + list);
        take(text);
      },
      help);
}

std::vector<std::string> read_list(const std::string& option, const std::string& text) {
  std::vector<std::string> parts;
  std::size_t begin = 0;
  while (begin <= text.size()) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    parts.push_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  if (std::ranges::any_of(parts, [](const std::string& part) { return part.empty(); }))
    throw InputError("'" + text + "' of " + option + " has an empty part",
                     "separate its parts by single commas");
  return parts;
}

}  // namespace lumirank::cli
