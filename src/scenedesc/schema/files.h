// Whole files, for the readers of all formats.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/error.h"

namespace lumirank::scenedesc {

// `name` taken from the folder of `file`, unless it is absolute; normalized.
std::string resolve_path(const std::string& name, const std::string& file);

// The bytes of the file, and "" or what is wrong with it: "does not exist", say.
std::string try_read_file(const std::string& filename, std::string& bytes);

// The bytes of the file, or an InputError at `where`: missing, a folder, unreadable, larger than `most`
// bytes.
std::string read_file(const std::string& filename, const SourceLocation& where,
                      std::uintmax_t max_bytes = UINTMAX_MAX);

// The names of all files that this thread reads by the functions above while it lives: what a scene consists
// of, includes and tables too.
class FilesRead {
 public:
  FilesRead();
  ~FilesRead();
  FilesRead(const FilesRead&) = delete;
  FilesRead& operator=(const FilesRead&) = delete;
  const std::vector<std::string>& names() const { return names_; }

 private:
  friend std::string try_read_file(const std::string& filename, std::string& bytes);
  std::vector<std::string> names_;
  FilesRead* outer_;
};

// A scene file as text, which has at most this size; geometry belongs into mesh files beside it.
inline constexpr std::uintmax_t kMaxText = 256u << 20;

}  // namespace lumirank::scenedesc
