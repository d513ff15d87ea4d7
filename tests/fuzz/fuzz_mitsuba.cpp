// libFuzzer target: any bytes as a Mitsuba scene.
#include "scene_fuzzer.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  lumirank::fuzz::read_scene(data, size, "fuzz.xml", lumirank::scenedesc::parse_mitsuba);
  return 0;
}
