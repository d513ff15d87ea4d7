#include "scenedesc/pbrt/params.h"

#include <algorithm>

#include "scenedesc/pbrt/reader.h"
#include "scenedesc/schema/close_name.h"

namespace lumirank::scenedesc::pbrt {

namespace {

const char* name_of(ParamType type) {
  constexpr const char* kNames[] = {"float",     "integer",  "point2", "point3",  "rgb",
                                    "blackbody", "spectrum", "string", "texture", "bool"};
  return kNames[static_cast<int>(type)];
}

}  // namespace

Params::Params(Reader& reader, std::string title, Place where, std::vector<Parameter> own,
               const std::vector<Parameter>* inherited)
    : reader_(reader),
      title_(std::move(title)),
      where_(where),
      own_(std::move(own)),
      used_(own_.size(), false),
      inherited_(inherited) {}

const Parameter* Params::peek(std::string_view name) const {
  for (const Parameter& p : own_)
    if (p.name == name) return &p;
  if (inherited_)
    // The latest Attribute wins.
    for (auto p = inherited_->rbegin(); p != inherited_->rend(); ++p)
      if (p->name == name) return &*p;
  return nullptr;
}

Place Params::where_of(std::string_view name) const {
  const Parameter* p = peek(name);
  return p ? p->where : where_;
}

void Params::fail(const char* name, const std::string& message, const std::string& remedy) const {
  throw InputError(where_of(name), "\"" + std::string(name) + "\" of " + title_ + " " + message, remedy);
}

const Parameter* Params::find(const char* name) {
  asked_.push_back(name);
  const Parameter* found = peek(name);
  for (std::size_t i = 0; i < own_.size(); ++i)
    if (&own_[i] == found) used_[i] = true;
  return found;
}

const Parameter* Params::find(const char* name, ParamType type) {
  const Parameter* p = find(name);
  if (!p) return nullptr;
  if (p->type != type && !(type == ParamType::number && p->type == ParamType::integer))
    fail(name, std::string("is declared as ") + p->type_name + ", and a " + name_of(type) + " is needed",
         std::string("write \"") + name_of(type) + " " + name + "\"");
  return p;
}

bool Params::is_texture(std::string_view name) const {
  const Parameter* p = peek(name);
  return p && p->type == ParamType::texture;
}

namespace {

// The one value of a parameter that must have one.
template <typename Values>
const auto& single(const Params& params, const char* name, const Values& values, std::size_t size) {
  if (values.size() != size)
    params.fail(name, "has " + std::to_string(values.size()) +
                          (values.size() == 1 ? " value; " : " values; ") + std::to_string(size) +
                          (size == 1 ? " is needed" : " are needed"));
  return values;
}

}  // namespace

float Params::number(const char* name, float fallback) {
  const Parameter* p = find(name, ParamType::number);
  return p ? static_cast<float>(single(*this, name, p->numbers, 1)[0]) : fallback;
}

float Params::positive(const char* name, float fallback) {
  const float value = number(name, fallback);
  if (!(value > 0)) fail(name, "is not positive");
  return value;
}

int Params::integer(const char* name, int fallback) {
  const Parameter* p = find(name, ParamType::integer);
  return p ? static_cast<int>(single(*this, name, p->numbers, 1)[0]) : fallback;
}

bool Params::flag(const char* name, bool fallback) {
  const Parameter* p = find(name, ParamType::flag);
  return p ? static_cast<bool>(single(*this, name, p->flags, 1)[0]) : fallback;
}

std::string Params::text(const char* name, const std::string& fallback) {
  const Parameter* p = find(name, ParamType::text);
  return p ? single(*this, name, p->texts, 1)[0] : fallback;
}

std::string Params::required_text(const char* name) {
  if (!has(name))
    throw InputError(where_, title_ + " has no \"" + name + "\"",
                     std::string("add \"string ") + name + "\" \"…\"");
  return text(name, {});
}

Vec3d Params::point3(const char* name, Vec3d fallback) {
  const Parameter* p = find(name, ParamType::point3);
  if (!p) return fallback;
  const auto& v = single(*this, name, p->numbers, 3);
  return {v[0], v[1], v[2]};
}

const std::vector<double>& Params::numbers(const char* name, ParamType type) {
  static const std::vector<double> none;
  const Parameter* p = find(name, type);
  return p ? p->numbers : none;
}

std::vector<Vec3d> Params::places3(const char* name) {
  const auto& v = numbers(name, ParamType::point3);
  std::vector<Vec3d> out(v.size() / 3);
  for (std::size_t i = 0; i < out.size(); ++i) out[i] = {v[3 * i], v[3 * i + 1], v[3 * i + 2]};
  return out;
}

std::vector<Vec3f> Params::points3(const char* name) {
  const auto& v = numbers(name, ParamType::point3);
  std::vector<Vec3f> out(v.size() / 3);
  for (std::size_t i = 0; i < out.size(); ++i)
    out[i] = {static_cast<float>(v[3 * i]), static_cast<float>(v[3 * i + 1]),
              static_cast<float>(v[3 * i + 2])};
  return out;
}

std::vector<Vec2f> Params::points2(const char* name) {
  const auto& v = numbers(name, ParamType::point2);
  std::vector<Vec2f> out(v.size() / 2);
  for (std::size_t i = 0; i < out.size(); ++i)
    out[i] = {static_cast<float>(v[2 * i]), static_cast<float>(v[2 * i + 1])};
  return out;
}

std::vector<std::string> Params::texts(const char* name) {
  const Parameter* p = find(name, ParamType::text);
  return p ? p->texts : std::vector<std::string>{};
}

void Params::rename(std::string_view from, std::string_view to) {
  for (Parameter& p : own_)
    if (p.name == from) p.name = to;
}

void Params::drop(std::string_view name) {
  for (std::size_t i = own_.size(); i-- > 0;) {
    if (own_[i].name != name) continue;
    own_.erase(own_.begin() + static_cast<std::ptrdiff_t>(i));
    used_.erase(used_.begin() + static_cast<std::ptrdiff_t>(i));
  }
}

void Params::add_number(const char* name, float value) {
  own_.push_back({ParamType::number, "float", name, where_, {static_cast<double>(value)}, {}, {}});
  used_.push_back(false);
}

void Params::add_text(const char* name, const std::string& value) {
  own_.push_back({ParamType::text, "string", name, where_, {}, {value}, {}});
  used_.push_back(false);
}

void Params::replace_text(const char* name, const std::string& value) {
  for (Parameter& p : own_)
    if (p.name == name && p.type == ParamType::text) p.texts = {value};
}

void Params::ignore(std::initializer_list<const char*> names) {
  for (const char* name : names) find(name);
}

void Params::ignore_all() { used_.assign(own_.size(), true); }

void Params::finish() {
  for (std::size_t i = 0; i < own_.size(); ++i) {
    if (used_[i]) continue;
    const Parameter& p = own_[i];
    std::string hint;
    if (std::any_of(asked_.begin(), asked_.end(), [&](const char* name) { return p.name == name; })) {
      hint = " (it is given twice)";
    } else if (const auto close = close_name(p.name, asked_); !close.empty()) {
      hint = " (did you mean \"" + close + "\"?)";
    }
    reader_.warn(p.where, "the parameter " + in_quotes(p.name) + " of " + title_ + hint, "");
  }
}

}  // namespace lumirank::scenedesc::pbrt
