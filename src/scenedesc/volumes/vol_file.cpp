// The format, little endian: "VOL", the version 3; 32-bit numbers: what a value is (1: a 32-bit float, 2: a
// 16-bit one, 3: a byte, 4: a direction in two bytes), the numbers of places along x, y and z, the channels;
// six floats: the box; then the values, channels fastest, then x, y, z.
#include "scenedesc/volumes/vol_file.h"

#include <bit>
#include <cmath>
#include <cstring>

#include "base/error.h"
#include "scenedesc/schema/files.h"

namespace lumirank::scenedesc {
namespace {

static_assert(std::endian::native == std::endian::little, "the format is read as it lies in memory");

constexpr std::size_t kVolHeader = 48;
constexpr std::int32_t kFloats = 1, kHalfFloats = 2, kBytes = 3, kDirections = 4;  // what a value is
// Numbers of the largest grid: 8 GB of floats.
constexpr std::uint64_t kMaxValues = std::uint64_t{1} << 31;

[[noreturn]] void refuse(const std::string& filename, const std::string& message, const std::string& remedy) {
  throw InputError({filename, 0}, message, remedy);
}

template <typename T>
T number_at(const std::string& bytes, std::size_t at) {
  T value;
  std::memcpy(&value, bytes.data() + at, sizeof(T));
  return value;
}

float half_to_float(std::uint16_t bits) {
  const int exponent = bits >> 10 & 31, fraction = bits & 1023;
  const float size = exponent == 0    ? std::ldexp(static_cast<float>(fraction), -24)
                     : exponent == 31 ? (fraction ? NAN : INFINITY)
                                      : std::ldexp(static_cast<float>(fraction + 1024), exponent - 25);
  return bits & 0x8000 ? -size : size;
}

std::size_t bytes_of_value(std::int32_t encoding, const std::string& filename) {
  if (encoding == kFloats) return 4;
  if (encoding == kHalfFloats) return 2;
  if (encoding == kBytes) return 1;
  if (encoding == kDirections)
    refuse(filename, "the volume holds directions, not densities or colors",
           "name a grid of floats or bytes");
  refuse(filename, "the encoding " + std::to_string(encoding) + " of the volume is not known",
         "floats (1), half floats (2) and bytes (3) are");
}

}  // namespace

GridData parse_vol(const std::string& bytes, const std::string& filename) {
  if (bytes.size() < kVolHeader || bytes.compare(0, 3, "VOL") != 0)
    refuse(filename, "this is not a volume of Mitsuba's (it does not begin with VOL and a header)",
           "export the grid as .vol");
  if (bytes[3] != 3)
    refuse(filename,
           "version " + std::to_string(static_cast<unsigned char>(bytes[3])) + " of the format is not known",
           "export the grid as version 3");
  GridData out;
  const std::size_t width = bytes_of_value(number_at<std::int32_t>(bytes, 4), filename);
  std::uint64_t count = 1;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    out.size[axis] = number_at<std::int32_t>(bytes, 8 + 4 * axis);
    if (out.size[axis] < 1 || count * static_cast<std::uint64_t>(out.size[axis]) > kMaxValues)
      refuse(
          filename,
          "the grid has " + std::to_string(out.size[axis]) + " places along " + std::string(1, "xyz"[axis]),
          "at least 1 and 2³¹ in all are possible");
    count *= static_cast<std::uint64_t>(out.size[axis]);
  }
  out.channels = number_at<std::int32_t>(bytes, 20);
  if (out.channels != 1 && out.channels != 3)
    refuse(filename, "the volume has " + std::to_string(out.channels) + " channels", "1 and 3 are possible");
  count *= static_cast<std::uint64_t>(out.channels);
  if (count > kMaxValues) refuse(filename, "the volume has more than 2³¹ numbers", "make it coarser");
  const std::uint64_t given = bytes.size() - kVolHeader;
  if (given != count * width)
    refuse(filename,
           "the volume should have " + std::to_string(count * width) + " bytes of values and has " +
               std::to_string(given),
           given < count * width ? "the file was cut off: copy it again" : "export it again");
  for (std::size_t axis = 0; axis < 3; ++axis) {
    out.lo[static_cast<int>(axis)] = number_at<float>(bytes, 24 + 4 * axis);
    out.hi[static_cast<int>(axis)] = number_at<float>(bytes, 36 + 4 * axis);
  }
  if (!is_finite(out.lo) || !is_finite(out.hi) ||
      !(out.hi.x > out.lo.x && out.hi.y > out.lo.y && out.hi.z > out.lo.z))
    refuse(filename, "the box of the volume is empty or not finite",
           "its upper corner must lie above its lower one");

  out.values.resize(static_cast<std::size_t>(count));
  for (std::size_t k = 0; k < out.values.size(); ++k) {
    const std::size_t at = kVolHeader + k * width;
    out.values[k] = width == 4   ? number_at<float>(bytes, at)
                    : width == 2 ? half_to_float(number_at<std::uint16_t>(bytes, at))
                                 : static_cast<float>(static_cast<unsigned char>(bytes[at])) / 255.0f;
    if (!std::isfinite(out.values[k]))
      refuse(filename, "number " + std::to_string(k) + " of the volume is not finite", "export it again");
  }
  return out;
}

GridData read_vol(const std::string& filename, bool* floats) {
  const std::string bytes = read_file(filename, SourceLocation{}, kVolHeader + 4 * kMaxValues);
  GridData out = parse_vol(bytes, filename);
  if (floats) *floats = number_at<std::int32_t>(bytes, 4) == kFloats;
  return out;
}

std::string vol_bytes(const GridData& grid) {
  std::string out = "VOL\3";
  out.reserve(kVolHeader + 4 * grid.values.size());
  const auto put = [&](auto value) {
    char bytes[4];
    static_assert(sizeof value == sizeof bytes);
    std::memcpy(bytes, &value, sizeof bytes);
    out.append(bytes, sizeof bytes);
  };
  put(kFloats);
  for (const int places : grid.size) put(std::int32_t{places});
  put(std::int32_t{grid.channels});
  for (const Vec3f& corner : {grid.lo, grid.hi})
    for (int axis = 0; axis < 3; ++axis) put(corner[axis]);
  for (const float value : grid.values) put(value);
  return out;
}

}  // namespace lumirank::scenedesc
