// Whatever the bytes, files of measured BRDFs have finite values that are not negative, or throw InputError.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>

#include "base/error.h"
#include "scatter/material.h"
#include "scatter/tensor_brdf.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace lumirank::scatter;
  const std::string bytes(reinterpret_cast<const char*>(data), size);
  try {
    if (!TensorBrdf::is_one(bytes)) {
      parse_measured(bytes, "fuzz.binary", {});
      return 0;
    }
    const TensorBrdf f(bytes, "fuzz.bsdf", {});
    for (const float x : {-0.9f, 0.0f, 0.3f})
      for (const float y : {-0.4f, 0.0f, 0.2f}) {
        const lumirank::Rgb value =
            f(lumirank::normalize({x, y, 0.5f}), lumirank::normalize({y, 0.1f, 0.7f}));
        for (int c = 0; c < 3; ++c)
          if (!(value[c] >= 0)) __builtin_trap();
      }
  } catch (const lumirank::InputError&) {
  }
  return 0;
}
