// A method's settings struct described field by field, so that the command line, JSON and the documentation
// share one truth.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "methods/method.h"

namespace lumirank::methods {

using SettingsMap = std::map<std::string, std::string>;

template <typename S>
struct Field {
  Parameter info;
  std::function<bool(S&, const std::string&)> set;  // false: not a value of this field
};
template <typename S>
using Fields = std::vector<Field<S>>;

struct FieldText {
  std::string key, unit, help;
};

// Text → number, whole text or nothing.
bool parse_count(const std::string& text, std::size_t min_value, std::size_t max_value, std::size_t& value);
bool parse_number(const std::string& text, double min_value, double max_value, double& value);
std::string number_text(double value);

// Highest counts of columns and of receivers: more than any scene has, and memory for them can be had. Where
// a number of something is kept for each of these, its highest is much lower.
inline constexpr std::size_t kMaxColumns = 10'000'000, kMaxRows = 1'000'000;

// `member` may belong to a base of S.
template <typename S, typename B>
Field<S> count_field(FieldText text, std::size_t B::*member, std::size_t min_value, std::size_t max_value) {
  return {{text.key, "integer", std::to_string(S{}.*member),
           std::to_string(min_value) + " … " + std::to_string(max_value), text.unit, text.help},
          [=](S& s, const std::string& v) { return parse_count(v, min_value, max_value, s.*member); }};
}

template <typename S, typename B>
Field<S> number_field(FieldText text, double B::*member, double min_value, double max_value) {
  return {{text.key, "number", number_text(S{}.*member),
           number_text(min_value) + " … " + number_text(max_value), text.unit, text.help},
          [=](S& s, const std::string& v) { return parse_number(v, min_value, max_value, s.*member); }};
}

// choices: name of every value of the enumeration, in its order from 0.
template <typename S, typename B, typename E>
Field<S> choice_field(FieldText text, E B::*member, std::vector<std::string> choices) {
  std::string range;
  for (const auto& c : choices) range += (range.empty() ? "" : "|") + c;
  return {{text.key, "choice", choices[static_cast<std::size_t>(S{}.*member)], range, text.unit, text.help},
          [=](S& s, const std::string& v) {
            for (std::size_t k = 0; k < choices.size(); ++k)
              if (choices[k] == v) {
                s.*member = static_cast<E>(k);
                return true;
              }
            return false;
          }};
}

// The same for experiments only (Parameter::experiment).
template <typename S>
Field<S> experiment(Field<S> field) {
  field.info.experiment = true;
  return field;
}

// The same for settings S that are a B and more.
template <typename S, typename B>
Fields<S> inherited_fields(const Fields<B>& base) {
  Fields<S> fields;
  for (const auto& field : base)
    fields.push_back({field.info, [set = field.set](S& s, const std::string& v) { return set(s, v); }});
  return fields;
}

template <typename S>
std::vector<Parameter> parameters_of(const Fields<S>& fields) {
  std::vector<Parameter> p;
  for (const auto& f : fields) p.push_back(f.info);
  return p;
}

[[noreturn]] void throw_unknown_key(const std::string& method, const std::string& key,
                                    const std::vector<Parameter>& valid);
[[noreturn]] void throw_wrong_value(const std::string& method, const Parameter& parameter,
                                    const std::string& value);

// Defaults overwritten by `settings`. Unknown keys and values out of range throw InputError.
template <typename S>
S read_settings(const std::string& method, const Fields<S>& fields, const SettingsMap& settings) {
  S s;
  for (const auto& [key, value] : settings) {
    const Field<S>* found = nullptr;
    for (const auto& f : fields)
      if (f.info.key == key) found = &f;
    if (!found) throw_unknown_key(method, key, parameters_of(fields));
    if (!found->set(s, value)) throw_wrong_value(method, found->info, value);
  }
  return s;
}

struct MethodText {
  std::string name, summary;
  std::string paper = "";
  std::string error_parameters = "";  // as in MethodInfo
  matrix::MethodContract contract{};  // as in MethodInfo
};

// The entry of a method M whose constructor takes its settings S, and which uses all generated lights.
template <typename M, typename S>
MethodInfo method_info(const MethodText& text, const Fields<S>& fields) {
  return {text.name,
          text.summary,
          text.paper,
          parameters_of(fields),
          [name = text.name, fields](const SettingsMap& settings) -> std::unique_ptr<Method> {
            return std::make_unique<M>(read_settings(name, fields, settings));
          },
          [](const SettingsMap&) -> std::size_t { return 0; },
          text.error_parameters,
          text.contract};
}

// Every parameter of the method with the value that a run with these settings uses: what a report records.
// Throws InputError as `make` does.
SettingsMap effective_settings(const MethodInfo& method, const SettingsMap& settings);

}  // namespace lumirank::methods
