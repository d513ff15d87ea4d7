// Whatever the bytes, the reader returns a mesh whose indices are in range, or throws InputError.
#include <cstddef>
#include <cstdint>
#include <string>

#include "base/error.h"
#include "scenedesc/readers.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string bytes(reinterpret_cast<const char*>(data), size);
  try {
    const lumirank::scenedesc::MeshData mesh = lumirank::scenedesc::parse_ply(bytes, "fuzz.ply");
    for (const std::uint32_t i : mesh.indices)
      if (i >= mesh.positions.size()) __builtin_trap();
  } catch (const lumirank::InputError&) {
  }
  return 0;
}
