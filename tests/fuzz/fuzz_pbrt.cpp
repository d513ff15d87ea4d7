// libFuzzer target: any bytes as a pbrt scene, as it stands and at a moment. Only InputError may
// come out.
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include "scenedesc/readers.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string bytes(reinterpret_cast<const char*>(data), size);
  for (const std::optional<double> time : {std::optional<double>(), std::optional<double>(0.4)}) {
    try {
      lumirank::scenedesc::ReadOptions options;
      options.time = time;
      if (time) options.clip = "*";
      const auto scene = lumirank::scenedesc::parse_pbrt(bytes, "fuzz.pbrt", options);
      (void)lumirank::scenedesc::describe(scene);
    } catch (const lumirank::InputError&) {
    }
  }
  return 0;
}
