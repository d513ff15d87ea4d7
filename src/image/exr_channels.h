// Choice of an OpenEXR file's channels for color and alpha.
#pragma once

#include <array>
#include <string>
#include <vector>

namespace lumirank::image {

struct ExrChannels {
  std::array<std::string, 3> color;
  std::string alpha;  // empty: none
};

// `names`: all of the file's, at least one.
ExrChannels choose_exr_channels(const std::vector<std::string>& names);

}  // namespace lumirank::image
