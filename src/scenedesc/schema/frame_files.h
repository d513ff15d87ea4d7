// Numbered files of a sequence, one for each frame: "cloth.####.ply" is cloth.0000.ply, cloth.0001.ply, …
#pragma once

#include <optional>
#include <string>

namespace lumirank::scenedesc {

struct FrameFile {
  std::string path;         // of the frame that was asked for, or the nearest that there is
  int first = 0, last = 0;  // numbers that there are
};

// `path`: its last run of '#' stands for the number, with as many digits at least. Empty if there is no '#',
// or a file has just this name, or none of the sequence exists. `frame`: unset for the first one.
std::optional<FrameFile> file_of_frame(const std::string& path, std::optional<int> frame);

}  // namespace lumirank::scenedesc
