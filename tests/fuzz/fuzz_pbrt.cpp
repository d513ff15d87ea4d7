// libFuzzer target: any bytes as a pbrt scene. Only InputError may come out.
#include <cstddef>
#include <cstdint>
#include <string>

#include "scenedesc/readers.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    const auto scene =
        lumirank::scenedesc::parse_pbrt(std::string(reinterpret_cast<const char*>(data), size), "fuzz.pbrt");
    (void)lumirank::scenedesc::describe(scene);
  } catch (const lumirank::InputError&) {
  }
  return 0;
}
