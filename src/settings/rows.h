// Row of the table of render settings: its field with the functions that read it from text and write it, from
// a member of RenderSettings.
#pragma once

#include <charconv>
#include <cmath>
#include <functional>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include "lumirank/error.h"
#include "lumirank/settings.h"

namespace lumirank::settings {

struct Row {
  Field field;
  std::function<void(RenderSettings&, const std::string&)> set;
  std::function<std::string(const RenderSettings&)> get;
};

// InputError that names the key if the text is not a finite number, or not a whole one where T is integral.
template <typename T>
T parse_number(const std::string& key, const std::string& text) {
  T value{};
  const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), value);
  bool ok = code == std::errc{} && end == text.data() + text.size();
  if constexpr (std::is_floating_point_v<T>) ok = ok && std::isfinite(value);
  if (!ok)
    throw InputError("'" + text + "' is not a valid number for '" + key + "'",
                     std::is_integral_v<T> ? "give a whole number, in digits only" : "");
  return value;
}

// The shortest text that reads as the same number.
std::string format_number(double v);

// With its empty parts: 800xx600 is not a size.
std::vector<std::string> split_settings(const std::string& text, char separator);

// The names of an enumeration's values, in their order.
template <typename E>
struct EnumNames;
template <>
struct EnumNames<LightPart> {
  static constexpr const char* names[] = {"all", "direct", "indirect"};
};
template <>
struct EnumNames<LightType> {
  static constexpr const char* names[] = {"point", "diffuse-point", "sphere"};
};
template <>
struct EnumNames<LightPlacement> {
  static constexpr const char* names[] = {"auto", "particles", "gather"};
};
template <>
struct EnumNames<SphereIndicator> {
  static constexpr const char* names[] = {"disc", "cosine"};
};
template <>
struct EnumNames<SphereStrategies> {
  static constexpr const char* names[] = {"all", "cone"};
};
template <>
struct EnumNames<SphereSamples> {
  static constexpr const char* names[] = {"overlap", "cone"};
};
template <>
struct EnumNames<DirectLight> {
  static constexpr const char* names[] = {"auto", "matrix", "traced"};
};
template <>
struct EnumNames<RestOfPaths> {
  static constexpr const char* names[] = {"auto", "skip", "trace"};
};
template <>
struct EnumNames<Panes> {
  static constexpr const char* names[] = {"straight", "exact"};
};
template <>
struct EnumNames<Denoise> {
  static constexpr const char* names[] = {"auto", "on", "off"};
};
template <>
struct EnumNames<ErrorMetric> {
  static constexpr const char* names[] = {"l1", "relmse", "flip"};
};
template <>
struct EnumNames<ReferencePaths> {
  static constexpr const char* names[] = {"all", "columns", "rest"};
};
template <>
struct EnumNames<ToneMap> {
  static constexpr const char* names[] = {"none", "reinhard", "agx"};
};

template <typename E>
std::string names_of() {
  std::string all;
  for (const char* name : EnumNames<E>::names) all += (all.empty() ? "" : "|") + std::string(name);
  return all;
}

template <typename E>
E parse_enum(const std::string& key, const std::string& text) {
  int value = 0;
  for (const char* name : EnumNames<E>::names) {
    if (text == name) return static_cast<E>(value);
    ++value;
  }
  throw InputError("'" + text + "' is not a value of '" + key + "'", "choose one of " + names_of<E>());
}

// Members of the groups: `at(settings)` is the value itself.
template <auto Group, auto Member>
struct At {
  auto& operator()(RenderSettings& s) const { return s.*Group.*Member; }
  const auto& operator()(const RenderSettings& s) const { return s.*Group.*Member; }
};
template <auto Member>
struct Top {
  auto& operator()(RenderSettings& s) const { return s.*Member; }
  const auto& operator()(const RenderSettings& s) const { return s.*Member; }
};

template <typename T>
struct Value {
  using type = T;
};
template <typename T>
struct Value<std::optional<T>> {
  using type = T;
};

// An optional number that is not set reads as its default, and is left unset by a default that is not given.
template <typename Place>
Row number(Field field, Place at, double low, double high) {
  using Held = std::remove_cvref_t<decltype(at(std::declval<RenderSettings&>()))>;
  using T = typename Value<Held>::type;
  const std::string key = field.key;
  field.type = std::is_floating_point_v<T> ? "number" : "integer";
  const T fallback = parse_number<T>(key, field.default_text);
  return {field,
          [=](RenderSettings& s, const std::string& text) {
            const T value = parse_number<T>(key, text);
            if (static_cast<double>(value) < low || static_cast<double>(value) > high)
              throw InputError("'" + key + "' is " + text + "; it must lie in " + field.range);
            at(s) = value;
          },
          [=](const RenderSettings& s) {
            T value = fallback;
            if constexpr (std::is_same_v<Held, T>)
              value = at(s);
            else
              value = at(s).value_or(fallback);
            if constexpr (std::is_floating_point_v<T>)
              return format_number(value);
            else
              return std::to_string(value);
          }};
}

template <typename Place>
Row choice(Field field, Place at) {
  using E = std::remove_cvref_t<decltype(at(std::declval<RenderSettings&>()))>;
  field.type = "choice";
  field.range = names_of<E>();
  const std::string key = field.key;
  return {field, [=](RenderSettings& s, const std::string& text) { at(s) = parse_enum<E>(key, text); },
          [=](const RenderSettings& s) {
            return std::string(EnumNames<E>::names[static_cast<std::size_t>(at(s))]);
          }};
}

template <typename Place>
Row text_field(Field field, Place at) {
  field.type = "text";
  return {field, [=](RenderSettings& s, const std::string& text) { at(s) = text; },
          [=](const RenderSettings& s) { return at(s); }};
}

}  // namespace lumirank::settings
