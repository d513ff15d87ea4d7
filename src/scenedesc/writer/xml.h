// XML text, element by element. Internal to this folder.
#pragma once

#include <cstdio>
#include <string>
#include <utility>
#include <vector>

#include "base/rgb.h"
#include "base/transform.h"
#include "base/vec.h"

namespace lumirank::scenedesc {

// Digits that give the same number when they are read again.
inline std::string digits(float x) {
  char text[32];
  std::snprintf(text, sizeof text, "%.9g", static_cast<double>(x));
  return text;
}
inline std::string digits(double x) {
  char text[40];
  std::snprintf(text, sizeof text, "%.17g", x);
  return text;
}
inline std::string digits(Rgb c) { return digits(c.r) + ", " + digits(c.g) + ", " + digits(c.b); }

class Xml {
 public:
  using Attributes = std::vector<std::pair<const char*, std::string>>;

  void open(const char* tag, const Attributes& attributes) {
    start(tag, attributes), text_ += ">\n";
    open_.push_back(tag);
  }
  void close() {
    const std::string tag = open_.back();
    open_.pop_back();
    text_ += std::string(2 * open_.size(), ' ') + "</" + tag + ">\n";
  }
  void leaf(const char* tag, const Attributes& attributes) { start(tag, attributes), text_ += "/>\n"; }

  void number(const char* name, float value) { leaf("float", {{"name", name}, {"value", digits(value)}}); }
  void integer(const char* name, int value) {
    leaf("integer", {{"name", name}, {"value", std::to_string(value)}});
  }
  void flag(const char* name, bool value) {
    leaf("boolean", {{"name", name}, {"value", value ? "true" : "false"}});
  }
  void string(const char* name, const std::string& value) {
    leaf("string", {{"name", name}, {"value", value}});
  }
  void color(const char* name, Rgb value) { leaf("rgb", {{"name", name}, {"value", digits(value)}}); }
  void place(const char* tag, const char* name, Vec3f v) {
    leaf(tag, {{"name", name}, {"x", digits(v.x)}, {"y", digits(v.y)}, {"z", digits(v.z)}});
  }
  void place(const char* tag, const char* name, Vec3d v) {
    leaf(tag, {{"name", name}, {"x", digits(v.x)}, {"y", digits(v.y)}, {"z", digits(v.z)}});
  }
  void reference(const std::string& id, const char* name = nullptr) {
    if (name)
      leaf("ref", {{"name", name}, {"id", id}});
    else
      leaf("ref", {{"id", id}});
  }
  void transform(const char* name, const Transform& t) {
    if (t.is_identity()) return;
    std::string values;
    for (const double x : t.m) values += (values.empty() ? "" : " ") + digits(x);
    open("transform", {{"name", name}});
    leaf("matrix", {{"value", values}});
    close();
  }
  std::string take() { return std::move(text_); }

 private:
  static std::string escaped(const std::string& s) {
    std::string out;
    for (const char c : s) {
      if (c == '&')
        out += "&amp;";
      else if (c == '<')
        out += "&lt;";
      else if (c == '>')
        out += "&gt;";
      else if (c == '"')
        out += "&quot;";
      else if (static_cast<unsigned char>(c) < ' ')
        out += "&#" + std::to_string(static_cast<int>(c)) + ";";
      else
        out += c;
    }
    return out;
  }
  void start(const char* tag, const Attributes& attributes) {
    text_ += std::string(2 * open_.size(), ' ') + "<" + tag;
    for (const auto& [name, value] : attributes)
      text_ += std::string(" ") + name + "=\"" + escaped(value) + "\"";
  }

  std::string text_;
  std::vector<std::string> open_;
};

}  // namespace lumirank::scenedesc
