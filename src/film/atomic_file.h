// A file that appears whole under its name or not at all.
#pragma once

#include <string>

namespace lumirank::film {

// Makes an empty file beside `filename`; write to temporary(), then commit() renames it to `filename`.
// Without a commit the destructor removes it. A symbolic link at `filename` stays a link: its target is
// replaced. Throws InputError, naming the reason, if the folder is missing or cannot be written, or
// `filename` is a folder.
class AtomicFile {
 public:
  explicit AtomicFile(const std::string& filename);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  const std::string& temporary() const { return temporary_; }
  void commit();

 private:
  std::string target_, temporary_;
};

// The whole content in one go.
void write_whole_file(const std::string& filename, const std::string& content);

}  // namespace lumirank::film
