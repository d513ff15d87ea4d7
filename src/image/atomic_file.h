// A file that appears whole under its name or not at all.
#pragma once

#include <string>
#include <vector>

namespace lumirank::image {

struct TemporaryFile;  // atomic_file.cpp

// Makes an empty file beside `filename`; write to temporary(), then commit() renames it to `filename`.
// Without a commit the destructor removes it. A symbolic link at `filename` stays a link: its target is
// replaced. Only regular files are replaced: what is committed to a pipe, a character device or the file that
// a standard stream goes to is written into it. Throws InputError, naming the reason, if the folder is
// missing or cannot be written, or `filename` is a folder, a disk, or write-protected.
class AtomicFile {
 public:
  explicit AtomicFile(const std::string& filename);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  const std::string& temporary() const;
  // While this thread has a FilesTogether, the file waits for that one's commit().
  void commit();

 private:
  friend class FilesTogether;
  struct Target {
    std::string name;       // as it was given
    std::string path;       // what is replaced, at the end of all links
    bool straight = false;  // written into instead
    int stream = -1;        // straight: the open standard stream that leads there, if one does
    TemporaryFile* file = nullptr;
  };
  static void finish(Target& target);

  Target target_;
};

// All files that are committed on this thread while it lives appear in its own commit(), or none of them: a
// full disk is met before the first name is given. What waits is removed by the destructor.
class FilesTogether {
 public:
  FilesTogether();
  ~FilesTogether();
  FilesTogether(const FilesTogether&) = delete;
  FilesTogether& operator=(const FilesTogether&) = delete;
  void commit();

 private:
  friend class AtomicFile;
  std::vector<AtomicFile::Target> waiting_;
};

// The whole content in one go.
void write_whole_file(const std::string& filename, const std::string& content);

// Removes the temporary files of all writes that are under way. For a signal handler that ends the process:
// it calls nothing that a handler may not.
void remove_temporary_files() noexcept;

}  // namespace lumirank::image
