// The values of a PLY file's body one after the other, whatever the format. Internal to this room.
#pragma once

#include <bit>
#include <cmath>
#include <cstring>
#include <string>
#include <utility>

#include "base/error.h"
#include "scenedesc/meshes/ply_header.h"
#include "scenedesc/meshes/scan.h"

namespace lumirank::scenedesc {

class PlyBody {
 public:
  PlyBody(std::string_view bytes, const PlyHeader& header, const std::string& filename)
      : p_(bytes.data() + header.body),
        end_(bytes.data() + bytes.size()),
        format_(header.format),
        line_(header.lines + 1),
        filename_(filename) {}

  std::size_t bytes_left() const { return static_cast<std::size_t>(end_ - p_); }
  bool is_text() const { return format_ == PlyFormat::ascii; }

  // Where the reader is, for messages.
  void enter(const PlyElement& element, std::uint64_t index) { element_ = &element, index_ = index; }
  [[noreturn]] void fail(const std::string& message) const {
    const std::string at = element_ ? quoted_word(element_->name) + " " + std::to_string(index_) + ": " : "";
    throw InputError({filename_, is_text() ? line_ : 0}, at + message, "repair or export the file again");
  }

  // Any value as a double: exact for all types.
  double value(PlyType type) {
    switch (format_) {
      case PlyFormat::ascii:
        return text(type);
      case PlyFormat::little_endian:
        return binary<std::endian::little>(type);
      case PlyFormat::big_endian:
        return binary<std::endian::big>(type);
    }
    return 0;
  }

  // The length of a list, whose items are known to be there (in binary) or may be (in text).
  std::size_t list_length(const PlyProperty& p) {
    const double n = value(p.count_type);
    if (!(n >= 0)) fail("a list of negative length");
    const std::size_t item = is_text() ? 2 : size_of(p.type);
    // The last item of a text needs nothing after it.
    if (n * static_cast<double>(item) > static_cast<double>(bytes_left() + 1))
      fail("the file ends within a list");
    return static_cast<std::size_t>(n);
  }

  void skip(const PlyProperty& p) {
    if (!p.is_list) return skip_values(p.type, 1);
    skip_values(p.type, list_length(p));
  }

  void skip_values(PlyType type, std::size_t n) {
    if (!is_text()) return advance(n * size_of(type));
    for (std::size_t k = 0; k < n; ++k) value(type);
  }

  // n bytes that need no reading one by one (binary only).
  const char* take(std::size_t n) {
    const char* at = p_;
    advance(n);
    return at;
  }

 private:
  void advance(std::size_t n) {
    if (n > bytes_left()) fail("the file ends here");
    p_ += n;
  }

  double text(PlyType type) {
    while (p_ != end_ && (is_blank(*p_) || *p_ == '\n')) line_ += *p_++ == '\n';
    if (p_ == end_) fail("the file ends here");
    const char* first = p_;
    double f = 0;
    std::int64_t i = 0;
    const bool real = type == PlyType::float32 || type == PlyType::float64;
    const bool good = real ? parse_float(p_, end_, f) : parse_integer(p_, end_, i);
    if (!good || (p_ != end_ && !is_blank(*p_) && *p_ != '\n')) {
      const char* q = first;
      fail(quoted_word(take_word(q, end_)) + " is not " + (real ? "a number" : "an integer"));
    }
    return real ? f : static_cast<double>(i);
  }

  template <std::endian kOrder>
  double binary(PlyType type) {
    switch (type) {
      case PlyType::int8:
        return load<std::int8_t, kOrder>();
      case PlyType::uint8:
        return load<std::uint8_t, kOrder>();
      case PlyType::int16:
        return load<std::int16_t, kOrder>();
      case PlyType::uint16:
        return load<std::uint16_t, kOrder>();
      case PlyType::int32:
        return load<std::int32_t, kOrder>();
      case PlyType::uint32:
        return load<std::uint32_t, kOrder>();
      case PlyType::float32:
        return load<float, kOrder>();
      case PlyType::float64:
        return load<double, kOrder>();
    }
    return 0;
  }

  template <typename T, std::endian kOrder>
  T load() {
    char raw[sizeof(T)];
    std::memcpy(raw, take(sizeof(T)), sizeof(T));
    if constexpr (kOrder != std::endian::native)
      for (std::size_t k = 0; k < sizeof(T) / 2; ++k) std::swap(raw[k], raw[sizeof(T) - 1 - k]);
    T value;
    std::memcpy(&value, raw, sizeof(T));
    return value;
  }

  const char* p_;
  const char* end_;
  PlyFormat format_;
  int line_;
  const std::string& filename_;
  const PlyElement* element_ = nullptr;
  std::uint64_t index_ = 0;
};

}  // namespace lumirank::scenedesc
