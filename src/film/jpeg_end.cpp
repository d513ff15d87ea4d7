#include "film/jpeg_end.h"

#include <fstream>
#include <iterator>

#include "base/error.h"

namespace lumirank::film {

void require_jpeg_end(const std::string& filename) {
  std::ifstream in(filename, std::ios::binary);
  if (in.get() != 0xff || in.get() != 0xd8 || in.get() != 0xff) return;
  const auto truncated = [&] {
    return InputError(SourceLocation{filename, 0}, "cannot read the image: this JPEG file is truncated");
  };
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
    if (!in || length < 2) throw truncated();
    in.seekg(length - 2, std::ios::cur);
    if (in.get() != 0xff) throw truncated();
    marker = in.get();
  }
  // In the entropy-coded data a 0xff is followed by 0 or a restart marker, so this pair is the end.
  int previous = 0;
  for (auto it = std::istreambuf_iterator<char>(in); it != std::istreambuf_iterator<char>(); ++it) {
    const int byte = static_cast<unsigned char>(*it);
    if (previous == 0xff && byte == 0xd9) return;
    previous = byte;
  }
  throw truncated();
}

}  // namespace lumirank::film
