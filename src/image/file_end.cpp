#include "image/file_end.h"

#include <cstdint>

namespace lumirank::image {
namespace {

std::uint32_t big_endian_at(std::string_view bytes, std::size_t at, std::size_t count) {
  std::uint32_t value = 0;
  for (std::size_t k = 0; k < count; ++k) value = value << 8 | static_cast<unsigned char>(bytes[at + k]);
  return value;
}

bool jpeg_is_whole(std::string_view bytes) {
  // Segments with a length follow the start marker; thumbnails, with end markers of their own, lie inside
  // them.
  std::size_t at = 2;
  while (true) {
    if (at + 4 > bytes.size() || bytes[at] != '\xff') return false;
    while (at + 4 < bytes.size() && bytes[at + 1] == '\xff') ++at;  // fill bytes
    const std::uint32_t marker = big_endian_at(bytes, at + 1, 1);
    const std::uint32_t length = big_endian_at(bytes, at + 2, 2);
    if (length < 2) return false;
    at += 2;
    if (marker == 0xda) break;
    at += length;
  }
  // In the entropy-coded data a 0xff is followed by 0 or a restart marker, so this pair is the end.
  return bytes.find("\xff\xd9", at) != std::string_view::npos;
}

// A chain of chunks: length (4 bytes, big endian), name (4), data, checksum (4); the last is called IEND.
bool png_is_whole(std::string_view bytes) {
  std::size_t at = 8;
  while (at + 12 <= bytes.size()) {
    if (bytes.substr(at + 4, 4) == "IEND") return true;
    at += std::size_t{big_endian_at(bytes, at, 4)} + 12;
  }
  return false;
}

}  // namespace

bool has_file_end(std::string_view bytes) {
  if (bytes.starts_with("\xff\xd8\xff")) return jpeg_is_whole(bytes);
  if (bytes.starts_with("\x89PNG")) return png_is_whole(bytes);
  return true;
}

}  // namespace lumirank::image
