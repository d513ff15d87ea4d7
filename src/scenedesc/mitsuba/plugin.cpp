#include "scenedesc/mitsuba/plugin.h"

#include <algorithm>
#include <cmath>

namespace lumirank::scenedesc::mitsuba {

namespace {

bool is_property(const std::string& tag) {
  for (const char* known : {"integer", "float", "boolean", "string", "point", "vector", "rgb", "srgb",
                            "color", "spectrum", "blackbody", "transform", "animation"})
    if (tag == known) return true;
  return false;
}

bool is_object(const std::string& tag) {
  for (const char* known : {"bsdf", "texture", "shape", "emitter", "sensor", "film", "rfilter", "sampler",
                            "integrator", "medium", "phase", "volume", "subsurface"})
    if (tag == known) return true;
  return false;
}

}  // namespace

Plugin::Plugin(Reader& reader, const Element& element) : reader_(reader), element_(element) {
  type_ = element.require("type");
  if (const std::string* id = element.find("id")) id_ = *id;
  for (const auto& [name, value] : element.attributes)
    if (name != "type" && name != "id" && name != "name")
      reader_.warn(element.where, "the attribute \"" + name + "\" of " + title(), "");
  for (const auto& child : element.children) {
    if (child->tag == "alias") continue;
    if (!is_property(child->tag) && !is_object(child->tag) && child->tag != "ref")
      throw InputError(child->where, "<" + child->tag + "> is not an element of the Mitsuba format",
                       "check its spelling");
    Child entry{child.get(), &reader.resolve(*child), {}, false};
    if (const std::string* name = child->find("name")) {
      entry.name = reader.dialect().camel_case() ? snake_case(*name) : *name;
    } else if (is_property(child->tag)) {
      throw InputError(child->where, "<" + child->tag + "> has no name", "add name=\"…\"");
    }
    if (!entry.name.empty())
      for (const Child& other : children_)
        if (other.name == entry.name && is_property(child->tag) && is_property(other.element->tag))
          throw InputError(child->where,
                           "the property \"" + *child->find("name") + "\" of " + title() +
                               " is given twice, first on line " + std::to_string(other.element->where.line),
                           "remove one");
    children_.push_back(std::move(entry));
  }
}

std::string Plugin::title() const { return "<" + element_.tag + " type=\"" + type_ + "\">"; }

Plugin::Child* Plugin::find(const std::string& name) {
  asked_.insert(name);
  for (Child& child : children_)
    if (child.name == name) {
      child.used = true;
      return &child;
    }
  return nullptr;
}

bool Plugin::has(const std::string& name) const {
  return std::any_of(children_.begin(), children_.end(), [&](const Child& c) { return c.name == name; });
}

bool Plugin::has_object(const std::string& tag) const {
  return std::any_of(children_.begin(), children_.end(),
                     [&](const Child& c) { return c.target->tag == tag; });
}

bool Plugin::names_object(const std::string& name, const std::string& tag) const {
  return std::any_of(children_.begin(), children_.end(),
                     [&](const Child& c) { return c.name == name && c.target->tag == tag; });
}

SourceLocation Plugin::where_of(const std::string& name) const {
  for (const Child& child : children_)
    if (child.name == name) return child.element->where;
  return element_.where;
}

void Plugin::wrong_kind(const Child& child, const std::string& wanted) const {
  throw InputError(child.element->where,
                   "\"" + child.name + "\" of " + title() + " is a <" + child.target->tag + ">",
                   "it should be " + wanted);
}

Plugin::Child* Plugin::find_tag(const std::string& name, std::initializer_list<const char*> tags) {
  Child* child = find(name);
  if (!child) return nullptr;
  std::string wanted;
  for (const char* tag : tags) {
    if (child->target->tag == tag) return child;
    wanted += std::string(wanted.empty() ? "a <" : " or <") + tag + ">";
  }
  wrong_kind(*child, wanted);
}

std::optional<float> Plugin::number(const std::string& name) {
  const Child* child = find_tag(name, {"float", "integer"});
  if (!child) return std::nullopt;
  return parse_float(child->element->require("value"), child->element->where,
                     "\"" + name + "\" of " + title());
}
float Plugin::number(const std::string& name, float fallback) { return number(name).value_or(fallback); }

float Plugin::positive(const std::string& name, float fallback) {
  const float value = number(name, fallback);
  if (!(value > 0))
    throw InputError(where_of(name), "\"" + name + "\" of " + title() + " is not positive",
                     "give a value above 0");
  return value;
}

int Plugin::integer(const std::string& name, int fallback) {
  const Child* child = find_tag(name, {"integer"});
  return child ? parse_int(child->element->require("value"), child->element->where,
                           "\"" + name + "\" of " + title())
               : fallback;
}
bool Plugin::flag(const std::string& name, bool fallback) {
  const Child* child = find_tag(name, {"boolean"});
  return child ? parse_bool(child->element->require("value"), child->element->where,
                            "\"" + name + "\" of " + title())
               : fallback;
}
std::optional<std::string> Plugin::text(const std::string& name) {
  const Child* child = find_tag(name, {"string"});
  if (!child) return std::nullopt;
  return child->element->require("value");
}
std::string Plugin::required_text(const std::string& name) {
  if (auto value = text(name)) return *value;
  throw InputError(where(), title() + " has no \"" + name + "\"",
                   "add <string name=\"" + name + "\" value=\"…\"/>");
}
std::variant<float, std::string> Plugin::text_or_number(const std::string& name) {
  const Child* child = find_tag(name, {"float", "integer", "string"});
  if (!child) throw InputError(where(), title() + " has no \"" + name + "\"");
  if (child->element->tag == "string") return child->element->require("value");
  return parse_float(child->element->require("value"), child->element->where,
                     "\"" + name + "\" of " + title());
}
std::optional<Vec3d> Plugin::vec3(const std::string& name) {
  const Child* child = find_tag(name, {"point", "vector"});
  if (!child) return std::nullopt;
  return parse_vec3(*child->element);
}

Transform Plugin::transform(const std::string& name) {
  const Child* child = find_tag(name, {"transform", "animation"});
  if (!child) return {};
  if (child->element->tag == "transform") return parse_transform(*child->element);
  return reader_.animated(*child->element, title());
}

Transform Plugin::regular_transform(const std::string& name) {
  const Transform t = transform(name);
  const std::optional<Transform> inverse = t.inverse();
  // The determinant is compared with the size of the columns, so that small objects stay allowed.
  double size = 1;
  for (std::size_t j = 0; j < 3; ++j) size *= std::hypot(t.m[j], t.m[4 + j], t.m[8 + j]);
  if (!inverse || !inverse->is_finite() || !(std::abs(t.determinant3()) > 1e-12 * size))
    throw InputError(where_of(name), "the transform \"" + name + "\" of " + title() + " is singular",
                     "no scale may be 0");
  return t;
}

std::optional<ColorInput> Plugin::color_if(const std::string& name, Intent intent) {
  const Child* child = find(name);
  if (!child) return std::nullopt;
  const Element& target = *child->target;
  ColorInput out;
  if (target.find("type") && (target.tag == "spectrum" || target.tag == "texture")) {
    if (!reader_.constant_texture(target, intent, out.value)) out.texture = reader_.build_texture(target);
  } else if (is_color_tag(target.tag)) {
    out.value = parse_color(target, intent);
    // Equal energy is no gray under the white of sRGB. 0.6 has three channels, and they are alike.
    if (intent == Intent::emission && !reader_.dialect().camel_case() && is_even_spectrum(target))
      out.value *= kEqualEnergy;
  } else if (target.tag == "texture") {
    out.texture = reader_.build_texture(target);
  } else {
    wrong_kind(*child, "a color or a texture");
  }
  return out;
}
ColorInput Plugin::color(const std::string& name, Rgb fallback, Intent intent) {
  return color_if(name, intent).value_or(ColorInput{fallback});
}

Rgb Plugin::constant_color(const std::string& name, Rgb fallback, Intent intent) {
  const ColorInput input = color(name, fallback, intent);
  if (input.texture == kNone) return input.value;
  reader_.warn(where_of(name), "a texture as \"" + name + "\" of " + title(), "the default");
  return fallback;
}

ColorInput Plugin::reflectance(const std::string& name, Rgb fallback) {
  const ColorInput input = color(name, fallback, Intent::reflectance);
  const Rgb c = input.value;
  if (input.texture != kNone) return input;
  if (c.r < 0 || c.g < 0 || c.b < 0)
    throw InputError(where_of(name), "\"" + name + "\" of " + title() + " is negative",
                     "use values from 0 to 1");
  // Spectra of nearly 1 may come out a little above it.
  if (max_component(c) > 1.001f)
    reader_.warn(where_of(name), "a \"" + name + "\" above 1 (" + title() + " would make light)",
                 "the value as it is");
  return input;
}

ColorInput Plugin::radiance(const std::string& name, Rgb fallback) {
  const ColorInput input = color(name, fallback, Intent::emission);
  const Rgb c = input.value;
  if (c.r < 0 || c.g < 0 || c.b < 0)
    throw InputError(where_of(name), "\"" + name + "\" of " + title() + " is negative",
                     "use values of 0 or more");
  return input;
}

FloatInput Plugin::scalar(const std::string& name, float fallback) {
  const auto input = color_if(name, Intent::index);
  if (!input) return {fallback};
  const Rgb c = input->value;
  return {input->texture != kNone ? 0.0f : (c.r == c.g && c.g == c.b ? c.r : luminance(c)), input->texture};
}

std::vector<const Element*> Plugin::take_all(const std::string& tag) {
  std::vector<const Element*> found;
  for (Child& child : children_)
    if (!child.used && child.target->tag == tag) {
      child.used = true;
      found.push_back(child.target);
    }
  return found;
}

const Element* Plugin::take_one(const std::string& tag) {
  const auto all = take_all(tag);
  if (all.size() > 1)
    throw InputError(all[1]->where, title() + " has more than one <" + tag + ">", "keep one of them");
  return all.empty() ? nullptr : all[0];
}

const Element* Plugin::take_named(const std::string& name, const std::string& tag) {
  const Child* child = find(name);
  if (!child) return nullptr;
  if (child->target->tag != tag) wrong_kind(*child, "a <" + tag + ">");
  return child->target;
}

void Plugin::ignore(std::initializer_list<const char*> names) {
  for (const char* name : names) find(name);
}
void Plugin::ignore_all() {
  for (Child& child : children_) child.used = true;
}

}  // namespace lumirank::scenedesc::mitsuba
