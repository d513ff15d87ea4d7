#include "scenedesc/meshes/ply_header.h"

#include <array>
#include <optional>
#include <utility>

#include "base/error.h"
#include "scenedesc/meshes/scan.h"

namespace lumirank::scenedesc {
namespace {

std::optional<PlyType> type_named(std::string_view name) {
  using enum PlyType;
  constexpr std::pair<std::string_view, PlyType> kTypes[] = {
      {"char", int8},     {"int8", int8},       {"uchar", uint8},    {"uint8", uint8},
      {"short", int16},   {"int16", int16},     {"ushort", uint16},  {"uint16", uint16},
      {"int", int32},     {"int32", int32},     {"uint", uint32},    {"uint32", uint32},
      {"float", float32}, {"float32", float32}, {"double", float64}, {"float64", float64}};
  for (const auto& [text, type] : kTypes)
    if (text == name) return type;
  return std::nullopt;
}

class HeaderParser {
 public:
  HeaderParser(std::string_view bytes, const std::string& filename) : bytes_(bytes), filename_(filename) {}

  PlyHeader parse() {
    if (next_line() != "ply") fail("this is not a PLY file (it does not start with 'ply')");
    bool has_format = false;
    for (;;) {
      const std::string_view line = next_line();
      const char *p = line.data(), *end = p + line.size();
      const std::string_view keyword = take_word(p, end);
      if (keyword == "end_header") break;
      if (keyword == "format") {
        format(take_word(p, end));
        has_format = true;
      } else if (keyword == "element") {
        element(p, end);
      } else if (keyword == "property") {
        property(p, end);
      } else if (keyword != "comment" && keyword != "obj_info" && !keyword.empty()) {
        fail(quoted_word(keyword) + " in the header");
      }
    }
    if (!has_format) fail("the header names no format");
    header_.body = offset_;
    return std::move(header_);
  }

 private:
  [[noreturn]] void fail(const std::string& message) const {
    throw InputError({filename_, header_.lines}, message, "repair or export the file again");
  }

  // Without its end, which may be "\n", "\r\n" or "\r".
  std::string_view next_line() {
    ++header_.lines;
    const std::size_t end = bytes_.find_first_of("\r\n", offset_);
    if (end == std::string_view::npos) fail("the header does not end");
    const std::string_view line = bytes_.substr(offset_, end - offset_);
    offset_ = end + 1;
    if (bytes_[end] == '\r' && offset_ < bytes_.size() && bytes_[offset_] == '\n') ++offset_;
    return line;
  }

  void format(std::string_view name) {
    if (name == "ascii")
      header_.format = PlyFormat::ascii;
    else if (name == "binary_little_endian")
      header_.format = PlyFormat::little_endian;
    else if (name == "binary_big_endian")
      header_.format = PlyFormat::big_endian;
    else
      fail("unknown format " + quoted_word(name));
  }

  void element(const char* p, const char* end) {
    PlyElement e;
    e.name = take_word(p, end);
    std::int64_t count = 0;
    skip_blanks(p, end);
    if (!parse_integer(p, end, count) || count < 0)
      fail("element " + quoted_word(e.name) + " has no valid count");
    e.count = static_cast<std::uint64_t>(count);
    header_.elements.push_back(std::move(e));
  }

  PlyType type(std::string_view name) const {
    const std::optional<PlyType> t = type_named(name);
    if (!t) fail("unknown type " + quoted_word(name));
    return *t;
  }

  void property(const char* p, const char* end) {
    if (header_.elements.empty()) fail("a property before any element");
    PlyProperty property;
    std::string_view word = take_word(p, end);
    if (word == "list") {
      property.is_list = true;
      property.count_type = type(take_word(p, end));
      if (property.count_type == PlyType::float32 || property.count_type == PlyType::float64)
        fail("the length of a list is not of an integer type");
      word = take_word(p, end);
    }
    property.type = type(word);
    property.name = take_word(p, end);
    if (property.name.empty()) fail("a property without a name");
    header_.elements.back().properties.push_back(std::move(property));
  }

  std::string_view bytes_;
  const std::string& filename_;
  std::size_t offset_ = 0;
  PlyHeader header_;
};

}  // namespace

std::size_t size_of(PlyType type) {
  constexpr std::array<std::size_t, 8> kSizes{1, 1, 2, 2, 4, 4, 4, 8};
  return kSizes[static_cast<std::size_t>(type)];
}

bool PlyElement::has_list() const {
  for (const PlyProperty& p : properties)
    if (p.is_list) return true;
  return false;
}

std::size_t PlyElement::min_size(PlyFormat format) const {
  // In text each value takes a digit and what separates it from the next.
  std::size_t size = 0;
  for (const PlyProperty& p : properties)
    size += format == PlyFormat::ascii ? 2 : size_of(p.is_list ? p.count_type : p.type);
  return size;
}

int PlyElement::find(std::initializer_list<std::string_view> names, bool list) const {
  for (const std::string_view wanted : names)
    for (std::size_t k = 0; k < properties.size(); ++k)
      if (properties[k].name == wanted && properties[k].is_list == list) return static_cast<int>(k);
  return -1;
}

PlyHeader parse_ply_header(std::string_view bytes, const std::string& filename) {
  return HeaderParser(bytes, filename).parse();
}

}  // namespace lumirank::scenedesc
