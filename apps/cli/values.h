// Options that are numbers: the whole text in decimal digits, finite and within bounds, or an InputError that
// names the option. (CLI11 itself reads 0x10 and nan.) And choices and lists.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace lumirank::cli {

struct Bounds {
  double low = 0, high = 0;
  bool open = false;  // low itself is too low
  const char* unit = "";
};

double read_number(const std::string& option, const std::string& text, const Bounds& bounds);
int read_count(const std::string& option, const std::string& text, int low, int high);

CLI::Option* add_number(CLI::App& command, const std::string& option, double& value, const Bounds& bounds,
                        const std::string& help);
CLI::Option* add_number(CLI::App& command, const std::string& option, std::optional<double>& value,
                        const Bounds& bounds, const std::string& help);
CLI::Option* add_count(CLI::App& command, const std::string& option, int& value, int low, int high,
                       const std::string& help);
CLI::Option* add_count(CLI::App& command, const std::string& option, std::optional<int>& value, int low,
                       int high, const std::string& help);

// `take` gets one of the choices.
CLI::Option* add_choice(CLI::App& command, const std::string& option,
                        const std::function<void(const std::string&)>& take,
                        const std::vector<std::string>& choices, const std::string& help);

// "a,b,c" with no empty part, or an InputError that names the option.
std::vector<std::string> read_list(const std::string& option, const std::string& text);

}  // namespace lumirank::cli
