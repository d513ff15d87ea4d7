#include "image/pfm.h"

#include <bit>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <limits>
#include <sstream>

#include "base/error.h"
#include "image/atomic_file.h"

namespace lumirank::image {

static_assert(std::endian::native == std::endian::little && sizeof(Rgb) == 3 * sizeof(float));

void write_pfm(const std::string& filename, const Image& image) {
  AtomicFile file(filename);
  std::ofstream out(file.temporary(), std::ios::binary);
  out << "PF\n" << image.width << " " << image.height << "\n-1.0\n";
  const std::size_t row_bytes = static_cast<std::size_t>(image.width) * sizeof(Rgb);
  for (int y = image.height; y-- > 0;)
    out.write(reinterpret_cast<const char*>(&image.at(0, y)), static_cast<std::streamsize>(row_bytes));
  out.close();
  if (!out) throw InputError(SourceLocation{filename, 0}, "cannot write the image", "is the disk full?");
  file.commit();
}

namespace {

struct Header {
  bool color = false, swap = false;
  long long width = 0, height = 0;
};

Header read_header(std::istream& in, const std::string& filename) {
  std::string magic, scale_text;
  Header header;
  // Bounded tokens: a binary file without a space must not be swallowed whole.
  char token[64];
  const auto next = [&] {
    in.width(sizeof token);
    in >> token;
    return std::string(in ? token : "");
  };
  magic = next();
  const auto number = [&] {
    std::istringstream text(next());
    long long value = 0;
    text >> value;
    return text && text.eof() ? value : 0;
  };
  header.width = number();
  header.height = number();
  scale_text = next();
  in.get();  // exactly one white space before the pixels
  std::istringstream scale_stream(scale_text);
  double scale = 0;
  scale_stream >> scale;
  if (!in || (magic != "PF" && magic != "Pf") || !scale_stream || scale == 0)
    throw InputError(SourceLocation{filename, 0}, "not a PFM image: its header is malformed");
  header.color = magic == "PF";
  header.swap = scale > 0;
  return header;
}

float to_native(float value, bool swap) {
  return swap ? std::bit_cast<float>(__builtin_bswap32(std::bit_cast<std::uint32_t>(value))) : value;
}

}  // namespace

Image read_pfm(const std::string& filename, std::size_t max_pixels) {
  std::ifstream in(filename, std::ios::binary);
  if (!in)
    throw InputError(SourceLocation{filename, 0},
                     std::string("cannot open the image: ") + std::strerror(errno));
  const Header header = read_header(in, filename);
  constexpr long long max_size = std::numeric_limits<int>::max();
  if (header.width <= 0 || header.height <= 0 || header.width > max_size || header.height > max_size)
    throw InputError(SourceLocation{filename, 0},
                     "the image's size in its header is not positive, or absurd");
  const auto pixels =
      static_cast<unsigned long long>(header.width) * static_cast<unsigned long long>(header.height);
  if (pixels > max_pixels)
    throw InputError(SourceLocation{filename, 0},
                     "the image has " + std::to_string(header.width) + " x " + std::to_string(header.height) +
                         " pixels, more than the limit of " + std::to_string(max_pixels));
  const std::size_t per_pixel = (header.color ? 3 : 1) * sizeof(float);
  const auto start = in.tellg();
  in.seekg(0, std::ios::end);
  const auto available = static_cast<unsigned long long>(in.tellg() - start);
  if (available < pixels * per_pixel)
    throw InputError(SourceLocation{filename, 0},
                     "the image is truncated: " + std::to_string(pixels * per_pixel) +
                         " bytes of pixels expected, " + std::to_string(available) + " found");
  in.seekg(start);

  Image image(static_cast<int>(header.width), static_cast<int>(header.height));
  std::vector<float> row(static_cast<std::size_t>(header.width) * (header.color ? 3 : 1));
  for (int y = image.height; y-- > 0;) {
    in.read(reinterpret_cast<char*>(row.data()), static_cast<std::streamsize>(row.size() * sizeof(float)));
    if (!in) throw InputError(SourceLocation{filename, 0}, "the image cannot be read to its end");
    for (std::size_t x = 0; x < static_cast<std::size_t>(image.width); ++x) {
      Rgb& pixel = image.at(static_cast<int>(x), y);
      for (int c = 0; c < 3; ++c) pixel[c] = to_native(row[header.color ? 3 * x + c : x], header.swap);
    }
  }
  return image;
}

}  // namespace lumirank::image
