#include "scenedesc/schema/files.h"

#include <filesystem>
#include <fstream>

namespace lumirank::scenedesc {

namespace fs = std::filesystem;

namespace {
constexpr const char* kMissing = "does not exist";
thread_local FilesRead* t_files_read = nullptr;
}  // namespace

FilesRead::FilesRead() : outer_(t_files_read) { t_files_read = this; }
FilesRead::~FilesRead() { t_files_read = outer_; }

std::string resolve_path(const std::string& name, const std::string& file) {
  fs::path path(name);
  if (path.is_relative()) path = fs::path(file).parent_path() / path;
  std::error_code error;
  const fs::path full = fs::absolute(path, error);
  return (error ? path : full).lexically_normal().string();
}

std::string try_read_file(const std::string& filename, std::string& bytes) {
  std::error_code error;
  if (t_files_read) t_files_read->names_.push_back(filename);
  const fs::file_status status = fs::status(filename, error);
  if (!fs::exists(status)) return kMissing;
  if (fs::is_directory(status)) return "is a folder";
  if (!fs::is_regular_file(status)) return "is a device or a pipe, not a file";
  const std::uintmax_t size = fs::file_size(filename, error);
  std::ifstream in(filename, std::ios::binary);
  if (error || !in) return "cannot be opened";
  bytes.resize(static_cast<std::size_t>(size));
  if (!in.read(bytes.data(), static_cast<std::streamsize>(bytes.size()))) return "cannot be read";
  return {};
}

std::string read_file(const std::string& filename, const SourceLocation& where, std::uintmax_t max_bytes) {
  const std::string name = where.file == filename ? "this file" : filename;
  std::error_code error;
  if (const std::uintmax_t size = fs::file_size(filename, error); !error && size > max_bytes)
    throw InputError(where, name + " is larger than " + std::to_string(max_bytes >> 20) + " MiB",
                     "put geometry into mesh files beside the scene");
  std::string bytes;
  const std::string problem = try_read_file(filename, bytes);
  if (problem == kMissing && where.file != filename)
    throw InputError(where, "file not found: " + filename, "check the name");
  if (!problem.empty()) throw InputError(where, name + " " + problem, "check the name");
  return bytes;
}

}  // namespace lumirank::scenedesc
