#include "image/atomic_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>
#include <mutex>

#include "base/error.h"
#include "image/file_identity.h"

namespace lumirank::image {

// One for every name that a temporary file has had; they are listed for ever, since a signal handler may be
// reading them.
struct TemporaryFile {
  std::string name;
  std::atomic<bool> exists{false};
  TemporaryFile* next = nullptr;
};

namespace {

namespace fs = std::filesystem;

std::atomic<TemporaryFile*> g_temporary_files{nullptr};

std::string error_text(int code) { return std::strerror(code); }

[[noreturn]] void cannot_write(const std::string& filename, const std::string& why,
                               const std::string& remedy = {}) {
  throw InputError(SourceLocation{filename, 0}, "cannot write the file: " + why, remedy);
}

// A file of this process that is new, under a name that is listed before it exists.
TemporaryFile* create_temporary(const fs::path& folder, const std::string& stem) {
  static std::mutex mutex;
  static std::map<std::string, TemporaryFile*> known;
  const std::scoped_lock lock(mutex);
  for (int attempt = 0; attempt < 1000; ++attempt) {
    const std::string name =
        (folder / ("." + stem + "." + std::to_string(::getpid()) + "-" + std::to_string(attempt) + ".part"))
            .string();
    TemporaryFile*& file = known[name];
    if (file && file->exists) continue;
    if (!file) {
      file = new TemporaryFile;
      file->name = name;
      file->next = g_temporary_files;
      g_temporary_files = file;
    }
    file->exists = true;
    const int fd = ::open(name.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    const int code = errno;
    if (fd >= 0) {
      ::close(fd);
      return file;
    }
    file->exists = false;
    errno = code;
    if (errno != EEXIST) break;
  }
  return nullptr;
}

void discard_temporary(TemporaryFile*& file) {
  if (!file) return;
  ::unlink(file->name.c_str());
  file->exists = false;
  file = nullptr;
}

// The standard stream that is open on this very file or device, or -1.
int stream_of(const struct stat& file) {
  for (const int fd : {STDOUT_FILENO, STDERR_FILENO}) {
    struct stat open {};
    if (::fstat(fd, &open) == 0 && open.st_dev == file.st_dev && open.st_ino == file.st_ino) return fd;
  }
  return -1;
}

void write_all(int fd, const char* data, std::size_t size, const std::string& filename) {
  while (size > 0) {
    const ssize_t written = ::write(fd, data, size);
    if (written < 0 && errno == EINTR) throw Cancelled();
    if (written < 0) cannot_write(filename, error_text(errno));
    data += written, size -= static_cast<std::size_t>(written);
  }
}

struct OpenedFile {
  int fd = -1;
  bool own = true;
  ~OpenedFile() {
    if (own && fd >= 0) ::close(fd);
  }
};

// Opening a pipe waits for its reader; an interrupt ends that.
void write_into(const std::string& filename, int stream, const std::string& from) {
  OpenedFile to{stream, stream < 0};
  if (to.own) to.fd = ::open(filename.c_str(), O_WRONLY | O_CLOEXEC | O_NOCTTY);
  if (to.fd < 0 && errno == EINTR) throw Cancelled();
  if (to.fd < 0) cannot_write(filename, error_text(errno));
  std::ifstream in(from, std::ios::binary);
  std::string piece(std::size_t{1} << 16, '\0');
  while (in.read(piece.data(), static_cast<std::streamsize>(piece.size())) || in.gcount() > 0)
    write_all(to.fd, piece.data(), static_cast<std::size_t>(in.gcount()), filename);
}

thread_local FilesTogether* t_together = nullptr;

}  // namespace

AtomicFile::AtomicFile(const std::string& filename) {
  if (filename.empty()) throw InputError("an output file has an empty name", "give a file name");
  target_.name = target_.path = filename;
  struct stat status {};
  std::error_code error;
  const bool exists = ::stat(filename.c_str(), &status) == 0;
  if (!exists && errno == ELOOP) cannot_write(filename, error_text(ELOOP), "choose another name");
  if (exists) {
    if (S_ISDIR(status.st_mode)) cannot_write(filename, "a folder has this name", "give a file name");
    if (S_ISBLK(status.st_mode) || S_ISSOCK(status.st_mode))
      cannot_write(filename, S_ISBLK(status.st_mode) ? "it is a disk" : "it is a socket",
                   "give the name of a file");
    target_.stream = stream_of(status);
    target_.straight = !S_ISREG(status.st_mode) || target_.stream >= 0;
    // Renaming would get around the protection.
    if (target_.stream < 0 && ::access(filename.c_str(), W_OK) != 0)
      cannot_write(filename, error_text(errno), "choose another name, or allow it to be written");
  }
  // Another temporary file may stand where no folder of its own is: devices' folders are not to be written.
  fs::path folder = fs::temp_directory_path(error);
  if (!target_.straight) {
    const fs::path path = end_of_links(filename);
    if (path.empty()) cannot_write(filename, error_text(ELOOP), "choose another name");
    target_.path = path.string();
    folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
    if (!fs::is_directory(folder, error))
      cannot_write(filename, "the folder " + folder.string() + " does not exist", "create the folder first");
  }
  target_.file = create_temporary(folder, fs::path(target_.path).filename().string());
  if (!target_.file) cannot_write(filename, error_text(errno), "choose a folder that can be written");
}

AtomicFile::~AtomicFile() { discard_temporary(target_.file); }

const std::string& AtomicFile::temporary() const { return target_.file->name; }

void AtomicFile::finish(Target& target) {
  if (target.straight) {
    write_into(target.name, target.stream, target.file->name);
    discard_temporary(target.file);
  } else {
    if (std::rename(target.file->name.c_str(), target.path.c_str()) != 0)
      cannot_write(target.name, error_text(errno));
    target.file->exists = false;
    target.file = nullptr;
  }
}

void AtomicFile::commit() {
  if (t_together) {
    t_together->waiting_.push_back(target_);
    target_.file = nullptr;
  } else {
    finish(target_);
  }
}

FilesTogether::FilesTogether() {
  if (t_together) throw InternalError("files are written together within files written together");
  t_together = this;
}

FilesTogether::~FilesTogether() {
  t_together = nullptr;
  for (auto& target : waiting_) discard_temporary(target.file);
}

void FilesTogether::commit() {
  // What can still fail comes first.
  for (const bool straight : {true, false})
    for (auto& target : waiting_)
      if (target.straight == straight) AtomicFile::finish(target);
  waiting_.clear();
}

void write_whole_file(const std::string& filename, const std::string& content) {
  AtomicFile file(filename);
  std::ofstream out(file.temporary(), std::ios::binary);
  out.write(content.data(), static_cast<std::streamsize>(content.size()));
  out.close();
  if (!out) cannot_write(filename, error_text(errno), "is the disk full?");
  file.commit();
}

void remove_temporary_files() noexcept {
  for (const TemporaryFile* file = g_temporary_files; file; file = file->next)
    if (file->exists) ::unlink(file->name.c_str());
}

}  // namespace lumirank::image
