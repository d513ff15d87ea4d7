// libFuzzer target: any bytes as a glTF scene, text or binary. Only InputError may come out.
#include <cstddef>
#include <cstdint>
#include <string>

#include "scenedesc/readers.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    const auto scene =
        lumirank::scenedesc::parse_gltf(std::string(reinterpret_cast<const char*>(data), size), "fuzz.gltf");
    (void)lumirank::scenedesc::describe(scene);
  } catch (const lumirank::InputError&) {
  }
  return 0;
}
