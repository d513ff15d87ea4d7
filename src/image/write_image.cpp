#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>

#include "base/error.h"
#include "image/atomic_file.h"
#include "image/exr_file.h"
#include "image/image_io.h"
#include "image/pfm.h"
#include "image/png_file.h"

namespace lumirank::image {
namespace {

std::string extension_of(const std::string& filename) {
  std::string extension = std::filesystem::path(filename).extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension;
}

std::string require_known_extension(const std::string& filename) {
  std::string extension = extension_of(filename);
  if (extension != ".exr" && extension != ".pfm" && extension != ".png")
    throw InputError(SourceLocation{filename, 0},
                     extension.empty() ? "an image's file name needs an extension"
                                       : "images cannot be written as " + extension,
                     "use .exr, .pfm or .png");
  return extension;
}

// Whatever an encoder throws, as an InputError.
template <typename Write>
void guarded_write(const std::string& filename, const Write& write) {
  try {
    write();
  } catch (const InputError&) {
    throw;
  } catch (const InternalError&) {
    throw;
  } catch (const Cancelled&) {
    throw;
  } catch (const std::exception& failure) {
    throw InputError(SourceLocation{filename, 0}, std::string("cannot write the image: ") + failure.what());
  }
}

void write_exr_file(const std::string& filename, const LayeredImage& image) {
  AtomicFile file(filename);
  std::ofstream out(file.temporary(), std::ios::binary);
  write_exr(out, image, Precision::single);
  out.close();
  if (!out) throw std::runtime_error("not all of it could be written; is the disk full?");
  file.commit();
}

}  // namespace

std::string encode_exr(const Image& image, Precision precision) {
  std::ostringstream out(std::ios::binary);
  write_exr(out, {image, {}}, precision);
  return std::move(out).str();
}

void check_writable(const std::string& filename) {
  require_known_extension(filename);
  const AtomicFile probe(filename);
}

void write_image(const std::string& filename, const LayeredImage& image, const DisplayOptions& display) {
  const std::string extension = require_known_extension(filename);
  const Image& color = image.color;
  if (color.width <= 0 || color.height <= 0 ||
      color.pixels.size() != static_cast<std::size_t>(color.width) * color.height)
    throw InternalError("an image to be written is empty or lacks pixels");
  guarded_write(filename, [&] {
    if (extension == ".exr") {
      write_exr_file(filename, image);
    } else if (extension == ".pfm") {
      write_pfm(filename, color);
    } else {
      write_whole_file(filename, encode_png(color.width, color.height, to_display(color, display)));
    }
  });
}

}  // namespace lumirank::image
