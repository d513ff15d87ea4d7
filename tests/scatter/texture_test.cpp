#include "scatter/texture.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "base/error.h"

namespace lumirank::scatter {
namespace {

constexpr int kWidth = 4, kHeight = 2;

// Texel (column, row from the top) has the value (column, row, 0).
BitmapTexture numbered(TexFilter filter = TexFilter::bilinear) {
  auto pixels = std::make_shared<TexturePixels>();
  pixels->width = kWidth, pixels->height = kHeight;
  for (int row = 0; row < kHeight; ++row)
    for (int column = 0; column < kWidth; ++column)
      pixels->rgb.push_back({static_cast<float>(column), static_cast<float>(row), 0});
  BitmapTexture t;
  t.pixels = pixels;
  t.filter = filter;
  return t;
}

Rgb color_at(const BitmapTexture& t, float u, float v) { return TextureSet{{t}}.lookup(0, {{u, v}, Rgb(1)}); }

TEST(Bitmap, TexelCentersAreExactAndTheTopRowIsAtVOne) {
  for (const TexFilter filter : {TexFilter::nearest, TexFilter::bilinear})
    for (int row = 0; row < kHeight; ++row)
      for (int column = 0; column < kWidth; ++column) {
        const float u = (static_cast<float>(column) + 0.5f) / kWidth;
        const float v = 1 - (static_cast<float>(row) + 0.5f) / kHeight;
        EXPECT_EQ(color_at(numbered(filter), u, v),
                  Rgb(static_cast<float>(column), static_cast<float>(row), 0));
      }
}

TEST(Bitmap, BilinearIsTheWeightedMeanOfFour) {
  // A quarter of the way from column 1 to 2, halfway between the rows.
  EXPECT_EQ(color_at(numbered(), (1.5f + 0.25f) / 4, 0.5f), Rgb(1.25f, 0.5f, 0));
}

TEST(Bitmap, WrapModes) {
  BitmapTexture t = numbered(TexFilter::nearest);
  const float column0 = 0.5f / 4, column3 = 3.5f / 4;
  EXPECT_EQ(color_at(t, column0 + 3, 0.75f - 2).r, 0);
  EXPECT_EQ(color_at(t, column3 - 1, 0.75f).r, 3);
  t.wrap_u = TexWrap::mirror;
  EXPECT_EQ(color_at(t, 1 + column0, 0.75f).r, 3);  // mirrored at u = 1
  EXPECT_EQ(color_at(t, -column0, 0.75f).r, 0);     // and at u = 0
  EXPECT_EQ(color_at(t, 2 + column3, 0.75f).r, 3);
  t.wrap_u = TexWrap::clamp;
  EXPECT_EQ(color_at(t, 7, 0.75f).r, 3);
  EXPECT_EQ(color_at(t, -7, 0.75f).r, 0);
}

TEST(Bitmap, BilinearWrapsAcrossTheEdge) {
  BitmapTexture t = numbered();
  EXPECT_EQ(color_at(t, 0, 0.75f).r, 1.5f);  // halfway between columns 3 and 0
  t.wrap_u = TexWrap::mirror;
  EXPECT_EQ(color_at(t, 0, 0.75f).r, 0);
  EXPECT_EQ(color_at(t, 1, 0.75f).r, 3);
  t.wrap_u = TexWrap::clamp;
  EXPECT_EQ(color_at(t, 0, 0.75f).r, 0);
}

TEST(Bitmap, TransformMapsMeshToTextureCoordinates) {
  BitmapTexture t = numbered(TexFilter::nearest);
  const float m[6] = {0, 1, 0.25f, 1, 0, 0};  // u' = v + ¼, v' = u
  std::copy(m, m + 6, t.to_uv);
  EXPECT_EQ(color_at(t, 0.75f, 0.5f / 4), Rgb(1, 0, 0));
}

TEST(Bitmap, StrangeCoordinatesAreHarmless) {
  const float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
  for (const TexWrap wrap : {TexWrap::repeat, TexWrap::mirror, TexWrap::clamp}) {
    for (const TexFilter filter : {TexFilter::nearest, TexFilter::bilinear}) {
      BitmapTexture t = numbered(filter);
      t.wrap_u = t.wrap_v = wrap;
      for (float u : {nan, inf, -inf, 1e30f, -1e30f, 1e9f, -0.0f, 1.0f, -1e-20f}) {
        for (float v : {nan, 3e38f, 0.5f}) {
          const Rgb c = color_at(t, u, v);
          EXPECT_TRUE(is_finite(c) && c.r >= 0 && c.r <= 3 && c.g >= 0 && c.g <= 1) << u << ' ' << v;
        }
      }
      EXPECT_EQ(color_at(t, nan, inf), color_at(t, 0, 0));
    }
  }
}

TEST(Bitmap, GradientOfALinearRamp) {
  // From column to column red rises by 1, so by 4 for a unit of u; green falls from the lower row to the
  // upper one by 1, so by 2 for a unit of v.
  TextureSet set{{numbered()}};
  const SurfaceUv at{{0.5f, 0.5f}, Rgb(1)};
  const Vec2f g = set.gradient(0, at);
  EXPECT_NEAR(g.x, 4 * 0.2126f, 1e-5f);
  EXPECT_NEAR(g.y, -2 * 0.7152f, 1e-5f);
  // As steep everywhere between two centers, and between the last and the first, which repeats.
  EXPECT_NEAR(set.gradient(0, {{0.40f, 0.5f}, Rgb(1)}).x, 4 * 0.2126f, 1e-5f);
  EXPECT_NEAR(set.gradient(0, {{0.95f, 0.5f}, Rgb(1)}).x, -12 * 0.2126f, 1e-5f);
  // Through a transform by the chain rule: u' = 2u doubles the slope.
  BitmapTexture stretched = numbered();
  stretched.to_uv[0] = 2;
  set.textures.push_back(stretched);
  EXPECT_NEAR(set.gradient(1, {{0.25f, 0.5f}, Rgb(1)}).x, 8 * 0.2126f, 1e-5f);
  set.textures.push_back(ScaleTexture{0, Rgb(3)});
  EXPECT_NEAR(set.gradient(2, at).x, 12 * 0.2126f, 1e-4f);
  set.textures.push_back(ConstantTexture{Rgb(1)});
  EXPECT_EQ(set.gradient(3, at).x, 0);
}

TEST(Checkerboard, FirstColorWhereHalvesAgree) {
  TextureSet set;
  set.textures.push_back(ConstantTexture{Rgb(0.1f)});
  set.textures.push_back(ConstantTexture{Rgb(0.9f)});
  set.textures.push_back(CheckerboardTexture{0, 1, {1, 0, 0, 0, 1, 0}});
  const auto at = [&](float u, float v) { return set.lookup(2, {{u, v}, Rgb(1)}).r; };
  EXPECT_EQ(at(0.2f, 0.3f), 0.1f);
  EXPECT_EQ(at(0.7f, 0.8f), 0.1f);
  EXPECT_EQ(at(0.7f, 0.3f), 0.9f);
  EXPECT_EQ(at(-0.3f, 4.3f), 0.9f);
  EXPECT_EQ(set.mean(2), Rgb(0.5f));
}

TEST(TextureSet, ScalesVertexColorsAndMeans) {
  TextureSet set{{VertexColorTexture{}, ScaleTexture{0, {2, 1, 0.5f}}, numbered()}};
  EXPECT_EQ(set.lookup(1, {{0, 0}, {0.25f, 0.5f, 1}}), Rgb(0.5f, 0.5f, 0.5f));
  EXPECT_NEAR(set.lookup_float(1, {{0, 0}, {0.25f, 0.5f, 1}}), 0.5f, 1e-6f);
  // Columns 0…3 have the mean 1.5, rows 0 and 1 the mean 0.5.
  EXPECT_EQ(set.mean(2), Rgb(1.5f, 0.5f, 0));
  EXPECT_THROW(set.lookup(3, {}), InternalError);
  EXPECT_THROW(set.lookup(-1, {}), InternalError);
}

TEST(TextureSet, ProductsAndThresholds) {
  TextureSet set{{VertexColorTexture{}, ConstantTexture{{0.5f, 2, 0}}, ProductTexture{0, 1}, numbered(),
                  ProductTexture{3, 1}, ProductTexture{3, 3}, ThresholdTexture{3, 1.5f}}};
  EXPECT_EQ(set.lookup(2, {{0, 0}, {0.5f, 0.25f, 1}}), Rgb(0.25f, 0.5f, 0));
  EXPECT_EQ(set.mean(4), Rgb(0.75f, 1, 0));
  // Half way between columns 1 and 2 the value is 1.5 and rises by 4 per unit of u: the square's slope is
  // 2 · 1.5 · 4.
  const SurfaceUv middle{{0.5f, 0.5f}, Rgb(1)};
  EXPECT_NEAR(set.lookup(5, middle).r, 2.25f, 1e-5f);
  EXPECT_NEAR(set.gradient(5, middle).x, 12 * 0.2126f, 1e-4f);
  EXPECT_EQ(set.lookup(6, middle), Rgb(1, 0, 0));
  EXPECT_EQ(set.lookup(6, {{0.49f, 0.5f}, Rgb(1)}), Rgb(0, 0, 0));
}

TEST(TextureSet, MixesAndRoots) {
  TextureSet set{{VertexColorTexture{}, ConstantTexture{{1, 0, 0.5f}}, ConstantTexture{Rgb(0.25f)},
                  MixTexture{0, 1, 2}, numbered(), RootTexture{4}, MixTexture{2, 4, 4}, RootTexture{2}}};
  // ¾ of the vertex color and ¼ of the constant.
  EXPECT_EQ(set.lookup(3, {{0, 0}, {1, 0.5f, 0}}), Rgb(1, 0.375f, 0.125f));
  EXPECT_EQ(set.mean(3), Rgb(1, 0.75f, 0.875f));
  EXPECT_EQ(set.mean(7), Rgb(0.5f));
  // Half way between columns 1 and 2 the red value x is 1.5 with the slope 4: √x has 4/(2√1.5), and the mix
  // ¼ (1 - x) + x² has (2x - ¼) · 4.
  const SurfaceUv middle{{0.5f, 0.5f}, Rgb(1)};
  EXPECT_NEAR(set.lookup(5, middle).r, std::sqrt(1.5f), 1e-5f);
  EXPECT_NEAR(set.lookup(6, middle).r, 2.125f, 1e-5f);
  // Green is ½ there and does not change.
  EXPECT_NEAR(set.gradient(5, middle).x, 2 / std::sqrt(1.5f) * 0.2126f, 1e-4f);
  EXPECT_NEAR(set.gradient(6, middle).x, 11 * 0.2126f, 1e-4f);
}

}  // namespace
}  // namespace lumirank::scatter
