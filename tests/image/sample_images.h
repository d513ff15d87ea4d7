// Small image files of all kinds, written by the formats' own libraries or by hand.
#pragma once

#include <string>
#include <vector>

namespace lumirank::image {

struct PngKind {
  int width = 9, height = 7;
  int depth = 8;  // bits
  int color = 2;  // as the format counts: 0 gray, 2 color, 3 palette, 4 gray with alpha, 6 color with alpha
  bool interlaced = false, transparent_color = false;
};
// `samples`: bytes as they lie in a row, two for 16 bits (the higher first); empty: some pattern.
void write_sample_png(const std::string& file, const PngKind& kind, std::vector<unsigned char> samples = {});

enum class JpegColors { gray, luma_chroma, rgb, inks, luma_chroma_ink };
struct JpegKind {
  int width = 9, height = 7;
  JpegColors colors = JpegColors::luma_chroma;
  bool progressive = false;
  bool every_coefficient_alone = false;  // 756 scans
};
void write_sample_jpeg(const std::string& file, const JpegKind& kind);

struct ExrKind {
  int width = 9, height = 7, left = 0, top = 0;
  std::vector<std::string> channels{"R", "G", "B"};
  char type = 'f';      // of all channels: float, half, unsigned; 'm': mixed
  int compression = 3;  // as the format counts: 3 is zip
  int tile = 0;         // 0: in lines
  bool levels = false;  // of tiles: smaller and smaller ones too
  bool upwards = false;
  int sampling = 1;  // of the last channel
};
// Channel c of pixel (x, y) is 1 + c + x / 8 + 3 y / 4.
void write_sample_exr(const std::string& file, const ExrKind& kind);

// By hand: bytes as in a file of blue, green, red (and alpha), the lowest row first.
std::string sample_tga(int width, int height, int channels, const std::string& pixels);
std::string sample_bmp(int width, int height, const std::string& pixels);
// Red, green, blue from the top.
std::string sample_tiff(int width, int height, const std::string& pixels);

std::string sample_pattern(std::size_t bytes);

// One of each kind into a folder: the names of the files. `foreign`: those that OpenImageIO has to read.
std::vector<std::string> write_all_samples(const std::string& folder, bool foreign);

}  // namespace lumirank::image
