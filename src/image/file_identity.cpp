#include "image/file_identity.h"

#include <sys/stat.h>

#include <filesystem>
#include <map>

#include "base/error.h"

namespace lumirank::image {

std::string end_of_links(const std::string& filename) {
  namespace fs = std::filesystem;
  fs::path path(filename);
  std::error_code error;
  for (int links = 0; links < 40; ++links) {  // as many as the system follows
    if (!fs::is_symlink(path, error)) return path.string();
    const fs::path next = fs::read_symlink(path, error);
    path = next.is_absolute() ? next : path.parent_path() / next;
  }
  return {};
}

std::string file_identity(const std::string& filename) {
  struct stat status {};
  if (::stat(filename.c_str(), &status) == 0)
    return S_ISCHR(status.st_mode) ? "" : std::to_string(status.st_dev) + ":" + std::to_string(status.st_ino);
  std::error_code error;
  const auto path =
      std::filesystem::weakly_canonical(std::filesystem::absolute(end_of_links(filename), error), error);
  return error ? filename : path.string();
}

void require_distinct(const std::vector<std::string>& outputs, const std::vector<std::string>& inputs) {
  std::map<std::string, std::string> seen;
  for (const std::string& input : inputs) seen.emplace(file_identity(input), input);
  seen.erase("");
  for (const std::string& output : outputs)
    if (const std::string id = file_identity(output); seen.contains(id))
      throw InputError(SourceLocation{output, 0},
                       seen[id] == output
                           ? "this file is an input, and would be overwritten"
                           : "this file is the input " + seen[id] + ", and would be overwritten",
                       "choose another name for the output");
  seen.clear();
  for (const std::string& output : outputs) {
    const std::string id = file_identity(output);
    if (id.empty() || seen.emplace(id, output).second) continue;
    throw InputError(SourceLocation{output, 0}, "two outputs would be written to one file",
                     "give each a name of its own");
  }
}

}  // namespace lumirank::image
