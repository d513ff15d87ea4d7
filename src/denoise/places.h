// Where the denoiser's library may lie.
#pragma once

#include <string>
#include <vector>

namespace lumirank::denoise {

inline constexpr const char* kLibraryName = "libOpenImageDenoise.so.2";
inline constexpr const char* kChosenPlace = "LUMIRANK_DENOISER";  // an environment variable

struct Places {
  std::string chosen;              // what LUMIRANK_DENOISER says; empty: nothing
  std::vector<std::string> files;  // to be tried in this order; one without a slash is the system's to find
  std::string words;               // the same for people: "in A or where the system …"
};

// As the environment has it now: what LUMIRANK_DENOISER names and nothing else, or, where that is not set,
// the user's data folder (scripts/get-denoiser.sh fills it) and the places of the system.
Places library_places();

}  // namespace lumirank::denoise
