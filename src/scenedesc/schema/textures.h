// Textures of a scene description, and the inputs (a constant or a texture) that BSDFs and lights have.
#pragma once

#include <memory>
#include <string>
#include <variant>

#include "base/error.h"
#include "base/rgb.h"

namespace lumirank::scenedesc {

inline constexpr int kNone = -1;  // "no index"

// 2×3 affine map from mesh uv to texture uv.
struct UvTransform {
  float m[6] = {1, 0, 0, 0, 1, 0};
  friend bool operator==(const UvTransform&, const UvTransform&) = default;
};

// A constant or a texture (an index into SceneDesc::textures), linear RGB.
struct ColorInput {
  Rgb value{0};
  int texture = kNone;
};
struct FloatInput {
  float value = 0;
  int texture = kNone;
};

// A file that the world reads.
struct FileInput {
  std::string name;
  bool missing = false;  // there is none, and that was allowed: a stand-in is shown (see --allow-missing)
};

enum class FilterMode { nearest, bilinear };
enum class WrapMode { repeat, mirror, clamp };
// `scalar`: what float parameters read of pictures in pbrt: the alpha channel if there is one that is not 1
// everywhere, else the mean of the channels.
enum class TextureChannel { rgb, red, green, blue, alpha, scalar };

// Texture coordinates: (u, v) = (0, 0) is the lower left corner of the picture, so v runs up and row 0 of the
// file is at v = 1. `to_uv` maps the surface's coordinates to these. Formats whose v runs down (Mitsuba: v =
// 0 is the top row) have that flip at the end of each bitmap's `to_uv`, after the format's own uv transform;
// surfaces, built-in shapes and meshes alike, keep the coordinates of their format
// (MeshFileDesc::flip_tex_coords). So wraps, scales, checkerboards and the uv of rectangles and spheres stay
// exact.
struct BitmapTextureDesc {
  std::string filename;
  // A PNG or JPEG file that the scene file holds; then `filename` only names it, in messages.
  std::shared_ptr<const std::string> bytes = nullptr;
  // There is no such file, and that was allowed: the world shows a stand-in (see --allow-missing).
  bool missing = false;
  // true: values are used as they are; false: an 8-bit file is decoded from sRGB (float files are linear
  // anyway).
  bool raw = false;
  TextureChannel channel = TextureChannel::rgb;  // another: that one alone, as gray (cut-outs by alpha)
  bool alpha_may_lack = false;                   // an alpha channel that the file does not have is 1
  FilterMode filter = FilterMode::bilinear;
  WrapMode wrap_u = WrapMode::repeat, wrap_v = WrapMode::repeat;
  UvTransform to_uv;
};
struct CheckerboardTextureDesc {
  ColorInput color0{Rgb(0.4f)}, color1{Rgb(0.2f)};
  UvTransform to_uv;
};
struct ScaleTextureDesc {
  ColorInput input;
  Rgb scale{1};
};
struct ProductTextureDesc {  // of two inputs, channel by channel: vertex colors and a texture, say
  ColorInput a{Rgb(1)}, b{Rgb(1)};
};
struct MixTextureDesc {  // (1 - amount) · a + amount · b, channel by channel
  ColorInput a{Rgb(0)}, b{Rgb(1)}, amount{Rgb(0.5f)};
};
struct RootTextureDesc {  // the square root, channel by channel: pbrt's widths of microfacets
  ColorInput input;
};
struct ThresholdTextureDesc {  // 1 where the input is at least the threshold, else 0: cut-outs with hard
                               // edges
  ColorInput input;
  float threshold = 0.5f;
};
struct VertexColorTextureDesc {
  std::string attribute = "vertex_color";
};
struct TextureDesc {
  std::string id;
  SourceLocation where;
  std::variant<BitmapTextureDesc, CheckerboardTextureDesc, ScaleTextureDesc, ProductTextureDesc,
               MixTextureDesc, RootTextureDesc, ThresholdTextureDesc, VertexColorTextureDesc>
      kind;
};

}  // namespace lumirank::scenedesc
