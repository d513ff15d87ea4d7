// Whatever the bytes, the reader returns a grid of as many finite numbers as it says, no more than allowed,
// in a place that has an inverse, or throws InputError. A tree takes 300 KB, which no fuzzer would come up
// with: bytes that are no file are changes to one, each its type, where and what.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>

#include "base/error.h"
#include "scenedesc/volumes/nanovdb_file.h"

namespace {

using namespace lumirank::scenedesc;

// A grid of one leaf, down a chain of nodes.
std::string file_of_type(std::uint32_t type, std::uint64_t root_size, std::uint64_t leaf_size) {
  constexpr std::size_t kGrid = 16 + 176 + 8, kTree = 672, kUpper = 270400, kLower = 33856;
  const std::size_t root = kGrid + kTree + 64, upper = root + root_size + 32, lower = upper + kUpper,
                    leaf = lower + kLower;
  std::string out(leaf + leaf_size, '\0');
  const auto put = [&](std::size_t at, auto value) { std::memcpy(out.data() + at, &value, sizeof value); };
  const std::uint64_t size = out.size() - kGrid;
  out.replace(0, 8, "NanoVDB0"), out.replace(16 + 176, 7, "density"), out.replace(kGrid, 8, "NanoVDB0");
  put(8, std::uint32_t{32} << 21), put(12, std::uint16_t{1});
  put(16, size), put(24, size), put(48, type), put(16 + 136, std::uint32_t{8});
  put(kGrid + 636, type);
  for (std::size_t k = 0; k < 3; ++k) put(kGrid + 384 + 32 * k, 1.0), put(root + 12 + 4 * k, 7);
  put(kGrid + kTree + 24, std::uint64_t{64});
  put(root + 24, std::uint32_t{1}), put(root + root_size + 8, std::uint64_t{root_size + 32});
  put(upper + 4128, '\1'), put(upper + 8256, std::uint64_t{kUpper});
  put(lower + 544, '\1'), put(lower + 1088, std::uint64_t{kLower});
  return out;
}

std::string changed(const std::uint8_t* data, std::size_t size) {
  static const std::string kFiles[] = {file_of_type(1, 64, 2144), file_of_type(2, 96, 4224),
                                       file_of_type(14, 64, 608), file_of_type(16, 64, 1120)};
  std::string out = kFiles[size > 0 ? data[0] % std::size(kFiles) : 0];
  for (std::size_t k = 1; k + 5 <= size; k += 5) {
    std::uint32_t at;
    std::memcpy(&at, data + k, sizeof at);
    out[at % out.size()] = static_cast<char>(data[k + 4]);
  }
  return out;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  constexpr std::uint64_t kMost = 1 << 12;
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  GridFile file;
  try {
    const bool whole = bytes.starts_with("NanoVDB");
    file = parse_nanovdb(whole ? std::string(bytes) : changed(data, size), "fuzz.nvdb", "", kMost);
  } catch (const lumirank::InputError&) {
    return 0;
  }
  const GridData& grid = file.numbers;
  std::size_t count = static_cast<std::size_t>(grid.channels);
  for (const int places : grid.size) count *= static_cast<std::size_t>(places);
  if (count == 0 || count > kMost || count != grid.values.size()) __builtin_trap();
  for (const float value : grid.values)
    if (!std::isfinite(value)) __builtin_trap();
  if (!file.to_file.is_finite() || !file.to_file.inverse()) __builtin_trap();
  return 0;
}
