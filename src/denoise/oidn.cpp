#include "denoise/oidn.h"

#include <dlfcn.h>

namespace lumirank::denoise {
namespace {

// The first function that the library lacks, or null.
const char* missing_function(void* library, Oidn& f) {
  const char* missing = nullptr;
  const auto find = [&]<typename Function>(const char* name, Function& function) {
    function = reinterpret_cast<Function>(dlsym(library, name));
    if (!function && !missing) missing = name;
  };
  find("oidnNewDevice", f.new_device);
  find("oidnSetDeviceInt", f.set_device_int);
  find("oidnSetDeviceBool", f.set_device_bool);
  find("oidnGetDeviceInt", f.get_device_int);
  find("oidnCommitDevice", f.commit_device);
  find("oidnGetDeviceError", f.get_device_error);
  find("oidnReleaseDevice", f.release_device);
  find("oidnNewFilter", f.new_filter);
  find("oidnSetSharedFilterImage", f.set_filter_image);
  find("oidnSetFilterBool", f.set_filter_bool);
  find("oidnCommitFilter", f.commit_filter);
  find("oidnExecuteFilter", f.execute_filter);
  find("oidnReleaseFilter", f.release_filter);
  return missing;
}

// Reads the version and why no device can be had, if so: the part for processors is a library of its own,
// which may be missing, and old processors are not served.
void try_device(const std::string& file, LoadedOidn& loaded) {
  const Oidn& f = loaded.functions;
  OidnDevice* device = f.new_device(kOidnCpu);
  const char* why = nullptr;
  if (device) {
    const int major = f.get_device_int(device, "versionMajor");
    loaded.version = std::to_string(major) + "." + std::to_string(f.get_device_int(device, "versionMinor")) +
                     "." + std::to_string(f.get_device_int(device, "versionPatch"));
    f.commit_device(device);
    if (f.get_device_error(device, &why) != kOidnNoError)
      loaded.trouble = file + " does not start: " + (why ? why : "it does not say why");
    else if (major != 2)
      loaded.trouble = file + " is Open Image Denoise " + loaded.version + ", and version 2 is needed";
    f.release_device(device);
  } else {
    f.get_device_error(nullptr, &why);
    // It does not tell which of the two it is.
    loaded.trouble =
        file +
        " does not start: its part for processors (libOpenImageDenoise_device_cpu) is missing beside it, "
        "or this processor lacks SSE4.1 (" +
        (why ? why : "it does not say why") + ")";
  }
}

}  // namespace

LoadedOidn load_oidn(const std::string& file) {
  LoadedOidn loaded;
  void* library = dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (!library) {
    const char* why = dlerror();
    loaded.trouble = why ? why : file + " cannot be loaded";
    // Of a library that is there but lacks another one, the loader names that one first.
    loaded.absent = file.find('/') == std::string::npos &&
                    loaded.trouble.starts_with(file + ": cannot open shared object");
  } else if (const char* name = missing_function(library, loaded.functions)) {
    loaded.trouble = file + " is not Open Image Denoise 2: it lacks the function " + name;
  } else {
    try_device(file, loaded);
  }
  return loaded;
}

}  // namespace lumirank::denoise
