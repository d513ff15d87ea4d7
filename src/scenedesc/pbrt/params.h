// Parameter lists: "type name" followed by values. Checked against their types when read, looked up by name,
// and what nobody asked for is warned about.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/rgb.h"
#include "base/vec.h"
#include "scenedesc/pbrt/tokens.h"

namespace lumirank::scenedesc::pbrt {

class Reader;

enum class ParamType { number, integer, point2, point3, rgb, blackbody, spectrum, text, texture, flag };

struct Parameter {
  ParamType type = ParamType::number;
  std::string type_name, name;
  Place where;
  std::vector<double> numbers;  // finite; a multiple of the type's size
  std::vector<std::string> texts;
  std::vector<bool> flags;
};

// All declarations up to the next directive. Throws InputError for what is not a declaration, a value of
// another type than declared and a wrong number of values.
// `version3`: of pbrt-v3, which has "color" and "xyz", and quotes flags.
std::vector<Parameter> parse_parameters(Tokens& tokens, bool version3);

// The number that a whole word is, finite; an InputError at `where` else.
double parse_number(std::string_view word, const SourceLocation& where);

// The parameters of one directive, above those that Attribute directives gave to its kind.
class Params {
 public:
  Params(Reader& reader, std::string title, Place where, std::vector<Parameter> own,
         const std::vector<Parameter>* inherited = nullptr);

  Reader& reader() { return reader_; }
  const std::string& title() const { return title_; }  // Shape "sphere", for messages
  const Place& where() const { return where_; }
  bool has(std::string_view name) const { return peek(name) != nullptr; }
  Place where_of(std::string_view name) const;

  // Null if it is not there; it counts as used then.
  const Parameter* find(const char* name);
  bool is_texture(std::string_view name) const;

  // One value each; another type is an InputError.
  float number(const char* name, float fallback);
  float positive(const char* name, float fallback);  // above 0
  int integer(const char* name, int fallback);
  bool flag(const char* name, bool fallback);
  std::string text(const char* name, const std::string& fallback);
  std::string required_text(const char* name);
  Vec3d point3(const char* name, Vec3d fallback);
  // Lists; empty if there is none.
  const std::vector<double>& numbers(const char* name, ParamType type);
  std::vector<Vec3f> points3(const char* name);
  std::vector<Vec3d> places3(const char* name);  // not rounded
  std::vector<Vec2f> points2(const char* name);
  std::vector<std::string> texts(const char* name);

  // For what has another name in another version: the parameter's own, not those by Attribute.
  void rename(std::string_view from, std::string_view to);
  void drop(std::string_view name);
  void add_number(const char* name, float value);
  void add_text(const char* name, const std::string& value);
  void replace_text(const char* name, const std::string& value);

  void ignore(std::initializer_list<const char*> names);  // known, and of no consequence here
  void ignore_all();
  // Warns about everything that was not asked for.
  void finish();

  [[noreturn]] void fail(const char* name, const std::string& message, const std::string& remedy = {}) const;

 private:
  const Parameter* peek(std::string_view name) const;
  const Parameter* find(const char* name, ParamType type);

  Reader& reader_;
  std::string title_;
  Place where_;
  std::vector<Parameter> own_;
  std::vector<bool> used_;
  const std::vector<Parameter>* inherited_;
  std::vector<const char*> asked_;
};

}  // namespace lumirank::scenedesc::pbrt
