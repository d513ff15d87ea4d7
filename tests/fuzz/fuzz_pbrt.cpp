// libFuzzer target: any bytes as a pbrt scene.
#include "scene_fuzzer.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  lumirank::fuzz::read_scene(data, size, "fuzz.pbrt", lumirank::scenedesc::parse_pbrt);
  return 0;
}
