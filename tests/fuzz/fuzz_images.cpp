// Whatever the bytes, the readers of PNG, JPEG and Radiance files return as many pixels as the file says, or
// throw.
#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string>

#include "base/error.h"
#include "image/image_builder.h"
#include "image/image_io.h"
#include "image/radiance_file.h"

namespace {

void require_whole(const lumirank::image::LoadedImage& image) {
  const auto pixels =
      static_cast<std::size_t>(image.color.width) * static_cast<std::size_t>(image.color.height);
  if (image.color.pixels.size() != pixels) __builtin_trap();
  if (!image.alpha.empty() && image.alpha.size() != pixels) __builtin_trap();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace lumirank::image;
  constexpr std::size_t kMaxPixels = 1 << 16;
  const std::string bytes(reinterpret_cast<const char*>(data), size);
  try {
    if (!bytes.starts_with("#?")) {
      require_whole(decode_image(bytes, "fuzz", size % 2 == 0, kMaxPixels));
      return 0;
    }
    ImageBuilder builder("fuzz.hdr", size % 2 == 0, kMaxPixels);
    read_radiance(bytes, builder);
    require_whole(builder.take());
  } catch (const std::runtime_error&) {  // InputError is one, InternalError is not
  }
  return 0;
}
