#include "image/other_formats.h"

#include <dlfcn.h>

#include <filesystem>
#include <stdexcept>
#include <vector>

#include "base/error.h"

namespace lumirank::image {
namespace {
namespace fs = std::filesystem;

constexpr const char* kOtherImagesModule = "lumirank_other_images.so";

struct OtherImagesModule {
  ReadOtherImage read = nullptr;
  std::string trouble;  // why it is not there
};

// Beside the program, where the build leaves it, or where it is installed.
OtherImagesModule load_other_images_module() {
  std::error_code error;
  std::vector<fs::path> places;
  const fs::path program = fs::read_symlink("/proc/self/exe", error).parent_path();
  for (const char* place : {".", "lib/lumirank", "../lib/lumirank"}) places.push_back(program / place);
  // In a shared library this code lies elsewhere than the program; and one of several for wide vectors lies
  // in glibc-hwcaps/x86-64-v3.
  if (Dl_info here{}; dladdr(reinterpret_cast<void*>(&load_other_images_module), &here) && here.dli_fname)
    for (const char* place : {".", "lumirank", "lib/lumirank", "../../lumirank"})
      places.push_back(fs::absolute(here.dli_fname, error).parent_path() / place);
  for (const fs::path& place : places) {
    const fs::path file = (place / kOtherImagesModule).lexically_normal();
    if (!fs::is_regular_file(file, error)) continue;
    void* module = dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
    void* function = module ? dlsym(module, kReadOtherImage) : nullptr;
    if (function) return {reinterpret_cast<ReadOtherImage>(function), {}};
    const char* why = dlerror();
    return {nullptr, why ? why : "it lacks its function"};
  }
  return {nullptr, std::string(kOtherImagesModule) +
                       " lies neither beside the program or the library nor in their lib/lumirank"};
}

}  // namespace

void read_other_format(const std::string& filename, PixelSink& sink) {
  static const OtherImagesModule module = load_other_images_module();
  if (!module.read)
    throw InputError(SourceLocation{filename, 0},
                     "this is not an EXR, PNG, JPEG, Radiance or PFM file, and other formats are read by "
                     "OpenImageIO, which cannot be loaded: " +
                         module.trouble,
                     "save the image in one of these formats, or install OpenImageIO and the whole of "
                     "Lumirank");
  std::string error;
  module.read(filename, sink, error);
  if (!error.empty()) throw std::runtime_error(error);
}

}  // namespace lumirank::image
