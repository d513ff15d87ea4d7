#include "scenedesc/gltf/uri.h"

#include <array>
#include <cctype>
#include <filesystem>

#include "scenedesc/schema/files.h"

namespace lumirank::scenedesc::gltf {
namespace {
namespace fs = std::filesystem;

int hex(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return -1;
}

// Stray percent signs stay as they are.
std::string percent_decoded(const std::string& text) {
  std::string out;
  for (std::size_t k = 0; k < text.size(); ++k) {
    const int high = text[k] == '%' && k + 2 < text.size() ? hex(text[k + 1]) : -1;
    const int low = high >= 0 ? hex(text[k + 2]) : -1;
    if (low >= 0) {
      out += static_cast<char>(high * 16 + low);
      k += 2;
    } else {
      out += text[k];
    }
  }
  return out;
}

std::string base64_decoded(const std::string& text, std::size_t begin, const Element& uri) {
  static const std::array<signed char, 256> values = [] {
    std::array<signed char, 256> table;
    table.fill(-1);
    const std::string letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    for (std::size_t k = 0; k < letters.size(); ++k)
      table[static_cast<unsigned char>(letters[k])] = static_cast<signed char>(k);
    return table;
  }();
  std::size_t end = text.size();
  while (end > begin && text[end - 1] == '=' && text.size() - end < 2) --end;
  std::string out;
  out.reserve((end - begin) / 4 * 3 + 2);
  std::uint32_t bits = 0;
  int count = 0;
  for (std::size_t k = begin; k < end; ++k) {
    const auto value = values[static_cast<unsigned char>(text[k])];
    if (value < 0)
      uri.fail("has a character that is not base64, " + std::to_string(k) + " characters in",
               "encode the data again");
    bits = bits << 6 | static_cast<std::uint32_t>(value);
    if (++count == 4) {
      for (const int shift : {16, 8, 0}) out += static_cast<char>(bits >> shift & 255);
      bits = 0, count = 0;
    }
  }
  if (count == 1) uri.fail("ends within a base64 group", "encode the data again");
  if (count == 2) out += static_cast<char>(bits >> 4 & 255);
  if (count == 3) out += static_cast<char>(bits >> 10 & 255), out += static_cast<char>(bits >> 2 & 255);
  return out;
}

std::string decoded_data(const std::string& text, const Element& uri) {
  const std::size_t comma = text.find(',');
  if (comma == std::string::npos) uri.fail("is a data: URI without a comma", "write data:TYPE;base64,BYTES");
  if (text.substr(0, comma).ends_with(";base64")) return base64_decoded(text, comma + 1, uri);
  return percent_decoded(text.substr(comma + 1));
}

// "http://…", "file:…": letters, digits, +, - and . before a colon.
bool has_scheme(const std::string& text) {
  const std::size_t colon = text.find(':');
  if (colon == std::string::npos || colon < 2) return false;
  for (std::size_t k = 0; k < colon; ++k)
    if (!std::isalnum(static_cast<unsigned char>(text[k])) && text[k] != '+' && text[k] != '-' &&
        text[k] != '.')
      return false;
  return true;
}

}  // namespace

Resource resolve_uri(const Element& uri) {
  const std::string& text = uri.text();
  if (text.starts_with("data:")) return {true, decoded_data(text, uri), {}};
  std::error_code ignored;
  const std::string name = percent_decoded(text);
  if (text.empty() || name.find('\0') != std::string::npos) uri.fail("names no file", "give a file name");
  const fs::path folder = fs::path(uri.file()).parent_path();
  if (fs::path(name).is_absolute())
    uri.fail("is an absolute path",
             "glTF files name others relative to themselves: move it beside the scene");
  // A file whose very name looks like a scheme or an encoded character is still a file.
  if (!fs::exists(folder / name, ignored)) {
    if (fs::exists(folder / text, ignored))
      return {false, {}, fs::absolute(folder / text).lexically_normal().string()};
    if (has_scheme(text))
      throw MissingFile(uri.where(), uri.path() + " is not a file name",
                        "download it, and name the file relative to the scene");
  }
  return {false, {}, fs::absolute(folder / name).lexically_normal().string()};
}

std::string what_is_missing(const MissingFile& error) {
  std::string text = error.what();
  text = text.substr(0, text.find("; "));
  if (const std::string place = to_string(error.where()) + ": "; text.starts_with(place))
    text.erase(0, place.size());
  return text;
}

std::string read_resource(const std::string& filename, const Element& user) {
  std::string bytes;
  if (std::error_code error; !fs::exists(fs::status(filename, error)))
    throw MissingFile(user.where(), user.path() + " names " + filename + ", which does not exist",
                      "check the name, or leave out what needs it (--allow-missing)");
  const std::string problem = try_read_file(filename, bytes);
  if (!problem.empty()) user.fail("names " + filename + ", which " + problem, "check the name");
  return bytes;
}

std::string read_scene_file(const std::string& filename) {
  std::string bytes;
  const std::string problem = try_read_file(filename, bytes);
  if (!problem.empty()) throw InputError({filename, 0}, "the scene file " + problem, "check the name");
  return bytes;
}

}  // namespace lumirank::scenedesc::gltf
