#include "scenedesc/mitsuba/element.h"

#include <cctype>

namespace lumirank::scenedesc::mitsuba {

const std::string* Element::find(const std::string& name) const {
  for (const auto& [key, value] : attributes)
    if (key == name) return &value;
  return nullptr;
}

const std::string& Element::require(const std::string& name) const {
  if (const std::string* value = find(name)) return *value;
  throw InputError(where, "<" + tag + "> has no attribute \"" + name + "\"", "add " + name + "=\"…\"");
}

std::string Dialect::text() const {
  return std::to_string(major) + "." + std::to_string(minor) + "." + std::to_string(patch);
}

std::string snake_case(const std::string& name) {
  std::string out;
  for (std::size_t i = 0; i < name.size(); ++i) {
    const auto c = static_cast<unsigned char>(name[i]);
    if (std::isupper(c)) {
      const bool after_lower = i > 0 && std::islower(static_cast<unsigned char>(name[i - 1]));
      if (after_lower) out += '_';
      out += static_cast<char>(std::tolower(c));
    } else {
      out += name[i];
    }
  }
  return out;
}

}  // namespace lumirank::scenedesc::mitsuba
