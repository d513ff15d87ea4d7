// One value of a glTF file with its path ("meshes[0].primitives[1]"): every access checks the type, and every
// message names file, line and path.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "base/error.h"
#include "scenedesc/gltf/json.h"

namespace lumirank::scenedesc::gltf {

class Element {
 public:
  Element(const Json& json, std::string path, const std::string& file)
      : json_(&json), path_(std::move(path)), file_(&file) {}

  SourceLocation where() const { return {*file_, json_->line}; }
  const Json& json() const { return *json_; }
  const std::string& path() const { return path_; }
  const std::string& file() const { return *file_; }
  // Throws InputError: the path, then the message.
  [[noreturn]] void fail(const std::string& message, const std::string& remedy) const;

  // Members of an object; InputError if this is none.
  std::optional<Element> find(const std::string& key) const;
  Element at(const std::string& key) const;  // required
  bool has(const std::string& key) const { return find(key).has_value(); }
  const std::vector<std::string>& keys() const;
  // Two levels down: an extension of this object, if it has it.
  std::optional<Element> extension(const std::string& name) const;

  // Items of a list; InputError if this is none.
  std::size_t size() const;
  Element item(std::size_t index) const;
  // The items of a list that an object may have or lack.
  std::vector<Element> list(const std::string& key) const;

  double number() const;
  float real() const;  // as a finite float
  std::int64_t integer(std::int64_t min_value, std::int64_t max_value) const;
  bool flag() const;
  const std::string& text() const;
  std::vector<double> numbers(std::size_t count) const;

  // The same for a member, with a default.
  double number(const std::string& key, double fallback) const;
  // Held to a range: InputError outside.
  float real(const std::string& key, float fallback, float min_value = -std::numeric_limits<float>::max(),
             float max_value = std::numeric_limits<float>::max()) const;
  bool flag(const std::string& key, bool fallback) const;
  std::string text(const std::string& key, const std::string& fallback) const;

 private:
  const Json& expect(Json::Kind kind, const char* name) const;

  const Json* json_;
  std::string path_;
  const std::string* file_;
};

}  // namespace lumirank::scenedesc::gltf
