#include "scatter/texture.h"

#include <cmath>

#include "base/error.h"
#include "base/prefetch.h"

namespace lumirank::scatter {
namespace {

Vec2f transform(const float m[6], Vec2f uv) {
  return {m[0] * uv.x + m[1] * uv.y + m[2], m[3] * uv.x + m[4] * uv.y + m[5]};
}

// Texture coordinates that are not numbers read the origin: a broken mesh must not poison the image.
Vec2f finite(Vec2f uv) { return {std::isfinite(uv.x) ? uv.x : 0.0f, std::isfinite(uv.y) ? uv.y : 0.0f}; }

// Into the first period (two of them for mirrored repetition), so that texel indices stay small.
float reduce(float x, TexWrap wrap) {
  switch (wrap) {
    case TexWrap::repeat:
      return x - std::floor(x);
    case TexWrap::mirror:
      return x - 2 * std::floor(0.5f * x);
    case TexWrap::clamp:
      break;
  }
  return std::clamp(x, 0.0f, 1.0f);
}

int wrap_index(int i, int n, TexWrap wrap) {
  switch (wrap) {
    case TexWrap::repeat:  // no further off than one period
      return i < 0 ? i + n : (i >= n ? i - n : i);
    case TexWrap::mirror: {
      const int k = ((i % (2 * n)) + 2 * n) % (2 * n);
      return k < n ? k : 2 * n - 1 - k;
    }
    case TexWrap::clamp:
      break;
  }
  return std::clamp(i, 0, n - 1);
}

// Where uv, already in texture space, lies among texels; rows counted from the bottom, where v = 0 is.
Vec2f place_on(const BitmapTexture& t, Vec2f uv) {
  uv = finite(uv);
  return {reduce(uv.x, t.wrap_u) * static_cast<float>(t.pixels->width),
          reduce(uv.y, t.wrap_v) * static_cast<float>(t.pixels->height)};
}

// Rows are stored from the top.
const Rgb& texel(const BitmapTexture& t, int column, int from_bottom) {
  const TexturePixels& p = *t.pixels;
  const int row = p.height - 1 - wrap_index(from_bottom, p.height, t.wrap_v);
  return p.rgb[static_cast<std::size_t>(row) * static_cast<std::size_t>(p.width) +
               static_cast<std::size_t>(wrap_index(column, p.width, t.wrap_u))];
}

Rgb bitmap_at(const BitmapTexture& t, Vec2f uv) {
  const auto [x, y] = place_on(t, uv);
  if (t.filter == TexFilter::nearest)
    return texel(t, static_cast<int>(std::floor(x)), static_cast<int>(std::floor(y)));
  const float fx = std::floor(x - 0.5f), fy = std::floor(y - 0.5f);
  const int x0 = static_cast<int>(fx), y0 = static_cast<int>(fy);
  const float ax = x - 0.5f - fx, ay = y - 0.5f - fy;
  return lerp(lerp(texel(t, x0, y0), texel(t, x0 + 1, y0), ax),
              lerp(texel(t, x0, y0 + 1), texel(t, x0 + 1, y0 + 1), ax), ay);
}

// Mitsuba's: color 0 where both halves agree, so on [0, ½)² of each unit square.
bool checker_first(const CheckerboardTexture& t, Vec2f mesh_uv) {
  const Vec2f uv = finite(transform(t.to_uv, finite(mesh_uv)));
  return (uv.x - std::floor(uv.x) > 0.5f) == (uv.y - std::floor(uv.y) > 0.5f);
}

Rgb root(Rgb c) { return sqrt(Rgb(std::max(c.r, 0.0f), std::max(c.g, 0.0f), std::max(c.b, 0.0f))); }
Rgb mixed(Rgb a, Rgb b, Rgb amount) { return a + (b - a) * amount; }

struct RgbGradient {
  Rgb du{0}, dv{0};
};

RgbGradient rgb_gradient(const TextureSet& set, int index, const SurfaceUv& at);

// Where a slope is taken along one axis. Between the centers of two texels it is constant, by interpolation:
// wider differences would smooth what is as fine as texels. Without interpolation, from texel to texel.
struct Span {
  float begin, end, texels;
};
Span span_of(float at, float size, TexFilter filter) {
  if (filter != TexFilter::bilinear) return {at - 1 / size, at + 1 / size, 2};
  const float first = std::floor(at * size - 0.5f) + 0.5f;
  return {first / size, (first + 1) / size, 1};
}

struct GradientVisitor {
  const TextureSet& set;
  const SurfaceUv& at;

