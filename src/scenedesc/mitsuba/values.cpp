#include "scenedesc/mitsuba/values.h"

#include <charconv>
#include <cmath>

namespace lumirank::scenedesc::mitsuba {

namespace {

std::string trim(const std::string& text) {
  const auto first = text.find_first_not_of(" \t\r\n");
  if (first == std::string::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t\r\n") - first + 1);
}

// At most 60 characters of what the file says, for messages.
std::string quoted(const std::string& text) {
  return "\"" + (text.size() > 60 ? text.substr(0, 60) + "…" : text) + "\"";
}

[[noreturn]] void not_a(const char* kind, const std::string& text, const SourceLocation& where,
                        const std::string& what) {
  throw InputError(where, what + " is " + quoted(text) + ", which is not " + kind);
}

double vec_part(const Element& element, const char* name, double fallback) {
  const std::string* text = element.find(name);
  return text ? parse_double(*text, element.where, std::string(name) + " of <" + element.tag + ">")
              : fallback;
}

bool has_xyz(const Element& e) { return e.find("x") || e.find("y") || e.find("z"); }

Vec3d list_vec3(const Element& element, const char* attribute) {
  const std::string what = std::string(attribute) + " of <" + element.tag + ">";
  const auto list = parse_list(element.require(attribute), element.where, what);
  if (list.size() != 3)
    throw InputError(element.where, what + " has " + std::to_string(list.size()) + " numbers; 3 are needed");
  return {list[0], list[1], list[2]};
}

Transform parse_matrix(const Element& element) {
  const auto list = parse_list(element.require("value"), element.where, "value of <matrix>");
  Transform t;
  if (list.size() == 16) {
    for (int i = 0; i < 16; ++i) t.m[static_cast<std::size_t>(i)] = list[static_cast<std::size_t>(i)];
  } else if (list.size() == 9) {
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t j = 0; j < 3; ++j) t.m[4 * i + j] = list[3 * i + j];
  } else {
    throw InputError(element.where,
                     "<matrix> has " + std::to_string(list.size()) + " numbers; 16 (or 9) are needed");
  }
  return t;
}

Transform parse_look_at(const Element& element) {
  const Vec3d origin = list_vec3(element, "origin"), target = list_vec3(element, "target");
  const Vec3f up = element.find("up") ? static_cast<Vec3f>(list_vec3(element, "up")) : Vec3f{0, 1, 0};
  if (origin == target)
    throw InputError(element.where, "origin and target of <" + element.tag + "> are the same point");
  const auto forward = static_cast<Vec3f>(Transform::look_at(origin, target, up).axis(2));
  if (!(length(up) > 0) || !(length(cross(forward, normalize(up))) > 1e-6f))
    throw InputError(element.where, "up of <" + element.tag + "> is parallel to the line of sight",
                     "choose another up");
  return Transform::look_at(origin, target, up);
}

Transform parse_step(const Element& e) {
  if (e.tag == "matrix") return parse_matrix(e);
  if (e.tag == "lookat" || e.tag == "lookAt" || e.tag == "look_at") return parse_look_at(e);
  if (e.tag == "translate") {
    const Vec3d v = parse_vec3(e);
    if (!e.find("value"))
      return Transform::translate(vec_part(e, "x", 0), vec_part(e, "y", 0), vec_part(e, "z", 0));
    return Transform::translate(v.x, v.y, v.z);
  }
  if (e.tag == "scale") {
    double x = vec_part(e, "x", 1), y = vec_part(e, "y", 1), z = vec_part(e, "z", 1);
    if (const std::string* value = e.find("value")) {
      const auto list = parse_list(*value, e.where, "value of <scale>");
      if (list.size() != 1 && list.size() != 3)
        throw InputError(
            e.where, "value of <scale> has " + std::to_string(list.size()) + " numbers; 1 or 3 are needed");
      x = list[0], y = list.size() == 3 ? list[1] : x, z = list.size() == 3 ? list[2] : x;
    } else if (!has_xyz(e)) {
      throw InputError(e.where, "<scale> has neither \"value\" nor x, y, z");
    }
    return Transform::scale(x, y, z);
  }
  if (e.tag == "rotate") {
    const auto axis = static_cast<Vec3f>(parse_vec3(e));
    if (!(length(axis) > 0)) throw InputError(e.where, "the axis of <rotate> is zero", "write y=\"1\", say");
    return Transform::rotate(axis.x, axis.y, axis.z,
                             parse_double(e.require("angle"), e.where, "angle of <rotate>"));
  }
  throw InputError(e.where, "<" + e.tag + "> is not a part of a <transform>",
                   "translate, scale, rotate, lookat and matrix are");
}

}  // namespace

double parse_double(const std::string& text, const SourceLocation& where, const std::string& what) {
  const std::string body = trim(text);
  const char *p = body.data(), *end = p + body.size();
  if (p != end && *p == '+') ++p;
  double value = 0;
  const auto [stop, error] = std::from_chars(p, end, value);
  if (p == end || stop != end || error == std::errc::invalid_argument) not_a("a number", text, where, what);
  if (error == std::errc::result_out_of_range) {
    // Too small is as good as zero; too large is not a number that can be used.
    const bool tiny = body.find("e-") != std::string::npos || body.find("E-") != std::string::npos;
    if (tiny) return 0;
    not_a("a finite number", text, where, what);
  }
  if (!std::isfinite(value) || std::abs(value) > 3.4e38) not_a("a finite number", text, where, what);
  return value;
}

float parse_float(const std::string& text, const SourceLocation& where, const std::string& what) {
  return static_cast<float>(parse_double(text, where, what));
}

int parse_int(const std::string& text, const SourceLocation& where, const std::string& what) {
  const std::string body = trim(text);
  const char *p = body.data(), *end = p + body.size();
  if (p != end && *p == '+') ++p;
  int value = 0;
  const auto [stop, error] = std::from_chars(p, end, value);
  if (p == end || stop != end || error != std::errc())
    not_a("a whole number (of at most 9 digits)", text, where, what);
  return value;
}

bool parse_bool(const std::string& text, const SourceLocation& where, const std::string& what) {
  const std::string body = trim(text);
  if (body == "true" || body == "True" || body == "1") return true;
  if (body == "false" || body == "False" || body == "0") return false;
  not_a("true or false", text, where, what);
}

std::vector<double> parse_list(const std::string& text, const SourceLocation& where,
                               const std::string& what) {
  std::vector<double> list;
  constexpr const char* kSeparators = ", \t\r\n";
  for (std::size_t i = text.find_first_not_of(kSeparators); i != std::string::npos;) {
    const std::size_t end = text.find_first_of(kSeparators, i);
    list.push_back(parse_double(text.substr(i, end == std::string::npos ? end : end - i), where, what));
    i = end == std::string::npos ? end : text.find_first_not_of(kSeparators, end);
  }
  if (list.empty()) not_a("a list of numbers", text, where, what);
  return list;
}

Vec3d parse_vec3(const Element& element) {
  if (element.find("value")) return list_vec3(element, "value");
  if (!has_xyz(element))
    throw InputError(element.where, "<" + element.tag + "> has neither x, y, z nor \"value\"");
  return {vec_part(element, "x", 0), vec_part(element, "y", 0), vec_part(element, "z", 0)};
}

Transform parse_transform(const Element& element) {
  Transform t;
  for (const auto& child : element.children) t = parse_step(*child) * t;
  if (!t.is_finite()) throw InputError(element.where, "the <transform> overflows", "use smaller factors");
  return t;
}

}  // namespace lumirank::scenedesc::mitsuba
