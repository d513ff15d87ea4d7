// Image files. Writers write to a temporary name beside the target and rename: a file is whole or absent.
#pragma once

#include <span>
#include <string>

#include "image/image.h"

namespace lumirank::image {

enum class ToneMap { none, reinhard, agx };
struct DisplayOptions {
  float exposure = 0;  // stops
  ToneMap tonemap = ToneMap::none;
};

// By extension: .exr (all layers, 32-bit float), .pfm (color only), .png (8-bit sRGB after exposure and tone
// map). Throws InputError for an unknown extension or an unwritable path.
void write_image(const std::string& filename, const LayeredImage& image, const DisplayOptions& display = {});
// An OpenEXR file in memory, of floats of 16 or 32 bits.
enum class Precision { half, single };
std::string encode_exr(const Image& image, Precision precision);
// Throws before any work is done if write_image could not write there.
void check_writable(const std::string& filename);

// EXR, PFM, Radiance, PNG and JPEG files, told apart by their first bytes, and what else OpenImageIO reads
// (see other_formats.h). Float values as stored; files of whole numbers are decoded from sRGB unless raw.
// Throws InputError (missing, truncated, not an image, larger than max_pixels).
struct LoadedImage {
  Image color;
  std::vector<float> alpha;  // empty if the file has none
};
LoadedImage read_image(const std::string& filename, bool raw = false,
                       std::size_t max_pixels = std::size_t{1} << 28);
// The same of a PNG or JPEG file that lies in memory; `name` names it in messages.
LoadedImage decode_image(const std::string& bytes, const std::string& name, bool raw = false,
                         std::size_t max_pixels = std::size_t{1} << 28);

// 8-bit sRGB pixels of one image, row-major RGB.
// Stops that show a picture (r, g, b for each pixel) of which else next to nothing would be seen: nine tenths
// of what is lit are above 1, or 99 of 100 below 1/50. Then a tenth of it becomes brighter than 1/2, in half
// stops. 0 for all others.
double exposure_to_see(std::span<const float> rgb);

std::vector<unsigned char> to_display(const Image& image, const DisplayOptions& display);

}  // namespace lumirank::image
