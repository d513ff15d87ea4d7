#include "image/sample_images.h"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfOutputFile.h>
#include <ImfTiledOutputFile.h>
#include <half.h>
#include <png.h>

#include <cstdint>
#include <cstdio>
#include <cstring>
#include <fstream>

#include <jpeglib.h>

namespace lumirank::image {
namespace {

void write_sample(const std::string& file, const std::string& bytes) {
  std::ofstream(file, std::ios::binary) << bytes;
}

std::string little_endian(std::initializer_list<std::uint32_t> values, int bytes) {
  std::string text;
  for (const std::uint32_t v : values)
    for (int k = 0; k < bytes; ++k) text += static_cast<char>(v >> (8 * k) & 255);
  return text;
}

}  // namespace

std::string sample_pattern(std::size_t bytes) {
  std::string pattern;
  for (std::size_t i = 0; i < bytes; ++i) pattern += static_cast<char>((i * 2654435761u) >> 13 & 255);
  return pattern;
}

void write_sample_png(const std::string& file, const PngKind& kind, std::vector<unsigned char> samples) {
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
  png_infop info = png_create_info_struct(png);
  std::FILE* out = std::fopen(file.c_str(), "wb");
  png_init_io(png, out);
  png_set_IHDR(png, info, static_cast<png_uint_32>(kind.width), static_cast<png_uint_32>(kind.height),
               kind.depth, kind.color, kind.interlaced ? PNG_INTERLACE_ADAM7 : PNG_INTERLACE_NONE,
               PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  if (kind.color == PNG_COLOR_TYPE_PALETTE) {
    png_color colors[256];
    for (int i = 0; i < 256; ++i)
      colors[i] = {static_cast<png_byte>(i * 7), static_cast<png_byte>(255 - i),
                   static_cast<png_byte>(i * 3)};
    png_set_PLTE(png, info, colors, 1 << kind.depth);
    const png_byte alpha[] = {0, 128, 255};
    if (kind.transparent_color) png_set_tRNS(png, info, alpha, 2, nullptr);
  } else if (kind.transparent_color) {
    const png_color_16 color{0, 1, 1, 1, 1};
    png_set_tRNS(png, info, nullptr, 0, &color);
  }
  png_write_info(png, info);
  const int channels = kind.color == 2 ? 3 : kind.color == 4 ? 2 : kind.color == 6 ? 4 : 1;
  const auto row = static_cast<std::size_t>((kind.width * channels * kind.depth + 7) / 8);
  const auto height = static_cast<std::size_t>(kind.height);
  if (samples.empty())
    for (const char c : sample_pattern(row * height)) samples.push_back(static_cast<unsigned char>(c));
  std::vector<png_bytep> rows;
  for (std::size_t y = 0; y < height; ++y) rows.push_back(&samples[y * row]);
  png_write_image(png, rows.data());
  png_write_end(png, info);
  png_destroy_write_struct(&png, &info);
  std::fclose(out);
}

void write_sample_jpeg(const std::string& file, const JpegKind& kind) {
  struct Space {
    J_COLOR_SPACE given, stored;
    int channels;
  };
  static const Space kSpaces[] = {{JCS_GRAYSCALE, JCS_GRAYSCALE, 1},
                                  {JCS_RGB, JCS_YCbCr, 3},
                                  {JCS_RGB, JCS_RGB, 3},
                                  {JCS_CMYK, JCS_CMYK, 4},
                                  {JCS_CMYK, JCS_YCCK, 4}};
  const Space& space = kSpaces[static_cast<int>(kind.colors)];
  jpeg_compress_struct info;
  jpeg_error_mgr errors;
  info.err = jpeg_std_error(&errors);
  jpeg_create_compress(&info);
  std::FILE* out = std::fopen(file.c_str(), "wb");
  jpeg_stdio_dest(&info, out);
  info.image_width = static_cast<JDIMENSION>(kind.width),
  info.image_height = static_cast<JDIMENSION>(kind.height);
  info.input_components = space.channels, info.in_color_space = space.given;
  jpeg_set_defaults(&info);
  jpeg_set_colorspace(&info, space.stored);
  jpeg_set_quality(&info, 90, TRUE);
  if (kind.progressive) jpeg_simple_progression(&info);
  std::vector<jpeg_scan_info> scans;
  if (kind.every_coefficient_alone) {
    scans.push_back({3, {0, 1, 2, 0}, 0, 0, 0, 0});
    for (int low = 3; low >= 0; --low)
      for (int c = 0; c < 3; ++c)
        for (int k = 1; k < 64; ++k) scans.push_back({1, {c, 0, 0, 0}, k, k, low == 3 ? 0 : low + 1, low});
    info.scan_info = scans.data(), info.num_scans = static_cast<int>(scans.size());
  }
  jpeg_start_compress(&info, TRUE);
  const auto row = static_cast<std::size_t>(kind.width * space.channels);
  std::string pixels = sample_pattern(row * static_cast<std::size_t>(kind.height));
  for (std::size_t y = 0; y < static_cast<std::size_t>(kind.height); ++y) {
    JSAMPROW line = reinterpret_cast<JSAMPROW>(&pixels[y * row]);
    jpeg_write_scanlines(&info, &line, 1);
  }
  jpeg_finish_compress(&info);
  jpeg_destroy_compress(&info);
  std::fclose(out);
}

void write_sample_exr(const std::string& file, const ExrKind& kind) {
  const Imath::Box2i window({kind.left, kind.top}, {kind.left + kind.width - 1, kind.top + kind.height - 1});
  Imf::Header header(window, window);
  header.compression() = static_cast<Imf::Compression>(kind.compression);
  if (kind.upwards) header.lineOrder() = Imf::DECREASING_Y;
  Imf::FrameBuffer frame;
  std::vector<std::vector<char>> planes;
  for (std::size_t c = 0; c < kind.channels.size(); ++c) {
    const int sampling = c + 1 == kind.channels.size() ? kind.sampling : 1;
    const char letter = kind.type == 'm' ? "hfu"[c % 3] : kind.type;
    const Imf::PixelType type = letter == 'h' ? Imf::HALF : letter == 'f' ? Imf::FLOAT : Imf::UINT;
    const std::size_t size = letter == 'h' ? 2 : 4;
    std::vector<char>& plane = planes.emplace_back(size * static_cast<std::size_t>(kind.width * kind.height));
    for (int i = 0; i < kind.width * kind.height; ++i) {
      const float value = 1 + static_cast<float>(c) + static_cast<float>(i % kind.width) / 8 +
                          3 * static_cast<float>(i / kind.width) / 4;
      const half small(value);
      const auto whole = letter == 'u' ? static_cast<std::uint32_t>(value * 300000001.0f) : 0u;
      const void* from = letter == 'h'   ? static_cast<const void*>(&small)
                         : letter == 'f' ? static_cast<const void*>(&value)
                                         : &whole;
      std::memcpy(&plane[size * static_cast<std::size_t>(i)], from, size);
    }
    header.channels().insert(kind.channels[c].c_str(), Imf::Channel(type, sampling, sampling));
    frame.insert(kind.channels[c].c_str(),
                 Imf::Slice::Make(type, plane.data(), window, size,
                                  size * static_cast<std::size_t>(kind.width), sampling, sampling));
  }
  if (kind.tile == 0) {
    Imf::OutputFile out(file.c_str(), header, 0);
    out.setFrameBuffer(frame);
    out.writePixels(kind.height);
    return;
  }
  header.setTileDescription(Imf::TileDescription(static_cast<unsigned>(kind.tile),
                                                 static_cast<unsigned>(kind.tile),
                                                 kind.levels ? Imf::MIPMAP_LEVELS : Imf::ONE_LEVEL));
  Imf::TiledOutputFile out(file.c_str(), header, 0);
  out.setFrameBuffer(frame);
  for (int level = 0; level < out.numLevels(); ++level)
    out.writeTiles(0, out.numXTiles(level) - 1, 0, out.numYTiles(level) - 1, level);
}

std::string sample_tga(int width, int height, int channels, const std::string& pixels) {
  std::string file = little_endian({0, 0, 2}, 1) + std::string(9, '\0');
  file += little_endian({static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height)}, 2);
  return file + little_endian({static_cast<std::uint32_t>(8 * channels), channels == 4 ? 8u : 0u}, 1) +
         pixels;
}

std::string sample_bmp(int width, int height, const std::string& pixels) {
  const auto row = static_cast<std::size_t>(3 * width), padding = (4 - row % 4) % 4;
  std::string padded;
  for (std::size_t y = 0; y < static_cast<std::size_t>(height); ++y)
    padded += pixels.substr(y * row, row) + std::string(padding, '\0');
  const auto size = static_cast<std::uint32_t>(padded.size());
  return "BM" +
         little_endian({54 + size, 0, 54, 40, static_cast<std::uint32_t>(width),
                        static_cast<std::uint32_t>(height), 24u << 16 | 1, 0, size, 0, 0, 0, 0},
                       4) +
         padded;
}

std::string sample_tiff(int width, int height, const std::string& pixels) {
  // Header; then a directory of nine entries (tag and type, count, value); 8, 8, 8; the pixels.
  const std::uint32_t depths = 8 + 2 + 9 * 12 + 4, data = depths + 6;
  const auto entry = [](std::uint32_t tag, std::uint32_t type, std::uint32_t count, std::uint32_t value) {
    return little_endian({tag, type}, 2) + little_endian({count, value}, 4);
  };
  const auto w = static_cast<std::uint32_t>(width), h = static_cast<std::uint32_t>(height);
  return "II*" + std::string(1, '\0') + little_endian({8}, 4) + little_endian({9}, 2) + entry(256, 3, 1, w) +
         entry(257, 3, 1, h) + entry(258, 3, 3, depths) + entry(259, 3, 1, 1) + entry(262, 3, 1, 2) +
         entry(273, 4, 1, data) + entry(277, 3, 1, 3) + entry(278, 3, 1, h) +
         entry(279, 4, 1, static_cast<std::uint32_t>(pixels.size())) + little_endian({0}, 4) +
         little_endian({8, 8, 8}, 2) + pixels;
}

std::vector<std::string> write_all_samples(const std::string& folder, bool foreign) {
  std::vector<std::string> names;
  const auto next = [&](const std::string& name) { return names.emplace_back(folder + "/" + name); };
  if (foreign) {
    const std::string pixels = sample_pattern(9 * 7 * 4);
    write_sample(next("a.tga"), sample_tga(9, 7, 3, pixels.substr(0, 9 * 7 * 3)));
    write_sample(next("b.tga"), sample_tga(9, 7, 4, pixels));
    write_sample(next("a.bmp"), sample_bmp(9, 7, pixels.substr(0, 9 * 7 * 3)));
    write_sample(next("a.tif"), sample_tiff(9, 7, pixels.substr(0, 9 * 7 * 3)));
    return names;
  }
  for (const int color : {0, 2, 3, 4, 6})
    for (const int depth : {1, 2, 4, 8, 16})
      for (const bool interlaced : {false, true})
        for (const bool transparent : {false, true}) {
          if ((depth < 8 && color != 0 && color != 3) || (depth == 16 && color == 3)) continue;
          if (transparent && color > 3) continue;
          const std::string name = "c" + std::to_string(color) + "d" + std::to_string(depth) +
                                   (interlaced ? "i" : "") + (transparent ? "t" : "") + ".png";
          write_sample_png(next(name), {9, 7, depth, color, interlaced, transparent});
        }
  for (int colors = 0; colors < 5; ++colors)
    for (const bool progressive : {false, true})
      write_sample_jpeg(next("c" + std::to_string(colors) + (progressive ? "p" : "") + ".jpg"),
                        {21, 19, static_cast<JpegColors>(colors), progressive, false});
  for (int compression = 0; compression < 10; ++compression)
    for (const char type : {'h', 'f'})
      for (const int tile : {0, 16})
        write_sample_exr(next("z" + std::to_string(compression) + type + std::to_string(tile) + ".exr"),
                         {37, 35, 0, 0, {"R", "G", "B", "A"}, type, compression, tile, type == 'h'});
  write_sample_exr(next("window.exr"), {9, 7, -5, 40, {"R", "G", "B"}});
  write_sample_exr(next("window_tiles.exr"), {9, 7, 3, -40, {"R", "G", "B"}, 'h', 4, 4});
  write_sample_exr(next("upwards.exr"), {37, 35, 0, 0, {"R", "G", "B"}, 'h', 3, 0, false, true});
  write_sample_exr(next("unsigned.exr"), {9, 7, 0, 0, {"R", "G", "B", "A"}, 'u'});
  write_sample_exr(next("mixed.exr"), {9, 7, 0, 0, {"R", "G", "B", "A"}, 'm'});
  int number = 0;
  for (const std::vector<std::string>& channels :
       std::vector<std::vector<std::string>>{{"Y"},
                                             {"Y", "A"},
                                             {"A"},
                                             {"Z"},
                                             {"X", "Y", "Z"},
                                             {"n.Z", "n.Y", "n.X", "n.A"},
                                             {"red", "green", "blue", "alpha"},
                                             {"b.R", "b.G", "b.B", "a.R", "a.G", "a.B"},
                                             {"R", "G", "B", "x.A"},
                                             {"R", "G", "Z"},
                                             {"beta", "alpha", "Zback", "Y", "q"},
                                             {"u", "v"}})
    write_sample_exr(next("channels" + std::to_string(++number) + ".exr"), {9, 7, 0, 0, channels, 'h'});
  return names;
}

}  // namespace lumirank::image
