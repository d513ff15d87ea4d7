// The folder that a shot's frames are written to. shot.json in it says what they are made of, so that frames
// of two shots are never mixed; a frame is finished when its report, which is written last, is there. So an
// interrupted shot goes on where it stopped, and several processes may share a folder.
#pragma once

#include <string>

#include "lumirank/animate.h"

namespace lumirank::api {

class ShotFolder {
 public:
  // `settings` outlives it.
  ShotFolder(const AnimateSettings& settings, std::string folder);

  // Before anything is written: the folder is new, or holds this shot. Throws InputError.
  void open(const Scene& scene) const;

  bool is_finished(int frame) const;
  void write(int frame, const Picture& picture, const Report& report) const;
  std::string report_file(int frame) const { return frame_file(frame, ".json"); }

  // <folder>/<kind>_0000<ending>
  std::string numbered_file(const char* kind, int frame, const std::string& ending) const;
  const std::string& name() const { return folder_; }

 private:
  std::string frame_file(int frame, const std::string& ending) const {
    return numbered_file("frame", frame, ending);
  }

  const AnimateSettings& settings_;
  std::string folder_;
};

}  // namespace lumirank::api
