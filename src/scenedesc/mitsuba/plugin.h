// One <bsdf type="…">, <shape type="…"> …: its properties by name, and a record of which were asked for, so
// that what Lumirank does not know is named in a warning instead of being passed over.
#pragma once

#include <initializer_list>
#include <optional>
#include <set>
#include <string>
#include <variant>
#include <vector>

#include "scenedesc/mitsuba/reader.h"

namespace lumirank::scenedesc::mitsuba {

class Plugin {
 public:
  Plugin(Reader& reader, const Element& element);

  const std::string& type() const { return type_; }
  const std::string& id() const { return id_; }
  const SourceLocation& where() const { return element_.where; }
  // "<bsdf type=\"diffuse\">"
  std::string title() const;

  bool has(const std::string& name) const;
  bool has_object(const std::string& tag) const;
  bool names_object(const std::string& name, const std::string& tag) const;
  SourceLocation where_of(
      const std::string& name) const;  // of the property, or of the plugin if there is none

  std::optional<float> number(const std::string& name);
  float number(const std::string& name, float fallback);
  float positive(const std::string& name, float fallback);
  int integer(const std::string& name, int fallback);
  bool flag(const std::string& name, bool fallback);
  std::optional<std::string> text(const std::string& name);
  std::string required_text(const std::string& name);
  // An index of refraction is a number or the name of a material. The property must be there.
  std::variant<float, std::string> text_or_number(const std::string& name);
  std::optional<Vec3d> vec3(const std::string& name);
  Transform transform(const std::string& name = "to_world");
  // The same, but an error if it cannot be inverted.
  Transform regular_transform(const std::string& name = "to_world");

  std::optional<ColorInput> color_if(const std::string& name, Intent intent);
  ColorInput color(const std::string& name, Rgb fallback, Intent intent);
  // A constant color where no texture can be used: a texture is warned of and its stand-in used.
  Rgb constant_color(const std::string& name, Rgb fallback, Intent intent);
  // A color of a surface: a negative one is an error, one above 1 a warning.
  ColorInput reflectance(const std::string& name, Rgb fallback);
  ColorInput radiance(const std::string& name, Rgb fallback);
  FloatInput scalar(const std::string& name, float fallback);

  // Nested objects of one kind ("bsdf", "texture", "shape", …) that have not been taken yet, references
  // followed.
  std::vector<const Element*> take_all(const std::string& tag);
  const Element* take_one(const std::string& tag);
  const Element* take_named(const std::string& name, const std::string& tag);

  // Properties that have no bearing on the picture here.
  void ignore(std::initializer_list<const char*> names);
  void ignore_all();
  // Warns of everything that nobody asked for. Call it when the plugin is built.
  void finish();

 private:
  struct Child {
    const Element* element;
    const Element* target;  // the element, or what it refers to
    std::string name;       // in snake case; "" if it has none
    bool used = false;
  };
  Child* find(const std::string& name);
  Child* find_tag(const std::string& name, std::initializer_list<const char*> tags);
  [[noreturn]] void wrong_kind(const Child& child, const std::string& wanted) const;
  void warn_unused(const Child& child);

  Reader& reader_;
  const Element& element_;
  std::string type_, id_;
  std::vector<Child> children_;
  std::set<std::string> asked_;
};

// What a "fov_axis" names.
FieldAxis field_axis(const Plugin& p, const std::string& name);

}  // namespace lumirank::scenedesc::mitsuba
