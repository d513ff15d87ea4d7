// Whatever the bytes, the reader returns a table of finite values over ascending angles, or throws
// InputError.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>

#include "base/error.h"
#include "scenedesc/ies/ies.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace lumirank::scenedesc;
  const std::string bytes(reinterpret_cast<const char*>(data), size);
  try {
    IesData ies = parse_ies(bytes, "fuzz.ies");
    if (ies.type != IesData::Type::C && size % 64 != 0) return 0;  // a large table each time
    const PolarTable t = to_polar(ies, "fuzz.ies");
    if (t.values.size() != t.theta.size() * t.phi.size()) __builtin_trap();
    for (const float v : t.values)
      if (!(v >= 0 && std::isfinite(v))) __builtin_trap();
    for (const auto* angles : {&t.theta, &t.phi})
      for (std::size_t k = 1; k < angles->size(); ++k)
        if (!((*angles)[k] > (*angles)[k - 1])) __builtin_trap();
  } catch (const lumirank::InputError&) {
  }
  return 0;
}
