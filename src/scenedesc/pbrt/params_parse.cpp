// From words to typed parameters.
#include <algorithm>
#include <charconv>
#include <cmath>

#include "scenedesc/pbrt/params.h"

namespace lumirank::scenedesc::pbrt {

namespace {

struct TypeInfo {
  std::string_view name;
  ParamType type;
  std::size_t size;  // numbers of one value
};
constexpr TypeInfo kTypes[] = {{"float", ParamType::number, 1},      {"integer", ParamType::integer, 1},
                               {"point3", ParamType::point3, 3},     {"point2", ParamType::point2, 2},
                               {"rgb", ParamType::rgb, 3},           {"string", ParamType::text, 0},
                               {"bool", ParamType::flag, 0},         {"texture", ParamType::texture, 0},
                               {"spectrum", ParamType::spectrum, 2}, {"blackbody", ParamType::blackbody, 1},
                               {"normal", ParamType::point3, 3},     {"vector3", ParamType::point3, 3},
                               {"vector2", ParamType::point2, 2},    {"normal3", ParamType::point3, 3},
                               {"point", ParamType::point3, 3},      {"vector", ParamType::point3, 3}};

// Only pbrt-v3 has these names of types.
constexpr TypeInfo kOldTypes[] = {{"color", ParamType::rgb, 3}, {"xyz", ParamType::rgb, 3}};

const TypeInfo& type_of(std::string_view name, const SourceLocation& where, bool version3) {
  for (const TypeInfo& type : kTypes)
    if (type.name == name) return type;
  for (const TypeInfo& type : kOldTypes)
    if (version3 && type.name == name) return type;
  const bool old = name == "color" || name == "xyz";
  throw InputError(where, "the parameter type " + in_quotes(name) + " is not known",
                   old ? "pbrt-v4 calls it \"rgb\""
                       : "float, integer, bool, string, point2, point3, vector2, vector3, normal, rgb, "
                         "spectrum, blackbody and texture are");
}

// From CIE XYZ to linear Rec. 709, color by color.
void to_rgb(std::vector<double>& numbers) {
  for (std::size_t i = 0; i + 2 < numbers.size(); i += 3) {
    const double x = numbers[i], y = numbers[i + 1], z = numbers[i + 2];
    numbers[i] = std::max(0.0, 3.240479 * x - 1.537150 * y - 0.498535 * z);
    numbers[i + 1] = std::max(0.0, -0.969256 * x + 1.875991 * y + 0.041556 * z);
    numbers[i + 2] = std::max(0.0, 0.055648 * x - 0.204043 * y + 1.057311 * z);
  }
}

class ValueReader {
 public:
  ValueReader(Tokens& tokens, Parameter& out, const TypeInfo& type, bool version3)
      : tokens_(tokens), out_(out), type_(type), version3_(version3) {}

  void read() {
    if (tokens_.peek().kind != Token::Kind::open) {
      value(tokens_.take());
    } else {
      tokens_.take();
      while (tokens_.peek().kind != Token::Kind::close) {
        const Token token = tokens_.take();
        if (token.kind == Token::Kind::end)
          throw InputError(out_.where, "the list of " + in_quotes(out_.name) + " has no end",
                           "close it with a ]; is the file complete?");
        value(token);
      }
      tokens_.take();
    }
    check_count();
  }

 private:
  [[noreturn]] void wrong(const Token& token, const char* needed) const {
    const std::string value = token.kind == Token::Kind::open    ? "a ["
                              : token.kind == Token::Kind::close ? "a ]"
                              : token.kind == Token::Kind::end   ? "the end of the file"
                              : token.kind == Token::Kind::text  ? "the string " + in_quotes(token.value)
                                                                 : in_quotes(token.value);
    throw InputError(
        tokens_.place(token),
        value + " for the " + out_.type_name + " " + in_quotes(out_.name) + ", which needs " + needed,
        token.kind == Token::Kind::text && type_.type == ParamType::flag
            ? "write true or false without quotes"
            : "");
  }

