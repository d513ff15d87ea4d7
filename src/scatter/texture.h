// Prepared textures: pixels in memory, looked up at a uv.
//
// Orientation: v = 0 is the bottom edge of the picture, v = 1 its top; TexturePixels keeps the top row first.
// So texel (column, row) has its center at u = (column + ½)/width, v = 1 - (row + ½)/height. Readers of file
// formats that count otherwise flip the uv or the transform; nothing here knows of it. Coordinates that are
// not finite read as 0.
#pragma once

#include <memory>
#include <variant>
#include <vector>

#include "base/rgb.h"
#include "base/vec.h"

namespace lumirank::scatter {

enum class TexFilter { nearest, bilinear };
enum class TexWrap { repeat, mirror, clamp };

// Linear RGB; row 0 is the top of the picture.
struct TexturePixels {
  int width = 0, height = 0;
  std::vector<Rgb> rgb;
};

struct SurfaceUv {
  Vec2f uv;
  Rgb vertex_color{1};
};

struct ConstantTexture {
  Rgb value;
};
struct BitmapTexture {
  std::shared_ptr<const TexturePixels> pixels;  // shared by all textures of the same file and color space
  TexFilter filter = TexFilter::bilinear;
  TexWrap wrap_u = TexWrap::repeat, wrap_v = TexWrap::repeat;
  float to_uv[6] = {1, 0, 0, 0, 1, 0};
};
struct CheckerboardTexture {
  int color0 = 0, color1 = 0;  // indices into the same texture list, each smaller than this texture's own
  float to_uv[6] = {1, 0, 0, 0, 1, 0};
};
struct ScaleTexture {
  int input = 0;
  Rgb scale{1};
};
struct ProductTexture {
  int a = 0, b = 0;
};
struct ThresholdTexture {  // channel by channel 1 where the input is at least the threshold, else 0
  int input = 0;
  float threshold = 0.5f;
};
struct MixTexture {  // (1 - amount) · a + amount · b
  int a = 0, b = 0, amount = 0;
};
struct RootTexture {  // √ of what is not negative
  int input = 0;
};
struct VertexColorTexture {};

using Texture = std::variant<ConstantTexture, BitmapTexture, CheckerboardTexture, ScaleTexture,
                             ProductTexture, MixTexture, RootTexture, ThresholdTexture, VertexColorTexture>;

// All textures of a world; a texture refers only to textures before it.
struct TextureSet {
  std::vector<Texture> textures;
  Rgb lookup(int texture, const SurfaceUv& at) const;
  // Asks memory for what lookup() of a BitmapTexture reads.
  void fetch_bitmap(int texture, const SurfaceUv& at) const;
  // The bitmaps that a texture is made of, itself included.
  void add_bitmaps(int texture, std::vector<int>& out) const;
  // Scalar inputs read the luminance of color textures (Mitsuba does the same).
  float lookup_float(int texture, const SurfaceUv& at) const;
  // ∂(lookup_float)/∂u and /∂v, for bump maps: of a bitmap that is interpolated its own slope; of one that is
  // not, by central differences of one texel.
  Vec2f gradient(int texture, const SurfaceUv& at) const;
  // Mean over the unit square.
  Rgb mean(int texture) const;
  // How many texels, or halves of a checkerboard's squares, lie along a unit of u and of v: of the finest
  // texture that it is made of; 0 where none depends on uv.
  Vec2f texels(int texture) const;
};

}  // namespace lumirank::scatter
