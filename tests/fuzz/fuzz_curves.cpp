// Whatever the bytes, the reader of curves returns lists that fit together, or throws InputError.
#include <cstddef>
#include <cstdint>
#include <string>

#include "base/error.h"
#include "scenedesc/readers.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using lumirank::scenedesc::CurvesDesc;
  if (size == 0) return 0;
  CurvesDesc curves;
  curves.filename = "fuzz.txt";
  curves.basis = static_cast<CurvesDesc::Basis>(data[0] % 3);
  curves.file_radius = data[0] & 4 ? 0.5f : 0.0f;
  try {
    const CurvesDesc read =
        lumirank::scenedesc::parse_curves({reinterpret_cast<const char*>(data) + 1, size - 1}, curves);
    if (read.points.size() != read.radii.size() || read.first.front() != 0 ||
        read.first.back() != read.points.size())
      __builtin_trap();
    for (std::size_t c = 0; c + 1 < read.first.size(); ++c)
      if (read.first[c + 1] < read.first[c] + 2) __builtin_trap();
  } catch (const lumirank::InputError&) {
  }
  return 0;
}
