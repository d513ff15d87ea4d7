#include "scenedesc/gltf/element.h"

#include <cmath>
#include <cstdio>

namespace lumirank::scenedesc::gltf {
namespace {

const char* name_of(Json::Kind kind) {
  constexpr const char* kNames[] = {"null", "true or false", "a number", "a text", "a list", "an object"};
  return kNames[static_cast<int>(kind)];
}

std::string shown(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.9g", value);
  return text;
}

}  // namespace

void Element::fail(const std::string& message, const std::string& remedy) const {
  throw InputError(where(), (path_.empty() ? "the file" : path_) + " " + message, remedy);
}

const Json& Element::expect(Json::Kind kind, const char* name) const {
  if (json_->kind != kind)
    fail(std::string("is ") + name_of(json_->kind) + ", not " + name, std::string("give ") + name);
  return *json_;
}

std::optional<Element> Element::find(const std::string& key) const {
  const Json* value = expect(Json::Kind::object, "an object").find(key);
  if (!value) return std::nullopt;
  return Element(*value, path_.empty() ? key : path_ + "." + key, *file_);
}

Element Element::at(const std::string& key) const {
  const auto found = find(key);
  if (!found) fail("lacks \"" + key + "\"", "glTF 2.0 requires it");
  return *found;
}

const std::vector<std::string>& Element::keys() const { return expect(Json::Kind::object, "an object").keys; }

std::optional<Element> Element::extension(const std::string& name) const {
  const auto extensions = find("extensions");
  return extensions ? extensions->find(name) : std::nullopt;
}

std::size_t Element::size() const { return expect(Json::Kind::list, "a list").items.size(); }

Element Element::item(std::size_t index) const {
  const Json& list = expect(Json::Kind::list, "a list");
  return Element(list.items.at(index), path_ + "[" + std::to_string(index) + "]", *file_);
}

std::vector<Element> Element::list(const std::string& key) const {
  std::vector<Element> items;
  if (const auto found = find(key)) {
    const std::size_t count = found->size();
    for (std::size_t k = 0; k < count; ++k) items.push_back(found->item(k));
  }
  return items;
}

double Element::number() const { return expect(Json::Kind::number, "a number").number; }

float Element::real() const {
  const float value = static_cast<float>(number());
  if (!std::isfinite(value)) fail("overflows", "give a smaller number");
  return value;
}

std::int64_t Element::integer(std::int64_t min_value, std::int64_t max_value) const {
  const Json& json = expect(Json::Kind::number, "a number");
  // Some writers give integers a fraction of zero.
  if (json.number != std::floor(json.number)) fail("is not a whole number", "give an integer");
  if (json.number < static_cast<double>(min_value) || json.number > static_cast<double>(max_value))
    fail("is " + shown(json.number),
         "it must lie between " + std::to_string(min_value) + " and " + std::to_string(max_value));
  return static_cast<std::int64_t>(json.number);
}

bool Element::flag() const { return expect(Json::Kind::boolean, "true or false").number != 0; }

const std::string& Element::text() const { return expect(Json::Kind::text, "a text").text; }

std::vector<double> Element::numbers(std::size_t count) const {
  if (size() != count)
    fail("has " + std::to_string(size()) + " numbers", "it must have " + std::to_string(count));
  std::vector<double> values;
  for (std::size_t k = 0; k < count; ++k) values.push_back(item(k).real());
  return values;
}

double Element::number(const std::string& key, double fallback) const {
  const auto found = find(key);
  return found ? found->number() : fallback;
}

float Element::real(const std::string& key, float fallback, float min_value, float max_value) const {
  const auto found = find(key);
  if (!found) return fallback;
  const float value = found->real();
  if (value < min_value || value > max_value)
    found->fail("is " + shown(value),
                max_value < std::numeric_limits<float>::max()
                    ? "it must lie between " + shown(min_value) + " and " + shown(max_value)
                    : "it must be at least " + shown(min_value));
  return value;
}

bool Element::flag(const std::string& key, bool fallback) const {
  const auto found = find(key);
  return found ? found->flag() : fallback;
}

std::string Element::text(const std::string& key, const std::string& fallback) const {
  const auto found = find(key);
  return found ? found->text() : fallback;
}

}  // namespace lumirank::scenedesc::gltf