  void value(const Token& token) {
    switch (type_.type) {
      case ParamType::text:
      case ParamType::texture:
        if (token.kind != Token::Kind::text) wrong(token, "a string in quotes");
        out_.texts.emplace_back(token.value);
        return;
      case ParamType::flag:
        if ((token.kind != Token::Kind::word && !(version3_ && token.kind == Token::Kind::text)) ||
            (token.value != "true" && token.value != "false"))
          wrong(token, "true or false");
        out_.flags.push_back(token.value == "true");
        return;
      case ParamType::spectrum:
        if (token.kind == Token::Kind::text) {
          out_.texts.emplace_back(token.value);
          return;
        }
        break;
      default:
        break;
    }
    if (token.kind != Token::Kind::word) wrong(token, "numbers");
    const double number = parse_number(token.value, tokens_.place(token));
    if (type_.type == ParamType::integer && (number != std::floor(number) || std::abs(number) > 2147483647.0))
      wrong(token, "whole numbers of at most 32 bits");
    out_.numbers.push_back(number);
  }

  void check_count() const {
    const std::size_t count = out_.numbers.size(), all = count + out_.texts.size() + out_.flags.size();
    const std::string title = "the " + out_.type_name + " " + in_quotes(out_.name);
    // An empty list is as good as none; empty meshes are found where they are made.
    if (all == 0) return;
    if (out_.type == ParamType::spectrum && !out_.texts.empty() && (count > 0 || out_.texts.size() > 1))
      throw InputError(out_.where, title + " mixes names and numbers",
                       "give one name, or pairs of wavelength and value");
    if (type_.size > 1 && count % type_.size != 0)
      throw InputError(out_.where, title + " has " + std::to_string(count) +
                                       (count == 1 ? " number" : " numbers") + ", which is no multiple of " +
                                       std::to_string(type_.size));
  }

  Tokens& tokens_;
  Parameter& out_;
  const TypeInfo& type_;
  const bool version3_;
};

}  // namespace

double parse_number(std::string_view word, const SourceLocation& where) {
  const char *p = word.data(), *end = p + word.size();
  if (p != end && *p == '+') ++p;
  double value = 0;
  const auto [stop, error] = std::from_chars(p, end, value);
  if (p == end || stop != end || error == std::errc::invalid_argument)
    throw InputError(where, in_quotes(word) + " is not a number");
  if (error == std::errc::result_out_of_range) {
    // Too small is as good as zero.
    if (word.find("e-") != std::string_view::npos || word.find("E-") != std::string_view::npos) return 0;
    value = HUGE_VAL;
  }
  if (!std::isfinite(value) || std::abs(value) > 3.4e38)
    throw InputError(where, in_quotes(word) + " is not a finite number that a float can hold");
  return value;
}

std::vector<Parameter> parse_parameters(Tokens& tokens, bool version3) {
  std::vector<Parameter> out;
  while (tokens.peek().kind == Token::Kind::text) {
    const Token declaration = tokens.take();
    const std::string_view text = declaration.value;
    const Place where = tokens.place(declaration);
    constexpr const char* kSpace = " \t";
    const std::size_t type_at = text.find_first_not_of(kSpace);
    const std::size_t type_end = text.find_first_of(kSpace, std::min(type_at, text.size()));
    const std::size_t name_at = text.find_first_not_of(kSpace, std::min(type_end, text.size()));
    const std::size_t name_end =
        std::min(text.find_first_of(kSpace, std::min(name_at, text.size())), text.size());
    if (name_at == std::string_view::npos ||
        text.find_first_not_of(kSpace, name_end) != std::string_view::npos)
      throw InputError(where, in_quotes(text) + " is not the declaration of a parameter",
                       "write a type and a name, as in \"float radius\"");
    const TypeInfo& type = type_of(text.substr(type_at, type_end - type_at), where, version3);
    Parameter& parameter = out.emplace_back();
    parameter.type = type.type;
    parameter.type_name = type.name;
    parameter.name = text.substr(name_at, name_end - name_at);
    parameter.where = where;
    ValueReader(tokens, parameter, type, version3).read();
    if (type.name == "xyz") to_rgb(parameter.numbers);
  }
  return out;
}

}  // namespace lumirank::scenedesc::pbrt
