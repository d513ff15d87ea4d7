#include "base/error.h"

namespace lumirank {

std::string to_string(const SourceLocation& where) {
  if (where.file.empty()) return {};
  return where.line > 0 ? where.file + ":" + std::to_string(where.line) : where.file;
}

namespace {
std::string compose(const SourceLocation& where, const std::string& message, const std::string& remedy) {
  std::string text = to_string(where);
  if (!text.empty()) text += ": ";
  text += message;
  if (!remedy.empty()) text += "; " + remedy;
  return text;
}
}  // namespace

InputError::InputError(SourceLocation where, const std::string& message, const std::string& remedy)
    : std::runtime_error(compose(where, message, remedy)), where_(std::move(where)) {}

}  // namespace lumirank
