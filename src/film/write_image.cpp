#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <filesystem>

#include "base/error.h"
#include "film/atomic_file.h"
#include "film/image_io.h"
#include "film/pfm.h"

namespace lumirank::film {
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

void write_with_oiio(const std::string& filename, const char* format, const OIIO::ImageSpec& spec,
                     const OIIO::TypeDesc& type, const void* data) {
  AtomicFile file(filename);
  const auto fail = [&](const std::string& why) {
    throw InputError(SourceLocation{filename, 0}, "cannot write the image: " + why);
  };
  try {
    const auto output = OIIO::ImageOutput::create(format);
    if (!output) fail(OIIO::geterror());
    output->threads(1);
    if (!output->open(file.temporary(), spec)) fail(output->geterror());
    if (!output->write_image(type, data) || !output->close()) fail(output->geterror());
  } catch (const InputError&) {
    throw;
  } catch (const std::exception& error) {
    fail(error.what());
  }
  file.commit();
}

struct Interleaved {
  OIIO::ImageSpec spec;
  std::vector<float> data;
};

Interleaved as_exr(const LayeredImage& image) {
  const std::size_t pixels = image.color.pixels.size();
  const int channels = 3 * static_cast<int>(1 + image.layers.size());
  OIIO::ImageSpec spec(image.color.width, image.color.height, channels, OIIO::TypeDesc::FLOAT);
  spec.channelnames = {"R", "G", "B"};
  std::vector<float> data(pixels * channels);
  const auto interleave = [&](const Image& source, std::size_t first) {
    for (std::size_t i = 0; i < pixels; ++i)
      for (int c = 0; c < 3; ++c) data[i * channels + first + c] = source.pixels[i][c];
  };
  interleave(image.color, 0);
  for (std::size_t k = 0; k < image.layers.size(); ++k) {
    const auto& [name, layer] = image.layers[k];
    if (layer.width != image.color.width || layer.height != image.color.height)
      throw InternalError("layer '" + name + "' differs in size from its picture");
    for (const char* channel : {".R", ".G", ".B"}) spec.channelnames.push_back(name + channel);
    interleave(layer, 3 * (k + 1));
  }
  spec.attribute("compression", "zip");
  spec.attribute("oiio:ColorSpace", "Linear");
  return {std::move(spec), std::move(data)};
}

void write_exr(const std::string& filename, const LayeredImage& image) {
  const Interleaved exr = as_exr(image);
  write_with_oiio(filename, "openexr", exr.spec, OIIO::TypeDesc::FLOAT, exr.data.data());
}

void write_png(const std::string& filename, const Image& image, const DisplayOptions& display) {
  OIIO::ImageSpec spec(image.width, image.height, 3, OIIO::TypeDesc::UINT8);
  spec.attribute("oiio:ColorSpace", "sRGB");
  const std::vector<unsigned char> bytes = to_display(image, display);
  write_with_oiio(filename, "png", spec, OIIO::TypeDesc::UINT8, bytes.data());
}

}  // namespace

std::string encode_exr(const Image& image, Precision precision) {
  Interleaved exr = as_exr({image, {}});
  if (precision == Precision::half) exr.spec.set_format(OIIO::TypeDesc::HALF);
  std::vector<unsigned char> bytes;
  OIIO::Filesystem::IOVecOutput memory(bytes);
  const auto output = OIIO::ImageOutput::create("openexr", &memory);
  if (!output) throw InternalError("OpenImageIO cannot write OpenEXR: " + OIIO::geterror());
  output->threads(1);
  if (!output->open("picture.exr", exr.spec) ||
      !output->write_image(OIIO::TypeDesc::FLOAT, exr.data.data()) || !output->close())
    throw InternalError("a picture in memory cannot be encoded: " + output->geterror());
  return {bytes.begin(), bytes.end()};
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
  if (extension == ".exr") {
    write_exr(filename, image);
  } else if (extension == ".pfm") {
    write_pfm(filename, color);
  } else {
    write_png(filename, color, display);
  }
}

}  // namespace lumirank::film
