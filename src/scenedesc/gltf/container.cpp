#include "scenedesc/gltf/container.h"

#include <cstdint>

#include "base/error.h"

namespace lumirank::scenedesc::gltf {
namespace {

// Little-endian, wherever this runs.
std::uint32_t word(std::string_view bytes, std::size_t at) {
  std::uint32_t value = 0;
  for (int k = 3; k >= 0; --k) value = value << 8 | static_cast<unsigned char>(bytes[at + k]);
  return value;
}

constexpr std::uint32_t kJson = 0x4e4f534a, kBinary = 0x004e4942;

}  // namespace

Container open_container(std::string_view bytes, const std::string& filename) {
  if (!bytes.starts_with("glTF")) {
    if (bytes.starts_with("\xef\xbb\xbf")) bytes.remove_prefix(3);  // a byte order mark
    return {bytes, {}, false};
  }
  const auto fail = [&](const std::string& message) {
    throw InputError({filename, 0}, message, "export the file again");
  };
  if (bytes.size() < 12) fail("this .glb file ends within its header");
  if (word(bytes, 4) != 2)
    throw InputError({filename, 0},
                     "this .glb file has the container version " + std::to_string(word(bytes, 4)),
                     "version 2 can be read");
  if (word(bytes, 8) > bytes.size())
    fail("this .glb file is truncated: it says to have " + std::to_string(word(bytes, 8)) +
         " bytes and has " + std::to_string(bytes.size()));
  bytes = bytes.substr(0, word(bytes, 8));
  Container out;
  out.is_glb = true;
  bool json = false, binary = false;
  for (std::size_t at = 12; at < bytes.size();) {
    if (bytes.size() - at < 8) fail("this .glb file ends within the header of a chunk");
    const std::size_t length = word(bytes, at);
    const std::uint32_t type = word(bytes, at + 4);
    at += 8;
    if (length > bytes.size() - at)
      fail("a chunk of this .glb file says to have " + std::to_string(length) + " bytes, and " +
           std::to_string(bytes.size() - at) + " are left");
    if (!json && type != kJson) fail("the first chunk of this .glb file is not its JSON");
    if (type == kJson && !json) {
      out.json = bytes.substr(at, length);
      json = true;
    } else if (type == kBinary && !binary) {
      out.binary = bytes.substr(at, length);
      binary = true;
    }  // others are to be passed over
    at += length;
  }
  if (!json) fail("this .glb file has no JSON chunk");
  return out;
}

}  // namespace lumirank::scenedesc::gltf
