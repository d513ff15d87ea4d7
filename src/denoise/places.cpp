#include "denoise/places.h"

#include <cstdlib>
#include <filesystem>

namespace lumirank::denoise {
namespace {
namespace fs = std::filesystem;

std::string environment(const char* name) {
  const char* value = std::getenv(name);
  return value ? value : "";
}

// The library looks for its other parts in ../lib of where it lies, so a folder is one that has a lib, as in
// Open Image Denoise's own releases; one that is that lib itself will do as well.
void add_folder(const fs::path& folder, std::vector<std::string>& files) {
  files.push_back((folder / "lib" / kLibraryName).string());
  files.push_back((folder / kLibraryName).string());
}

// $XDG_DATA_HOME, of which relative ones do not count, or ~/.local/share; empty: there is no home.
fs::path user_data() {
  fs::path data = environment("XDG_DATA_HOME");
  if (data.is_absolute()) return data;
  const fs::path home = environment("HOME");
  return home.empty() ? fs::path{} : home / ".local" / "share";
}

}  // namespace

Places library_places() {
  Places places;
  places.chosen = environment(kChosenPlace);
  if (!places.chosen.empty()) {
    std::error_code error;
    if (const fs::path chosen = fs::absolute(places.chosen, error); fs::is_directory(chosen, error))
      add_folder(chosen, places.files);
    else
      places.files.push_back(chosen.string());
    places.words = "in " + places.chosen;
    return places;
  }
  if (const fs::path data = user_data(); !data.empty()) {
    const fs::path folder = data / "lumirank" / "denoiser";
    add_folder(folder, places.files);
    places.words = "in " + folder.string() + " or ";
  }
  places.files.emplace_back(kLibraryName);
  places.words += "where the system keeps its libraries";
  return places;
}

}  // namespace lumirank::denoise
