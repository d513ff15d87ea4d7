// Building a world: materials, textures, names, and what it refuses or warns about.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <fstream>

#include "base/error.h"
#include "image/image_io.h"
#include "scenedesc/readers.h"
#include "world/scene_maker.h"

namespace lumirank::world {
namespace {

using namespace test;

sd::SceneDesc lit_rectangle() {
  auto desc = empty_scene();
  add_shape(desc, sd::RectangleDesc{}, {}, 5);
  add_emitter(desc, sd::ConstantEnvironmentDesc{Rgb(1)});
  return desc;
}

void expect_refused(const sd::SceneDesc& desc, int line, const std::string& says) {
  try {
    build(desc);
    FAIL() << "not refused: " << says;
  } catch (const InputError& e) {
    EXPECT_NE(std::string(e.what()).find(says), std::string::npos) << e.what();
    if (line > 0) {
      EXPECT_EQ(e.where().line, line) << e.what();
    }
  }
}

// Shapes that stay are the same meshes at both moments, whatever was read anew.
TEST(Build, SharesWhatDoesNotMove) {
  const auto at = [](double x) {
    auto desc = lit_rectangle();
    add_shape(desc, sd::SphereDesc{{0, 0, 0}, 1}, Transform::translate(x, 0, 3), 6);
    desc.shapes[0].id = "floor", desc.shapes[1].id = "ball";
    return desc;
  };
  std::vector<sd::Warning> warnings;
  const World first = World::build(at(0), {}, warnings), own = World::build(at(1), {}, warnings);
  BuildOptions options;
  options.before = &first;
  const World moved = World::build(at(1), options, warnings), same = World::build(at(0), options, warnings);
  const auto mesh_of = [](const World& world, std::size_t shape) {
    return world.rays().meshes()[world.rays().placements()[shape].mesh];
  };
  EXPECT_EQ(mesh_of(moved, 0), mesh_of(first, 0));
  EXPECT_NE(mesh_of(moved, 1), mesh_of(first, 1));
  EXPECT_EQ(mesh_of(same, 1), mesh_of(first, 1));
  EXPECT_LT(same.info().memory_bytes, moved.info().memory_bytes);
  EXPECT_LT(moved.info().memory_bytes, own.info().memory_bytes);
  for (int k = 0; k < 200; ++k) {
    geometry::Ray ray;
    ray.origin = {-3, 0, 6}, ray.direction = {0.03f * static_cast<float>(k), 0.01f, -6};
    const auto a = moved.intersect(ray), b = own.intersect(ray);
    ASSERT_EQ(a.has_value(), b.has_value());
    if (a) {
      EXPECT_EQ(a->hit.t, b->hit.t);
    }
  }
}

TEST(Build, RefusesWhatMakesNoScene) {
  auto empty = empty_scene();
  expect_refused(empty, 0, "no geometry");
  auto blind = lit_rectangle();
  blind.sensors.clear();
  expect_refused(blind, 0, "no sensor");
  auto singular = lit_rectangle();
  singular.shapes[0].to_world.m[3] = std::nan("");
  expect_refused(singular, 5, "not finite");
  auto projective = lit_rectangle();
  projective.shapes[0].to_world.m[12] = 1;
  expect_refused(projective, 5, "affine");
  auto flat = lit_rectangle();
  flat.shapes[0].to_world = Transform::scale(1, 0, 1);
  expect_refused(flat, 0, "area");
  auto ball = lit_rectangle();
  add_shape(ball, sd::SphereDesc{{0, 0, 0}, -1}, {}, 9);
  expect_refused(ball, 9, "radius");
  auto tube = lit_rectangle();
  add_shape(tube, sd::CylinderDesc{{1, 1, 1}, {1, 1, 1}, 1}, {}, 9);
  expect_refused(tube, 9, "coincide");
  auto missing = lit_rectangle();
  sd::MeshFileDesc mesh;
  mesh.filename = "/nowhere/at/all.obj";
  add_shape(missing, mesh, {}, 9);
  expect_refused(missing, 0, "/nowhere/at/all.obj");
}

TEST(Build, MeshesThatTheReaderHoldsAreSharedAndTheirNotesNameThem) {
  auto desc = empty_scene();
  sd::MeshData data;
  data.positions = {{0, 0, 0}, {2, 0, 0}, {0, 2, 0}};
  data.indices = {0, 1, 2, 0, 1, 1};
  data.uvs = {{0, 0}, {1, 0}, {std::nanf(""), 1}};
  const sd::InlineMeshDesc mesh{std::make_shared<const sd::MeshData>(sd::check_mesh(data, {"scene.pbrt", 4})),
                                "floor"};
  const int lamp = add_shape(desc, mesh, Transform::translate(0, 0, 1), 7);
  add_shape(desc, mesh, Transform::scale(3, 3, 3), 8);
  shine(desc, lamp, {Rgb(2)});
  std::vector<sd::Warning> warnings;
  const auto world = build(desc, &warnings);
  // One mesh in the file, two in the world; a triangle of legs 2 has area 2.
  EXPECT_EQ(world.info().triangles, 2u);
  ASSERT_EQ(warnings.size(), 2u);
  EXPECT_NE(warnings[0].what.find("floor: 1 degenerate triangle"), std::string::npos);
  EXPECT_NE(warnings[1].what.find("floor: 1 texture coordinate"), std::string::npos);
  const auto& area = std::get<emitters::AreaEmitter>(world.emitters()[0].kind);
  ASSERT_EQ(area.triangles.size(), 1u);
  EXPECT_FLOAT_EQ(area.triangles[0].area, 2);
  EXPECT_EQ(area.triangles[0].p0, (Vec3f{0, 0, 1}));
}

TEST(Build, RefusesCyclesAndDanglingReferences) {
  auto textures = lit_rectangle();
  add_texture(textures, sd::ScaleTextureDesc{{Rgb(0), 1}, Rgb(1)}, 11);
  add_texture(textures, sd::CheckerboardTextureDesc{{Rgb(0), sd::kNone}, {Rgb(0), 0}, {}}, 12);
  textures.shapes[0].bsdf = add_bsdf(textures, sd::DiffuseDesc{{Rgb(0), 0}});
  expect_refused(textures, 11, "its own input");

  auto bsdfs = lit_rectangle();
  add_bsdf(bsdfs, sd::MaskDesc{{0.5f}, 1}, 11);
  add_bsdf(bsdfs, sd::TwoSidedDesc{0, 0}, 12);
  bsdfs.shapes[0].bsdf = 0;
  expect_refused(bsdfs, 11, "nested in itself");

  auto dangling = lit_rectangle();
  dangling.shapes[0].bsdf = 3;
  expect_refused(dangling, 5, "BSDF");
  auto untextured = lit_rectangle();
  untextured.shapes[0].bsdf = add_bsdf(untextured, sd::DiffuseDesc{{Rgb(0), 7}}, 11);
  expect_refused(untextured, 11, "texture");
  auto bare = lit_rectangle();
  bare.shapes[0].bsdf = add_bsdf(bare, sd::MaskDesc{{0.5f}, sd::kNone}, 11);
  expect_refused(bare, 11, "nested");
  auto glass = lit_rectangle();
  glass.shapes[0].bsdf = add_bsdf(glass, sd::DielectricDesc{-1.5f}, 11);
  expect_refused(glass, 11, "refraction");
  auto negative = lit_rectangle();
  negative.shapes[0].bsdf = add_bsdf(negative, sd::DiffuseDesc{{Rgb(-1, 0, 0)}}, 11);
  expect_refused(negative, 11, "negative");
}

TEST(Build, RefusesNestedGroups) {
  auto desc = lit_rectangle();
  const int child = add_shape(desc, sd::RectangleDesc{}, {}, 20);
  const int inner = add_shape(desc, sd::ShapeGroupDesc{{child}}, {}, 21);
  const int inside = add_shape(desc, sd::InstanceDesc{inner}, {}, 22);
  const int outer = add_shape(desc, sd::ShapeGroupDesc{{inside}}, {}, 23);
  desc.shapes[static_cast<std::size_t>(child)].in_group = true;
  desc.shapes[static_cast<std::size_t>(inside)].in_group = true;
  add_shape(desc, sd::InstanceDesc{outer}, {}, 24);
  expect_refused(desc, 22, "group");
  auto no_group = lit_rectangle();
  add_shape(no_group, sd::InstanceDesc{0}, {}, 30);
  expect_refused(no_group, 30, "not a shape group");
}

TEST(Build, RefusesImpossibleLights) {
  const auto refused = [](auto kind, const std::string& says) {
    auto desc = lit_rectangle();
    add_emitter(desc, kind, "", 40);
    expect_refused(desc, 40, says);
  };
  refused(sd::PointLightDesc{{0, 0, 0}, Rgb(-1)}, "negative");
  refused(sd::PointLightDesc{{std::nanf(""), 0, 0}, Rgb(1)}, "finite");
  refused(sd::DirectionalLightDesc{{0, 0, 0}, Rgb(1)}, "direction");
  refused(sd::SpotLightDesc{{}, Rgb(1), -3, 0}, "cut-off");
  refused(sd::SpotLightDesc{{}, Rgb(1), 20, 30}, "beam");
  refused(sd::EnvironmentMapDesc{"/nowhere/sky.exr", 1, {}}, "/nowhere/sky.exr");
  refused(sd::EnvironmentMapDesc{"/nowhere/sky.exr", 1, Transform::scale(1, 2, 1)}, "scales");
  sd::SunSkyDesc night;
  night.sun_direction = {0, -1, 0};
  refused(night, "horizon");
  sd::SunSkyDesc fog;
  fog.turbidity = 40;
  refused(fog, "turbidity");
}

TEST(Build, WarnsAboutLightsWithoutEffect) {
  auto desc = lit_rectangle();
  const int member = add_shape(desc, sd::RectangleDesc{}, {}, 7);
  desc.shapes[static_cast<std::size_t>(member)].in_group = true;
  shine(desc, member, {Rgb(1)});
  const int group = add_shape(desc, sd::ShapeGroupDesc{{member}}, {}, 8);
  add_shape(desc, sd::InstanceDesc{group}, Transform::translate(9, 0, 0), 9);
  const int flat = add_shape(desc, sd::RectangleDesc{}, Transform::scale(0, 1, 1), 10);
  shine(desc, flat, {Rgb(1)});
  std::vector<sd::Warning> warnings;
  const World w = build(desc, &warnings);
  EXPECT_EQ(w.emitters().size(), 1u);  // the environment
  ASSERT_EQ(warnings.size(), 2u);
  EXPECT_EQ(warnings[0].where.line, 7);
  EXPECT_EQ(warnings[1].where.line, 10);
  EXPECT_NE(warnings[1].what.find("its light is gone too"), std::string::npos) << warnings[1].what;
  EXPECT_THROW(build(desc, nullptr, true), InputError);

  auto dark = empty_scene();
  add_shape(dark, sd::RectangleDesc{});
  warnings.clear();
  build(dark, &warnings);
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_NE(warnings[0].what.find("no light"), std::string::npos);
}

TEST(Build, TwoSidedCannotHoldGlass) {
  auto desc = lit_rectangle();
  const int glass = add_bsdf(desc, sd::DielectricDesc{}, 11);
  desc.shapes[0].bsdf = add_bsdf(desc, sd::TwoSidedDesc{glass, glass}, 12);
  std::vector<sd::Warning> warnings;
  const World w = build(desc, &warnings);
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_EQ(warnings[0].where.line, 12);
  const auto hit = w.intersect(ray({0.3f, 0.2f, 5}, {0, 0, -1}));
  ASSERT_TRUE(hit);
  EXPECT_TRUE(std::holds_alternative<scatter::DielectricMaterial>(
      w.materials().materials[static_cast<std::size_t>(hit->material)]));
}

TEST(Build, NestedComesBeforeItsUser) {
  auto desc = lit_rectangle();
  // The users stand before what they use.
  desc.bsdfs.resize(1);
  const int white = add_bsdf(desc, sd::DiffuseDesc{{Rgb(1)}});
  desc.bsdfs[0].kind = sd::TwoSidedDesc{white, white};
  desc.shapes[0].bsdf = 0;
  add_shape(desc, sd::CubeDesc{}, Transform::translate(5, 0, 0));  // without a BSDF
  const World w = build(desc);
  const auto& all = w.materials().materials;
  for (std::size_t i = 0; i < all.size(); ++i)
    if (const auto* two = std::get_if<scatter::TwoSidedMaterial>(&all[i])) {
      EXPECT_LT(two->front, static_cast<int>(i));
    }
  const auto hit = w.intersect(ray({5, 0.2f, 5}, {0, 0, -1}));
  ASSERT_TRUE(hit);
  const auto& fallback = std::get<scatter::DiffuseMaterial>(all[static_cast<std::size_t>(hit->material)]);
  EXPECT_EQ(fallback.reflectance.value, Rgb(0.5f));
}

TEST(Build, ShadowRaysPassCutoutsAndNullSurfaces) {
  auto desc = lit_rectangle();
  desc.shapes[0].bsdf = add_bsdf(desc, sd::NullBsdfDesc{});
  const int base = add_bsdf(desc, sd::DiffuseDesc{});
  const int gone = add_shape(desc, sd::RectangleDesc{}, Transform::translate(10, 0, 0));
  desc.shapes[static_cast<std::size_t>(gone)].bsdf = add_bsdf(desc, sd::MaskDesc{{0.0f}, base});
  const int whole = add_shape(desc, sd::RectangleDesc{}, Transform::translate(20, 0, 0));
  desc.shapes[static_cast<std::size_t>(whole)].bsdf = add_bsdf(desc, sd::MaskDesc{{1.0f}, base});
  const World w = build(desc);
  const auto down = [](float x) {
    geometry::Ray r = ray({x + 0.2f, 0.1f, 1}, {0, 0, -2});
    r.t_max = 1;
    return r;
  };
  EXPECT_FALSE(w.rays().occluded(down(0), 1));
  EXPECT_EQ(w.rays().transmittance(down(0)), Rgb(1));
  EXPECT_FALSE(w.rays().occluded(down(10), 1));
  EXPECT_TRUE(w.rays().occluded(down(20), 1));
}

TEST(Build, TexturesOfOneFileShareTheirPixels) {
  const std::string path = ::testing::TempDir() + "lumirank_world_texture.pfm";
  image::Image image(2, 2);
  image.at(0, 0) = Rgb(1, 0, 0), image.at(1, 0) = Rgb(0, 1, 0), image.at(0, 1) = Rgb(0, 0, 1);
  image::write_image(path, {image, {}});
  auto desc = lit_rectangle();
  sd::BitmapTextureDesc bitmap;
  bitmap.filename = path;
  const int a = add_texture(desc, bitmap), b = add_texture(desc, bitmap);
  bitmap.raw = true;
  const int c = add_texture(desc, bitmap);
  sd::BitmapTextureDesc unused_file;
  unused_file.filename = "/nowhere/unused.png";  // never opened
  add_texture(desc, unused_file);
  for (const int t : {a, b, c}) {
    const int s = add_shape(desc, sd::RectangleDesc{}, Transform::translate(3 * t + 3, 0, 0));
    desc.shapes[static_cast<std::size_t>(s)].bsdf = add_bsdf(desc, sd::DiffuseDesc{{Rgb(0), t}});
  }
  const World w = build(desc);
  std::remove(path.c_str());
  const auto& set = w.materials().textures.textures;
  ASSERT_EQ(set.size(), 3u);
  const auto pixels = [&](int i) {
    return std::get<scatter::BitmapTexture>(set[static_cast<std::size_t>(i)]).pixels;
  };
  EXPECT_EQ(pixels(0), pixels(1));
  EXPECT_NE(pixels(0), pixels(2));
  EXPECT_EQ(pixels(0)->rgb[0], Rgb(1, 0, 0));
}

TEST(Build, AMaskReadsTheAlphaOfItsPicture) {
  const std::string path = ::testing::TempDir() + "lumirank_world_mask.tga";
  // A Targa file of 2 x 1 pixels, 32 bits each (blue, green, red, alpha), the top row first.
  const unsigned char bytes[] = {0, 0, 2, 0,  0,    0,   0,   0,   0,  0, 0, 0,   2,
                                 0, 1, 0, 32, 0x28, 255, 255, 255, 51, 0, 0, 255, 255};
  std::ofstream(path, std::ios::binary).write(reinterpret_cast<const char*>(bytes), sizeof bytes);
  auto desc = lit_rectangle();
  sd::BitmapTextureDesc bitmap;
  bitmap.filename = path;
  bitmap.filter = sd::FilterMode::nearest;
  bitmap.channel = sd::TextureChannel::alpha;
  const int alpha = add_texture(desc, bitmap);
  bitmap.channel = sd::TextureChannel::red;
  const int red = add_texture(desc, bitmap);
  const int plain = add_bsdf(desc, sd::DiffuseDesc{{Rgb(0), red}});
  sd::MaskDesc mask;
  mask.opacity.texture = alpha, mask.nested = plain;
  desc.shapes[0].bsdf = add_bsdf(desc, mask);
  const World w = build(desc);
  std::remove(path.c_str());
  const int material = static_cast<int>(w.rays().placements()[0].material);
  EXPECT_FLOAT_EQ(w.materials().opacity(material, {{0.25f, 0.5f}}), 0.2f);
  EXPECT_FLOAT_EQ(w.materials().opacity(material, {{0.75f, 0.5f}}), 1);
  // As a number it is its alpha too, because that is not 1 everywhere; a picture without reads its mean.
  bitmap.channel = sd::TextureChannel::scalar;
  desc.textures[static_cast<std::size_t>(alpha)].kind = bitmap;
  { std::ofstream(path, std::ios::binary).write(reinterpret_cast<const char*>(bytes), sizeof bytes); }
  EXPECT_FLOAT_EQ(build(desc).materials().opacity(material, {{0.25f, 0.5f}}), 0.2f);
  std::remove(path.c_str());
  bitmap.filename = ::testing::TempDir() + "lumirank_world_colors.pfm";
  image::write_image(bitmap.filename, {image::Image(1, 1, Rgb(0.9f, 0, 0)), {}});
  desc.textures[static_cast<std::size_t>(alpha)].kind = bitmap;
  desc.textures[static_cast<std::size_t>(red)].kind = bitmap;
  EXPECT_FLOAT_EQ(build(desc).materials().opacity(material, {{0.25f, 0.5f}}), 0.3f);
  std::remove(bitmap.filename.c_str());
  bitmap.filename = ::testing::TempDir() + "lumirank_world_no_alpha.pfm";
  bitmap.channel = sd::TextureChannel::alpha;
  image::write_image(bitmap.filename, {image::Image(1, 1), {}});
  desc.textures[static_cast<std::size_t>(alpha)].kind = bitmap;
  EXPECT_THROW(build(desc), InputError);
  std::remove(bitmap.filename.c_str());
}

TEST(Build, NamesAreUniqueAndSharedIdsShareAGroup) {
  auto desc = empty_scene();
  for (int k = 0; k < 3; ++k) {
    const int s = add_shape(desc, sd::RectangleDesc{}, Transform::translate(0, 0, k));
    shine(desc, s, {Rgb(1)}, k < 2 ? "lamp" : "");
    desc.shapes[static_cast<std::size_t>(s)].id = "shape" + std::to_string(k);
  }
  add_emitter(desc, sd::PointLightDesc{}, "lamp_2");
  add_emitter(desc, sd::PointLightDesc{});
  const World w = build(desc);
  const auto& e = w.emitters();
  ASSERT_EQ(e.size(), 5u);
  EXPECT_EQ(e[0].name, "lamp");
  EXPECT_EQ(e[1].name, "lamp_2");
  EXPECT_EQ(e[2].name, "shape2");
  EXPECT_EQ(e[3].name, "lamp_2_2");
  EXPECT_EQ(e[4].name, "emitter_5");
  EXPECT_EQ(e[0].group, e[1].group);
  EXPECT_NE(e[0].group, e[2].group);
  EXPECT_NE(e[1].group, e[3].group);
}

}  // namespace
}  // namespace lumirank::world
