// The functions of Open Image Denoise's C interface, version 2, that are called here. Its library is not
// linked but loaded when it is wanted, since it is larger than the whole program and most pictures are not
// denoised; so neither its headers nor the library are needed to build.
#pragma once

#include <cstddef>
#include <string>

namespace lumirank::denoise {

// Its numbers for the kinds of things; they are part of its binary interface.
inline constexpr int kOidnCpu = 1;          // a device
inline constexpr int kOidnThreeFloats = 3;  // a pixel
inline constexpr int kOidnNoError = 0;
inline constexpr int kOidnOutOfMemory = 4;

struct OidnDevice;  // its own, never looked into
struct OidnFilter;

struct Oidn {
  OidnDevice* (*new_device)(int kind) = nullptr;
  void (*set_device_int)(OidnDevice*, const char* name, int value) = nullptr;
  void (*set_device_bool)(OidnDevice*, const char* name, bool value) = nullptr;
  int (*get_device_int)(OidnDevice*, const char* name) = nullptr;
  void (*commit_device)(OidnDevice*) = nullptr;
  int (*get_device_error)(OidnDevice*,
                          const char** message) = nullptr;  // and forgets it; a null device: of new_device
  void (*release_device)(OidnDevice*) = nullptr;
  OidnFilter* (*new_filter)(OidnDevice*, const char* kind) = nullptr;
  void (*set_filter_image)(OidnFilter*, const char* name, void* pixels, int pixel, std::size_t width,
                           std::size_t height, std::size_t offset, std::size_t pixel_stride,
                           std::size_t row_stride) = nullptr;
  void (*set_filter_bool)(OidnFilter*, const char* name, bool value) = nullptr;
  void (*commit_filter)(OidnFilter*) = nullptr;
  void (*execute_filter)(OidnFilter*) = nullptr;
  void (*release_filter)(OidnFilter*) = nullptr;
};

struct LoadedOidn {
  Oidn functions;
  std::string version;  // "2.5.1"
  std::string trouble;  // why it cannot be used; empty: it can
  bool absent = false;  // the loader knows no file of that name
};

// Loads the library `file` (a name without a slash: where the system's loader finds it) and tries a device.
// What was loaded stays so until the process ends, as do its threads.
LoadedOidn load_oidn(const std::string& file);

}  // namespace lumirank::denoise