  RgbGradient operator()(const ConstantTexture&) const { return {}; }
  RgbGradient operator()(const VertexColorTexture&) const { return {}; }
  RgbGradient operator()(const CheckerboardTexture& t) const {
    return rgb_gradient(set, checker_first(t, at.uv) ? t.color0 : t.color1, at);
  }
  RgbGradient operator()(const ScaleTexture& t) const {
    const RgbGradient g = rgb_gradient(set, t.input, at);
    return {g.du * t.scale, g.dv * t.scale};
  }
  RgbGradient operator()(const ProductTexture& t) const {
    const RgbGradient a = rgb_gradient(set, t.a, at), b = rgb_gradient(set, t.b, at);
    const Rgb va = set.lookup(t.a, at), vb = set.lookup(t.b, at);
    return {a.du * vb + b.du * va, a.dv * vb + b.dv * va};
  }
  RgbGradient operator()(const MixTexture& t) const {
    const RgbGradient a = rgb_gradient(set, t.a, at), b = rgb_gradient(set, t.b, at);
    const RgbGradient m = rgb_gradient(set, t.amount, at);
    const Rgb amount = set.lookup(t.amount, at), step = set.lookup(t.b, at) - set.lookup(t.a, at);
    return {a.du + (b.du - a.du) * amount + step * m.du, a.dv + (b.dv - a.dv) * amount + step * m.dv};
  }
  RgbGradient operator()(const RootTexture& t) const {
    const RgbGradient g = rgb_gradient(set, t.input, at);
    Rgb slope = root(set.lookup(t.input, at)) * 2;
    for (int k = 0; k < 3; ++k) slope[k] = slope[k] > 0 ? 1 / slope[k] : 0;
    return {g.du * slope, g.dv * slope};
  }
  RgbGradient operator()(const ThresholdTexture&) const { return {}; }
  RgbGradient operator()(const BitmapTexture& t) const {
    const Vec2f uv = transform(t.to_uv, finite(at.uv));
    const auto w = static_cast<float>(t.pixels->width), h = static_cast<float>(t.pixels->height);
    const Span u = span_of(uv.x, w, t.filter), v = span_of(uv.y, h, t.filter);
    const Rgb du = (bitmap_at(t, {u.end, uv.y}) - bitmap_at(t, {u.begin, uv.y})) * (w / u.texels);
    const Rgb dv = (bitmap_at(t, {uv.x, v.end}) - bitmap_at(t, {uv.x, v.begin})) * (h / v.texels);
    return {du * t.to_uv[0] + dv * t.to_uv[3], du * t.to_uv[1] + dv * t.to_uv[4]};
  }
};

RgbGradient rgb_gradient(const TextureSet& set, int index, const SurfaceUv& at) {
  return std::visit(GradientVisitor{set, at}, set.textures[static_cast<std::size_t>(index)]);
}

struct LookupVisitor {
  const TextureSet& set;
  const SurfaceUv& at;

  Rgb operator()(const ConstantTexture& t) const { return t.value; }
  Rgb operator()(const BitmapTexture& t) const { return bitmap_at(t, transform(t.to_uv, finite(at.uv))); }
  Rgb operator()(const CheckerboardTexture& t) const {
    return set.lookup(checker_first(t, at.uv) ? t.color0 : t.color1, at);
  }
  Rgb operator()(const ScaleTexture& t) const { return set.lookup(t.input, at) * t.scale; }
  Rgb operator()(const ProductTexture& t) const { return set.lookup(t.a, at) * set.lookup(t.b, at); }
  Rgb operator()(const MixTexture& t) const {
    return mixed(set.lookup(t.a, at), set.lookup(t.b, at), set.lookup(t.amount, at));
  }
  Rgb operator()(const RootTexture& t) const { return root(set.lookup(t.input, at)); }
  Rgb operator()(const ThresholdTexture& t) const {
    const Rgb c = set.lookup(t.input, at);
    return {c.r >= t.threshold ? 1.0f : 0.0f, c.g >= t.threshold ? 1.0f : 0.0f,
            c.b >= t.threshold ? 1.0f : 0.0f};
  }
  Rgb operator()(const VertexColorTexture&) const { return at.vertex_color; }
};

struct MeanVisitor {
  const TextureSet& set;

  Rgb operator()(const ConstantTexture& t) const { return t.value; }
  Rgb operator()(const BitmapTexture& t) const {
    double sum[3] = {0, 0, 0};
    for (const Rgb& c : t.pixels->rgb) sum[0] += c.r, sum[1] += c.g, sum[2] += c.b;
    const double n = static_cast<double>(std::max<std::size_t>(1, t.pixels->rgb.size()));
    return {static_cast<float>(sum[0] / n), static_cast<float>(sum[1] / n), static_cast<float>(sum[2] / n)};
  }
  Rgb operator()(const CheckerboardTexture& t) const {
    return (set.mean(t.color0) + set.mean(t.color1)) * 0.5f;
  }
  Rgb operator()(const ScaleTexture& t) const { return set.mean(t.input) * t.scale; }
  // Exact where one of the two is constant.
  Rgb operator()(const ProductTexture& t) const { return set.mean(t.a) * set.mean(t.b); }
  // Exact where the amount is constant, or both colors are.
  Rgb operator()(const MixTexture& t) const {
    return mixed(set.mean(t.a), set.mean(t.b), set.mean(t.amount));
  }
  Rgb operator()(const RootTexture& t) const { return root(set.mean(t.input)); }
  // That of the mean: of a cut-out's outline no more is known without evaluating it everywhere.
  Rgb operator()(const ThresholdTexture& t) const {
    const Rgb c = set.mean(t.input);
    return {c.r >= t.threshold ? 1.0f : 0.0f, c.g >= t.threshold ? 1.0f : 0.0f,
            c.b >= t.threshold ? 1.0f : 0.0f};
  }
  Rgb operator()(const VertexColorTexture&) const { return Rgb(1); }
};

Vec2f finer(Vec2f a, Vec2f b) { return {std::max(a.x, b.x), std::max(a.y, b.y)}; }

struct TexelVisitor {
  const std::vector<Vec2f>& before;  // of textures before this one

