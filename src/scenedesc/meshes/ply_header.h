// The header of a PLY file. Internal to this room.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace lumirank::scenedesc {

enum class PlyFormat { ascii, little_endian, big_endian };
enum class PlyType { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

std::size_t size_of(PlyType type);

struct PlyProperty {
  std::string name;
  PlyType type = PlyType::float32;  // of the value, or of a list's items
  bool is_list = false;
  PlyType count_type = PlyType::uint8;  // lists only
};

struct PlyElement {
  std::string name;
  std::uint64_t count = 0;  // as claimed: not yet compared with the size of the file
  std::vector<PlyProperty> properties;

  bool has_list() const;
  // The least number of bytes that one such element takes in a body of this format.
  std::size_t min_size(PlyFormat format) const;
  // The first of the names that is a plain (or list) property; -1: none.
  int find(std::initializer_list<std::string_view> names, bool list) const;
};

struct PlyHeader {
  PlyFormat format = PlyFormat::ascii;
  std::vector<PlyElement> elements;
  std::size_t body = 0;  // offset of the first byte after the header
  int lines = 0;         // of the header
};

// InputError with the line if this is no PLY header.
PlyHeader parse_ply_header(std::string_view bytes, const std::string& filename);

}  // namespace lumirank::scenedesc
