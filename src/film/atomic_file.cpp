#include "film/atomic_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "base/error.h"

namespace lumirank::film {
namespace fs = std::filesystem;

namespace {

std::string reason(int code) { return std::strerror(code); }

// Where a write to `filename` lands: the end of a chain of links, or the name itself.
fs::path resolve(const std::string& filename) {
  std::error_code error;
  fs::path path(filename);
  if (!fs::is_symlink(path, error)) return path;
  const fs::path resolved = fs::weakly_canonical(path, error);
  return error ? path : resolved;
}

}  // namespace

AtomicFile::AtomicFile(const std::string& filename) {
  if (filename.empty()) throw InputError("an output file has an empty name", "give a file name");
  const fs::path target = resolve(filename);
  target_ = target.string();
  std::error_code error;
  if (fs::is_directory(target, error))
    throw InputError(SourceLocation{filename, 0}, "cannot write the file: a folder has this name",
                     "give a file name");
  const fs::path folder = target.has_parent_path() ? target.parent_path() : fs::path(".");
  if (!fs::is_directory(folder, error))
    throw InputError(SourceLocation{filename, 0},
                     "cannot write the file: the folder " + folder.string() + " does not exist",
                     "create the folder first");

  // Distinct among the threads of this process and among processes; O_EXCL settles what remains.
  static std::atomic<unsigned> counter{0};
  for (int attempt = 0; attempt < 100; ++attempt) {
    const std::string name = "." + target.filename().string() + "." + std::to_string(::getpid()) + "-" +
                             std::to_string(counter++) + ".part";
    const std::string candidate = (folder / name).string();
    const int fd = ::open(candidate.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (fd >= 0) {
      ::close(fd);
      temporary_ = candidate;
      return;
    }
    if (errno != EEXIST) break;
  }
  throw InputError(SourceLocation{filename, 0}, "cannot write the file: " + reason(errno),
                   "choose a folder that can be written");
}

AtomicFile::~AtomicFile() {
  if (!temporary_.empty()) ::unlink(temporary_.c_str());
}

void AtomicFile::commit() {
  if (std::rename(temporary_.c_str(), target_.c_str()) != 0)
    throw InputError(SourceLocation{target_, 0}, "cannot write the file: " + reason(errno));
  temporary_.clear();
}

void write_whole_file(const std::string& filename, const std::string& content) {
  AtomicFile file(filename);
  std::ofstream out(file.temporary(), std::ios::binary);
  out.write(content.data(), static_cast<std::streamsize>(content.size()));
  out.close();
  if (!out)
    throw InputError(SourceLocation{filename, 0}, "cannot write the file: " + reason(errno),
                     "is the disk full?");
  file.commit();
}

}  // namespace lumirank::film
