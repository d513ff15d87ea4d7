#include "image/exr_header.h"

#include <array>
#include <cstdint>
#include <cstring>
#include <fstream>

#include "base/error.h"

namespace lumirank::image {
namespace {

struct Part {
  std::array<std::int32_t, 4> window{0, 0, 0, 0};  // least x and y, largest x and y
  std::array<std::uint32_t, 2> tile{0, 0};         // 0: stored in lines
  bool has_window = false;
};

// Names end in a zero byte and have at most 255 others.
bool read_name(std::istream& in, std::string& name) {
  name.clear();
  for (int c = in.get(); c > 0 && name.size() < 256; c = in.get()) name += static_cast<char>(c);
  return in && name.size() < 256;
}

[[noreturn]] void fail(const std::string& filename, const std::string& why) {
  throw InputError(SourceLocation{filename, 0}, "cannot read the image: " + why);
}

// Attributes are: name, type, size, value; an empty name ends them. False: no further part, or not readable.
bool read_part(std::istream& in, Part& part, const std::string& filename, std::uint64_t file_size) {
  std::string name, type;
  bool any = false;
  while (read_name(in, name) && !name.empty()) {
    any = true;
    std::int32_t size = 0;
    if (!read_name(in, type) || !in.read(reinterpret_cast<char*>(&size), 4) || size < 0) return false;
    const auto next = in.tellg() + static_cast<std::streamoff>(size);
    // The decoder would take memory for it first, and then miss the bytes.
    if (static_cast<std::uint64_t>(next) > file_size)
      fail(filename, "its header promises more than the file holds");
    if (name == "dataWindow" && size == 16) {
      part.has_window = static_cast<bool>(in.read(reinterpret_cast<char*>(part.window.data()), 16));
    } else if (name == "tiles" && size == 9) {
      in.read(reinterpret_cast<char*>(part.tile.data()), 8);
    }
    in.seekg(next);
  }
  return any && in;
}

void check(const Part& part, const std::string& filename, std::size_t max_pixels, std::uint64_t file_size) {
  const std::int64_t width = std::int64_t{part.window[2]} - part.window[0] + 1;
  const std::int64_t height = std::int64_t{part.window[3]} - part.window[1] + 1;
  if (width <= 0 || height <= 0) fail(filename, "its data window is empty");
  if (static_cast<std::uint64_t>(width) > max_pixels / static_cast<std::uint64_t>(height))
    throw InputError(SourceLocation{filename, 0},
                     "the image has " + std::to_string(width) + " x " + std::to_string(height) +
                         " pixels, more than the limit of " + std::to_string(max_pixels));
  // Eight bytes for every chunk, which is a tile or at most 256 lines.
  const auto pieces = [](std::int64_t size, std::int64_t piece) {
    return static_cast<std::uint64_t>((size + piece - 1) / piece);
  };
  const std::uint64_t chunks = part.tile[0] > 0 && part.tile[1] > 0
                                   ? pieces(width, part.tile[0]) * pieces(height, part.tile[1])
                                   : pieces(height, 256);
  if (chunks > file_size / 8) fail(filename, "its header promises more than the file holds");
}

}  // namespace

void require_sane_exr_header(const std::string& filename, std::size_t max_pixels) {
  std::ifstream in(filename, std::ios::binary);
  std::array<unsigned char, 8> start{};
  if (!in.read(reinterpret_cast<char*>(start.data()), 8) ||
      std::memcmp(start.data(), "\x76\x2f\x31\x01", 4) != 0)
    return;
  in.seekg(0, std::ios::end);
  const auto file_size = static_cast<std::uint64_t>(in.tellg());
  in.seekg(8);
  const bool several_parts = start[5] & 0x10;
  do {
    Part part;
    if (!read_part(in, part, filename, file_size)) return;
    if (part.has_window) check(part, filename, max_pixels, file_size);
  } while (several_parts);
}

}  // namespace lumirank::image