  Vec2f of(int input) const { return before[static_cast<std::size_t>(input)]; }

  // Of a grid so fine in the texture's own coordinates.
  static Vec2f along_uv(const float m[6], float width, float height) {
    return {std::max(std::abs(m[0]) * width, std::abs(m[3]) * height),
            std::max(std::abs(m[1]) * width, std::abs(m[4]) * height)};
  }
  Vec2f operator()(const ConstantTexture&) const { return {}; }
  Vec2f operator()(const BitmapTexture& t) const {
    return along_uv(t.to_uv, static_cast<float>(t.pixels->width), static_cast<float>(t.pixels->height));
  }
  Vec2f operator()(const CheckerboardTexture& t) const {
    return finer(along_uv(t.to_uv, 4, 4), finer(of(t.color0), of(t.color1)));
  }
  Vec2f operator()(const ScaleTexture& t) const { return of(t.input); }
  Vec2f operator()(const ProductTexture& t) const { return finer(of(t.a), of(t.b)); }
  Vec2f operator()(const MixTexture& t) const { return finer(of(t.amount), finer(of(t.a), of(t.b))); }
  Vec2f operator()(const RootTexture& t) const { return of(t.input); }
  Vec2f operator()(const ThresholdTexture& t) const { return of(t.input); }
  Vec2f operator()(const VertexColorTexture&) const { return {}; }
};

const Texture& checked(const std::vector<Texture>& textures, int index) {
  if (index < 0 || static_cast<std::size_t>(index) >= textures.size())
    throw InternalError("texture index " + std::to_string(index) + " of " + std::to_string(textures.size()));
  return textures[static_cast<std::size_t>(index)];
}

}  // namespace

Rgb TextureSet::lookup(int texture, const SurfaceUv& at) const {
  return std::visit(LookupVisitor{*this, at}, checked(textures, texture));
}

void TextureSet::fetch_bitmap(int texture, const SurfaceUv& at) const {
  const auto& t = std::get<BitmapTexture>(textures[static_cast<std::size_t>(texture)]);
  const auto [x, y] = place_on(t, transform(t.to_uv, finite(at.uv)));
  const int x0 = static_cast<int>(std::floor(x - 0.5f)), y0 = static_cast<int>(std::floor(y - 0.5f));
  prefetch(&texel(t, x0, y0));
  prefetch(&texel(t, x0, y0 + 1));
}

void TextureSet::add_bitmaps(int texture, std::vector<int>& out) const {
  checked(textures, texture);
  // From the last to the first, each once: a texture may have its inputs by many ways.
  std::vector<bool> read(static_cast<std::size_t>(texture) + 1);
  const auto mark = [&](int input) { read[static_cast<std::size_t>(input)] = true; };
  mark(texture);
  for (int k = texture; k >= 0; --k) {
    if (!read[static_cast<std::size_t>(k)]) continue;
    const Texture& t = textures[static_cast<std::size_t>(k)];
    if (std::holds_alternative<BitmapTexture>(t)) out.push_back(k);
    std::visit(
        [&](const auto& kind) {
          if constexpr (requires { kind.color0; }) mark(kind.color0), mark(kind.color1);
          if constexpr (requires { kind.input; }) mark(kind.input);
          if constexpr (requires { kind.a; }) mark(kind.a), mark(kind.b);
          if constexpr (requires { kind.amount; }) mark(kind.amount);
        },
        t);
  }
}

float TextureSet::lookup_float(int texture, const SurfaceUv& at) const {
  return luminance(lookup(texture, at));
}

Vec2f TextureSet::gradient(int texture, const SurfaceUv& at) const {
  checked(textures, texture);
  const RgbGradient g = rgb_gradient(*this, texture, at);
  return {luminance(g.du), luminance(g.dv)};
}

Rgb TextureSet::mean(int texture) const { return std::visit(MeanVisitor{*this}, checked(textures, texture)); }

Vec2f TextureSet::texels(int texture) const {
  checked(textures, texture);
  // One after the other: a texture may have its inputs by many ways.
  std::vector<Vec2f> known;
  for (int k = 0; k <= texture; ++k)
    known.push_back(std::visit(TexelVisitor{known}, textures[static_cast<std::size_t>(k)]));
  return known.back();
}

}  // namespace lumirank::scatter
