#include <filesystem>

#include "denoise/denoiser.h"
#include "denoise/places.h"

namespace lumirank::denoise {
namespace {

constexpr const char* kRemedy = "; `make denoiser` in the sources of Lumirank gets it";

std::string nothing_found(const Places& places) {
  const std::string library = std::string("there is no ") + kLibraryName;
  if (!places.chosen.empty())
    return std::string(kChosenPlace) + " is set to " + places.chosen + ", but " + library + " there" +
           kRemedy + ", and is found without that variable";
  return "Open Image Denoise 2 is not installed: " + library + " " + places.words + kRemedy;
}

std::string nothing_usable(const Places& places, const std::string& why) {
  if (!places.chosen.empty())
    return std::string(kChosenPlace) + " is set to " + places.chosen + ", which cannot be used: " + why;
  return "Open Image Denoise is installed but cannot be used: " + why +
         "; remove it, and `make denoiser` in the sources of Lumirank gets version 2";
}

}  // namespace

Found Denoiser::find_anew() {
  const Places places = library_places();
  std::string why;  // of the first that was there
  for (const std::string& file : places.files) {
    std::error_code error;
    if (file.find('/') != std::string::npos && !std::filesystem::exists(file, error)) continue;
    LoadedOidn loaded = load_oidn(file);
    if (loaded.trouble.empty())
      return {std::shared_ptr<const Denoiser>(new Denoiser(loaded.functions, loaded.version)), {}, false};
    if (why.empty() && !loaded.absent) why = loaded.trouble;
  }
  if (why.empty()) return {nullptr, nothing_found(places), places.chosen.empty()};
  return {nullptr, nothing_usable(places, why), false};
}

const Found& Denoiser::find() {
  static const Found found = find_anew();
  return found;
}

}  // namespace lumirank::denoise
