// What is shown in place of a picture that does not exist (--allow-missing).
#include <gtest/gtest.h>

#include "world/scene_maker.h"

namespace lumirank::world {
namespace {

using namespace test;

TEST(StandIn, IsMagentaAndGrayAsAColorAndHarmlessAsANumber) {
  auto desc = empty_scene();
  add_emitter(desc, sd::PointLightDesc{});
  sd::BitmapTextureDesc absent;
  absent.filename = "/nowhere/at/all.png", absent.missing = true;
  const int picture = add_texture(desc, absent);
  const int scaled = add_texture(desc, sd::ScaleTextureDesc{{Rgb(0), picture}, Rgb(0.1f)});
  const auto shape_with = [&](auto bsdf) {
    const int shape = add_shape(desc, sd::RectangleDesc{});
    desc.shapes[static_cast<std::size_t>(shape)].bsdf = add_bsdf(desc, std::move(bsdf));
  };
  const int base = add_bsdf(desc, sd::DiffuseDesc{{Rgb(0.25f)}});
  shape_with(sd::DiffuseDesc{{Rgb(0), picture}});
  shape_with(sd::MaskDesc{{0, scaled}, base});
  shape_with(sd::RoughDiffuseDesc{{Rgb(0.5f)}, {0, scaled}});
  shape_with(sd::BumpMapDesc{scaled, 1, base});
  sd::NormalMapDesc normals;
  normals.texture = picture, normals.nested = base;
  shape_with(normals);
  const World w = build(desc);
  const auto& set = w.materials();
  const auto material = [&](std::size_t placement) -> const scatter::Material& {
    return set.materials[w.rays().placements()[placement].material];
  };
  const auto& color = std::get<scatter::DiffuseMaterial>(material(0)).reflectance;
  ASSERT_GE(color.texture, 0);
  // Neighboring squares of eight along an edge.
  const Rgb a = set.textures.lookup(color.texture, {{1.0f / 16, 1.0f / 16}}),
            b = set.textures.lookup(color.texture, {{3.0f / 16, 1.0f / 16}});
  const Rgb magenta = a.g == 0 ? a : b, gray = a.g == 0 ? b : a;
  EXPECT_EQ(magenta, Rgb(0.9f, 0, 0.9f));
  EXPECT_EQ(gray, Rgb(0.3f));
  const auto& mask = std::get<scatter::MaskMaterial>(material(1));
  EXPECT_EQ(mask.opacity.texture, -1);
  EXPECT_EQ(mask.opacity.value, 1);
  EXPECT_EQ(std::get<scatter::RoughDiffuseMaterial>(material(2)).alpha.value, 0.5f);
  for (const std::size_t bumpy : {3u, 4u})
    EXPECT_EQ(std::get<scatter::DiffuseMaterial>(material(bumpy)).reflectance.value, Rgb(0.25f));
}

}  // namespace
}  // namespace lumirank::world
