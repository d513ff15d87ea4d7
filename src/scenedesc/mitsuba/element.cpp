#include "scenedesc/mitsuba/element.h"

#include <cctype>
#include <filesystem>
#include <fstream>
#include <sstream>

namespace lumirank::scenedesc::mitsuba {

namespace fs = std::filesystem;

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

std::string read_file(const std::string& filename, const SourceLocation& where) {
  constexpr std::uintmax_t kLargest = 256u << 20;
  std::error_code error;
  const fs::path path(filename);
  const fs::file_status status = fs::status(path, error);
  if (!fs::exists(status)) throw InputError(where, "file not found: " + filename, "check the name");
  if (fs::is_directory(status)) throw InputError(where, filename + " is a folder", "name a file in it");
  if (!fs::is_regular_file(status))
    throw InputError(where, filename + " is not a file", "name a file that can be read");
  const std::uintmax_t size = fs::file_size(path, error);
  if (error) throw InputError(where, "cannot read " + filename + " (" + error.message() + ")");
  if (size > kLargest)
    throw InputError(where, filename + " is larger than 256 MiB",
                     "put geometry into mesh files beside the scene");
  std::ifstream in(path, std::ios::binary);
  std::ostringstream bytes;
  if (!in) throw InputError(where, "cannot open " + filename, "check its permissions");
  if (in.peek() != std::ifstream::traits_type::eof()) bytes << in.rdbuf();
  if (in.bad() || bytes.fail()) throw InputError(where, "cannot read " + filename);
  return std::move(bytes).str();
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

std::string resolve_path(const std::string& name, const std::string& file) {
  fs::path path(name);
  if (path.is_relative()) path = fs::path(file).parent_path() / path;
  std::error_code error;
  const fs::path full = fs::absolute(path, error);
  return (error ? path : full).lexically_normal().string();
}

}  // namespace lumirank::scenedesc::mitsuba
