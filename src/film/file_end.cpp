#include "film/file_end.h"

#include <array>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <iterator>

#include "base/error.h"

namespace lumirank::film {
namespace {

bool jpeg_is_whole(std::istream& in) {
  in.seekg(3);
  // Segments with a length follow the start marker; thumbnails, with end markers of their own, lie inside
  // them.
  int marker = in.get();
  while (marker != 0xda) {
    if (marker == 0xff) {  // fill byte
      marker = in.get();
      continue;
    }
    const int high = in.get(), low = in.get();
    const int length = high * 256 + low;
    if (!in || length < 2) return false;
    in.seekg(length - 2, std::ios::cur);
    if (in.get() != 0xff) return false;
    marker = in.get();
  }
  // In the entropy-coded data a 0xff is followed by 0 or a restart marker, so this pair is the end.
  int previous = 0;
  for (auto it = std::istreambuf_iterator<char>(in); it != std::istreambuf_iterator<char>(); ++it) {
    const int byte = static_cast<unsigned char>(*it);
    if (previous == 0xff && byte == 0xd9) return true;
    previous = byte;
  }
  return false;
}

// A chain of chunks: length (4 bytes, big endian), name (4), data, checksum (4); the last is called IEND.
bool png_is_whole(std::istream& in) {
  in.seekg(8);
  std::array<unsigned char, 8> head{};
  while (in.read(reinterpret_cast<char*>(head.data()), head.size())) {
    const std::uint32_t length = (std::uint32_t{head[0]} << 24) | (std::uint32_t{head[1]} << 16) |
                                 (std::uint32_t{head[2]} << 8) | std::uint32_t{head[3]};
    if (std::memcmp(&head[4], "IEND", 4) == 0) {
      std::array<char, 4> checksum;
      return static_cast<bool>(in.read(checksum.data(), checksum.size()));
    }
    in.seekg(static_cast<std::streamoff>(length) + 4, std::ios::cur);
  }
  return false;
}

}  // namespace

void require_file_end(const std::string& filename) {
  std::ifstream in(filename, std::ios::binary);
  require_file_end(in, filename);
}

void require_file_end(std::istream& in, const std::string& name) {
  std::array<unsigned char, 8> start{};
  in.read(reinterpret_cast<char*>(start.data()), start.size());
  in.clear();
  const char* format = nullptr;
  if (std::memcmp(start.data(), "\xff\xd8\xff", 3) == 0) {
    if (!jpeg_is_whole(in)) format = "JPEG";
  } else if (std::memcmp(start.data(), "\x89PNG\r\n\x1a\n", 8) == 0) {
    if (!png_is_whole(in)) format = "PNG";
  }
  if (format)
    throw InputError(SourceLocation{name, 0},
                     std::string("cannot read the image: this ") + format + " file is truncated");
}

}  // namespace lumirank::film
