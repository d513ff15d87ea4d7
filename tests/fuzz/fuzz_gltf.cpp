// libFuzzer target: any bytes as a glTF scene, text or binary.
#include "scene_fuzzer.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  lumirank::fuzz::read_scene(data, size, "fuzz.gltf", lumirank::scenedesc::parse_gltf);
  return 0;
}
