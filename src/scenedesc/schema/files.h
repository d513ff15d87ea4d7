// Whole files, for the readers of all formats.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/error.h"

namespace lumirank::scenedesc {

// `name` taken from the folder of `file`, unless it is absolute; normalized.
std::string resolve_path(const std::string& name, const std::string& file);

// The bytes of the file, and "" or what is wrong with it: "does not exist", say. Files whose names end in .gz
// are unpacked where they are packed by gzip.
std::string try_read_file(const std::string& filename, std::string& bytes,
                          std::uintmax_t max_bytes = UINTMAX_MAX);

// The same, or an InputError at `where`: missing, a folder, unreadable, larger than `max_bytes`, packed or
// unpacked.
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
  friend std::string try_read_file(const std::string& filename, std::string& bytes, std::uintmax_t max_bytes);
  std::vector<std::string> names_;
  FilesRead* outer_;
};

// A scene file as text, which has at most this size; geometry belongs into mesh files beside it.
inline constexpr std::uintmax_t kMaxText = 256u << 20;
// Of pbrt, whose curves and inline meshes have no other place.
inline constexpr std::uintmax_t kMaxPbrtText = 1u << 30;

}  // namespace lumirank::scenedesc
