// A Mitsuba XML file as a tree of elements: includes spliced in, $parameters put in, every element with its
// line.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "base/error.h"

namespace lumirank::scenedesc::mitsuba {

struct Element {
  std::string tag;
  SourceLocation where;
  std::vector<std::pair<std::string, std::string>> attributes;
  std::vector<std::unique_ptr<Element>> children;

  // Null if there is none.
  const std::string* find(const std::string& name) const;
  // The attribute's text, or an error that names the element and the attribute.
  const std::string& require(const std::string& name) const;
};

struct Dialect {
  int major = 0, minor = 0, patch = 0;
  bool camel_case() const { return major < 2; }
  std::string text() const;
};

struct Document {
  std::unique_ptr<Element> root;
  Dialect dialect;
  std::vector<std::pair<SourceLocation, std::string>> notes;  // about the file itself, for the warnings
};

// `text` is the content of `filename`; included files are read from the disk. Throws InputError.
Document load_document(const std::string& text, const std::string& filename,
                       const std::map<std::string, std::string>& defines);

// "toWorld" → "to_world", "intIOR" → "int_ior"; names in snake case stay as they are.
std::string snake_case(const std::string& name);

}  // namespace lumirank::scenedesc::mitsuba
