// Numbered files of a sequence, one for each frame: "cloth.####.ply" is cloth.0000.ply, cloth.0001.ply, …
#pragma once

#include <map>
#include <optional>
#include <string>

namespace lumirank::scenedesc {

// `path`: its last run of '#' stands for the number, with as many digits at least. By their numbers; none if
// there is no '#', or a file has just this name.
std::map<int, std::string> files_of_frames(const std::string& path);

struct FrameFile {
  std::string path;         // of the frame that was asked for, or the nearest that there is
  int first = 0, last = 0;  // numbers that there are
};

// Of files_of_frames(); empty if there are none. `frame`: unset for the first one.
std::optional<FrameFile> file_of_frame(const std::string& path, std::optional<int> frame);

}  // namespace lumirank::scenedesc
