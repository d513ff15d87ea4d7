// Whatever the bytes, the reader returns a grid of as many finite numbers as it says in a box that is not
// empty, or throws InputError; what is written of it is the same grid.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>

#include "base/error.h"
#include "scenedesc/volumes/vol_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace lumirank::scenedesc;
  const std::string bytes(reinterpret_cast<const char*>(data), size);
  GridData grid;
  try {
    grid = parse_vol(bytes, "fuzz.vol");
  } catch (const lumirank::InputError&) {
    return 0;
  }
  std::size_t count = static_cast<std::size_t>(grid.channels);
  for (const int places : grid.size) count *= static_cast<std::size_t>(places);
  if (count == 0 || count != grid.values.size()) __builtin_trap();
  for (int axis = 0; axis < 3; ++axis)
    if (!(grid.hi[axis] > grid.lo[axis])) __builtin_trap();
  for (const float value : grid.values)
    if (!std::isfinite(value)) __builtin_trap();
  const GridData again = parse_vol(vol_bytes(grid), "again.vol");
  if (again.size != grid.size || again.channels != grid.channels || again.values != grid.values)
    __builtin_trap();
  return 0;
}
