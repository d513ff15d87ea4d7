// Base of the readers of all formats: the description that they build, how they say what a format has and
// Lumirank does not, and what becomes of files that are named and missing.
#pragma once

#include <set>
#include <string>

#include "scenedesc/schema/read_options.h"
#include "scenedesc/schema/scene_desc.h"

namespace lumirank::scenedesc {

class SceneReader {
 public:
  SceneReader(const SceneReader&) = delete;
  SceneReader& operator=(const SceneReader&) = delete;

  SceneDesc& scene() { return scene_; }

  // The format has `what` and Lumirank does not. With `strict`, an InputError. `used_instead`: "" if it is
  // left out.
  void warn(const SourceLocation& where, const std::string& what, const std::string& used_instead);
  // The same, once for each `what`.
  void warn_once(const SourceLocation& where, const std::string& what, const std::string& used_instead);

  // Each returns the index in the scene's list.
  int add_bsdf(const std::string& id, const SourceLocation& where, decltype(BsdfDesc::kind) kind);
  int add_texture(const std::string& id, const SourceLocation& where, decltype(TextureDesc::kind) kind);

  struct NamedFile {
    std::string name;
    bool missing = false;
  };
  // The file at `path`. Whether it is there is seen here, so that the message has the line that names it: a
  // folder is an InputError, for the rest see missing_file(). `kind` says what the file is ("texture").
  NamedFile named_file(const std::string& path, const SourceLocation& where, const std::string& kind,
                       const std::string& stand_in);

  // `path`, or where that is a numbered sequence (frame_files.h) its file at the time to be read.
  std::string path_at_time(const std::string& path);
  // All files of the sequence, the first one first; empty if it is none.
  static std::vector<std::string> sequence(const std::string& path);

  // Something of the name `what` moves from `begin` to `end` (seconds).
  void add_motion(const std::string& what, double begin, double end);

 protected:
  // `format` as in SceneDesc. `options` must outlive this.
  SceneReader(const std::string& filename, const std::string& format, const ReadOptions& options);
  ~SceneReader() = default;

  // Whether this text comes for the first time: for what is said once.
  bool is_new(const std::string& text) { return said_.insert(text).second; }
  // The scene names a file that does not exist; `what` says what it is and its name: "texture not found:
  // a.png". An InputError, or with `allow_missing` a warning that `stand_in` is in its place ("": it is left
  // out).
  void missing_file(const SourceLocation& where, const std::string& what, const std::string& stand_in);

  const ReadOptions& options_;
  SceneDesc scene_;

 private:
  std::set<std::string> said_, found_files_;
};

}  // namespace lumirank::scenedesc
