// Light of a built world: areas under transforms, textures, the environment, the sun.
#include <gtest/gtest.h>

#include <cmath>

#include "base/random.h"
#include "emitters/daylight.h"
#include "emitters/environment.h"
#include "emitters/hosek_wilkie.h"
#include "image/image_io.h"
#include "support/statistics.h"
#include "world/scene_maker.h"

namespace lumirank::world {
namespace {

using namespace test;

// Unoccluded irradiance at a point.
RunningMean irradiance(const World& w, int emitter, Vec3f point, Vec3f normal, std::uint64_t seed,
                       int n = 40000) {
  RunningMean mean;
  for (int i = 0; i < n; ++i) {
    Rng rng(seed, Stage::test, static_cast<std::uint64_t>(i));
    const float u1 = rng.next_float();
    const auto s = w.sample_direct(emitter, point, u1, rng.next_2d());
    mean.add(s.pdf > 0 ? s.radiance.g * std::max(0.0f, dot(s.direction, normal)) / s.pdf : 0.0);
  }
  return mean;
}

TEST(SpotLight, EdgesOfTheFormats) {
  using Edge = sd::SpotLightDesc::Edge;
  auto desc = empty_scene();
  add_shape(desc, sd::CubeDesc{}, Transform::translate(9, 9, 9));
  for (const Edge edge : {Edge::angle, Edge::smooth_cosine, Edge::squared_cosine, Edge::fourth_power})
    for (const float beam : {0.0f, 20.0f, 50.0f}) {  // the last: no edge at all
      sd::SpotLightDesc spot;
      spot.intensity = Rgb(4), spot.cutoff_angle = 50, spot.beam_width = beam, spot.edge = edge;
      desc.emitters.emplace_back().kind = spot;
    }
  const World w = build(desc);
  const double end = std::cos(50 * kPiD / 180);
  for (int k = 0; k < 12; ++k) {
    const double beam = k % 3 == 0 ? 0 : (k % 3 == 1 ? 20 : 50), start = std::cos(beam * kPiD / 180);
    for (int degrees = 1; degrees < 60; degrees += 2) {
      const double angle = degrees * kPiD / 180;
      const double part = degrees <= beam ? 1 : std::clamp((std::cos(angle) - end) / (start - end), 0.0, 1.0);
      double share = k < 3   ? std::clamp((50 - degrees) / (50 - beam), 0.0, 1.0)
                     : k < 6 ? part * part * (3 - 2 * part)
                             : (k < 9 ? part * part : part * part * part * part);
      if (beam == 50) share = degrees < 50 ? 1 : 0;
      const Vec3f p{static_cast<float>(2 * std::sin(angle)), 0, static_cast<float>(2 * std::cos(angle))};
      EXPECT_NEAR(w.sample_direct(k, p, 0.5f, {0.5f, 0.5f}).radiance.g, share, 1e-4)  // 4 / 2²
          << "light " << k << " at " << degrees << " degrees";
    }
  }
  // pbrt: 2π ((1 - cos beam) + (cos beam - cos cut-off) / 2) times the intensity.
  const double start = std::cos(20 * kPiD / 180);
  EXPECT_NEAR(emitters::power(w.emitters()[4], 1).g / (4 * 2 * kPiD * (1 - start + (start - end) / 2)), 1,
              2e-4);
}

// pbrt-v4 (GoniometricLight::Create): a light of "power" Φ has the intensity Φ · value / (4π · mean of the
// values).
TEST(GoniometricLight, PowerScalesThePicture) {
  const std::string path = testing::TempDir() + "lumirank_lamp.pfm";
  image::Image image(32, 32, Rgb(1, 2, 3));
  for (int k = 0; k < 512; ++k) image.pixels[static_cast<std::size_t>(k)] = Rgb(6);
  image::write_image(path, {image, {}});
  auto desc = empty_scene();
  sd::ProfileLightDesc lamp;
  lamp.kind = sd::ProfileLightDesc::Kind::image;
  lamp.filename = path;
  lamp.intensity = Rgb(0.5f);
  add_shape(desc, sd::CubeDesc{}, Transform::translate(9, 9, 9));
  desc.emitters.emplace_back().kind = lamp;
  lamp.power = 100;
  desc.emitters.emplace_back().kind = lamp;
  const World w = build(desc);
  const auto at = [&](int emitter, Vec3f p) {
    return w.sample_direct(emitter, p, 0.5f, {0.5f, 0.5f}).radiance.g;
  };
  // Half of the map is 2, half 6: the mean is 4, far from the seam the values are those of the picture.
  double min_intensity = 1e9, max_intensity = 0;
  for (const float y : {-1.0f, 1.0f}) {
    const Vec3f p{0.1f, y, 0.2f};
    const double ratio = at(1, p) / at(0, p);
    EXPECT_NEAR(ratio / (100 / (4 * kPiD * 4)), 1, 1e-5);
    const double intensity = at(0, p) * dot(p, p);
    min_intensity = std::min(min_intensity, intensity), max_intensity = std::max(max_intensity, intensity);
  }
  EXPECT_NEAR(min_intensity, 1, 1e-5);
  EXPECT_NEAR(max_intensity, 3, 1e-5);
  image = image::Image(32, 32);
  image::write_image(path, {image, {}});
  EXPECT_THROW(build(desc), InputError);
}

// A picture of 2 × 1 pixels, red and green, thrown by 90° along the longer side.
sd::ProjectionLightDesc red_and_green(sd::SceneDesc& desc) {
  const std::string path = testing::TempDir() + "lumirank_slide.pfm";
  image::Image image(2, 1);
  image.at(0, 0) = {1, 0, 0}, image.at(1, 0) = {0, 1, 0};
  image::write_image(path, {image, {}});
  sd::TextureDesc texture;
  sd::BitmapTextureDesc bitmap;
  bitmap.filename = path, bitmap.filter = sd::FilterMode::nearest;
  bitmap.wrap_u = bitmap.wrap_v = sd::WrapMode::clamp;
  texture.kind = bitmap;
  desc.textures.push_back(texture);
  sd::ProjectionLightDesc light;
  light.picture.texture = static_cast<int>(desc.textures.size()) - 1;
  light.fov = 90, light.intensity = Rgb(2);
  return light;
}

TEST(ProjectionLight, ThrowsItsPictureOnSquarePixels) {
  auto desc = empty_scene();
  add_shape(desc, sd::CubeDesc{}, Transform::translate(0, 0, -9));
  sd::ProjectionLightDesc light = red_and_green(desc);
  desc.emitters.emplace_back().kind = light;
  light.to_uv.m[0] = -0.5f;  // mirrored
  light.means = sd::ProjectionLightDesc::Picture::irradiance;
  desc.emitters.emplace_back().kind = light;
  light.axis = sd::FieldAxis::y, light.square = true;
  light.cutoff_angle = 40, light.beam_width = 20;
  light.means = sd::ProjectionLightDesc::Picture::intensity;
  desc.emitters.emplace_back().kind = light;
  light.power = 100;
  desc.emitters.emplace_back().kind = light;
  const World w = build(desc);
  const auto at = [&](int emitter, Vec3f p) {
    return w.sample_direct(emitter, p, 0.5f, {0.5f, 0.5f}).radiance;
  };
  // Half as high as it is wide: 1 and ½ at distance 1.
  const auto expect = [](Rgb found, Rgb expected) {
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(found[c], expected[c], 2e-3f * max_component(expected));
  };
  const float far2 = 1 + 0.36f + 0.16f;
  expect(at(0, {-0.6f, 0.4f, 1}), Rgb(2, 0, 0) / far2);
  expect(at(0, {0.6f, 0.4f, 1}), Rgb(0, 2, 0) / far2);
  expect(at(0, {1.2f, -0.8f, 2}), Rgb(0, 2, 0) / (4 * far2));
  EXPECT_TRUE(is_black(at(0, {0, 0.51f, 1})));
  EXPECT_TRUE(is_black(at(0, {0.6f, 0.4f, -1})));
  // π times the picture on the plane: what faces the light there gets it without the cosine.
  expect(at(1, {0.6f, 0.4f, 1}), Rgb(2 * kPi, 0, 0) * std::sqrt(far2));
  expect(at(1, {-1.2f, 0.2f, 2}), Rgb(0, 2 * kPi, 0) / 4 * std::sqrt(1 + 0.36f + 0.01f));
  // Half of the way from the cut-off to the beam; the frame is a square.
  const float half_way = std::tan(30 * kPi / 180);
  expect(at(2, {half_way, 0.02f, 1}), Rgb(1, 0, 0) / (1 + square(half_way)));
  expect(at(2, {-0.02f, half_way, 1}), Rgb(0, 1, 0) / (1 + square(half_way)));
  EXPECT_TRUE(is_black(at(2, {0.9f, 0, 1})));
  EXPECT_NEAR(luminance(emitters::power(w.emitters()[3], 1)) / (2 * 100), 1, 1e-4f);
}

TEST(ProjectionLight, RefusesAFieldThatIsNone) {
  auto desc = empty_scene();
  add_shape(desc, sd::CubeDesc{}, Transform::translate(0, 0, -9));
  sd::ProjectionLightDesc light = red_and_green(desc);
  light.fov = 180;
  desc.emitters.emplace_back().kind = light;
  EXPECT_THROW(build(desc), InputError);
}

TEST(AreaLight, PowerUnderTransforms) {
  // A rectangle of 4 by ½ turned and mirrored: A = 2, Φ = π·A·L.
  auto desc = empty_scene();
  shine(desc,
        add_shape(desc, sd::RectangleDesc{}, Transform::rotate(1, 2, 3, 77) * Transform::scale(-2, 0.25, 1)),
        {Rgb(3)});
  // A sphere: A = 4πr² whatever its tessellation.
  shine(desc, add_shape(desc, sd::SphereDesc{{1, 2, 3}, 0.5f}, Transform::translate(9, 0, 0)), {Rgb(3)});
  const World w = build(desc);
  EXPECT_NEAR(emitters::power(w.emitters()[0], 1).r / (kPiD * 2 * 3), 1, 1e-5);
  EXPECT_NEAR(emitters::power(w.emitters()[1], 1).r / (kPiD * 4 * kPiD * 0.25 * 3), 1, 1e-4);
}

TEST(AreaLight, SphereAndDiskOverAPoint) {
  auto desc = empty_scene();
  shine(desc, add_shape(desc, sd::SphereDesc{{0, 0, 3}, 1}), {Rgb(2)});
  shine(desc,
        add_shape(desc, sd::DiskDesc{}, Transform::translate(0, 0, 1) * Transform::rotate(1, 0, 0, 180)),
        {Rgb(2)});
  const World w = build(desc);
  // A facing sphere: E = πL (r/d)². The facets' own directions differ from the sphere's by half a facet, 1.4°
  // at 64 rings: the profile of the polyhedron is within (π/64)² = 0.24 % of the circle's.
  expect_mean(irradiance(w, 0, {0, 0, 0}, {0, 0, 1}, 1), kPiD * 2 / 9, 0.0024);
  // A disk of radius 1 at a distance of 1: E = πL/2; 128 segments lack (2π/128)²/6 = 0.04 % of the area.
  expect_mean(irradiance(w, 1, {0, 0, 0}, {0, 0, 1}, 2), kPiD, 0.0005);
}

TEST(AreaLight, ManySpheresKeepTheirPower) {
  auto desc = empty_scene();
  for (int k = 0; k < 300; ++k)
    shine(desc, add_shape(desc, sd::SphereDesc{{static_cast<float>(k), 0, 0}, 0.1f}), {Rgb(1)});
  const World w = build(desc);
  EXPECT_LT(w.info().triangles, 2u << 20);
  for (const auto& e : w.emitters())
    EXPECT_NEAR(emitters::power(e, 1).g / (kPiD * 4 * kPiD * 0.01), 1,
                1e-3);  // coordinates of 300 hold 3·10⁻⁵ ± of 0.1
}

TEST(AreaLight, TexturedRadianceIsExactInEverySample) {
  const std::string path = ::testing::TempDir() + "lumirank_world_lamp.pfm";
  image::Image image(4, 4);
  for (int y = 0; y < 4; ++y)
    for (int x = 0; x < 4; ++x) image.at(x, y) = Rgb(static_cast<float>(1 + x + 4 * y));
  image::write_image(path, {image, {}});
  auto desc = empty_scene();
  sd::BitmapTextureDesc bitmap;
  bitmap.filename = path;
  bitmap.filter = sd::FilterMode::nearest;
  const int t = add_texture(desc, bitmap);
  const int s = add_shape(desc, sd::RectangleDesc{});
  shine(desc, s, {Rgb(0), t});
  const World w = build(desc);
  std::remove(path.c_str());
  // The mean of 1 … 16 is 8.5, the area 4.
  RunningMean weight;
  for (std::uint64_t i = 0; i < 40000; ++i) {
    Rng rng(3, Stage::test, i);
    const float u1 = rng.next_float();
    const Vec2f up = rng.next_2d(), ud = rng.next_2d();
    weight.add(w.sample_emission(0, u1, up, ud).weight.g);
    const auto d = w.sample_direct(0, {0.3f, 0.1f, 2}, u1, up);
    const auto hit = w.intersect(ray({0.3f, 0.1f, 2}, d.direction));
    ASSERT_TRUE(hit);
    // A sample within rounding of a texel's edge may read the neighbor: only the bulk is compared.
    if (i < 200) {
      EXPECT_EQ(w.emitted(*hit, -d.direction), d.radiance);
    }
  }
  expect_mean(weight, kPiD * 4 * 8.5);
  EXPECT_NEAR(emitters::power(w.emitters()[0], 1).g / (kPiD * 4 * 8.5), 1,
              0.05);  // from 16 points per triangle
}

TEST(Environment, MapIsReadAndTurned) {
  const std::string path = ::testing::TempDir() + "lumirank_world_sky.pfm";
  image::Image image(8, 4, Rgb(0.25f));
  image.at(2, 1) = Rgb(4);  // longitude 2.5/8 · 2π: towards +x, a little to +z
  image::write_image(path, {image, {}});
  auto desc = empty_scene();
  add_shape(desc, sd::RectangleDesc{});
  sd::EnvironmentMapDesc map{path, 2, Transform::rotate(0, 1, 0, 90) * Transform::scale(5, 5, 5)};
  add_emitter(desc, map, "sky");
  const World w = build(desc);
  std::remove(path.c_str());
  ASSERT_EQ(w.environment(), 0);
  const Vec3f local = emitters::map_direction({2.5f, 1.5f}, 8, 4);
  EXPECT_GT(local.x, 0.8f);
  const Vec3f world = Transform::rotate(0, 1, 0, 90).vector(local);
  EXPECT_NEAR(w.background(world).r, 8, 1e-3);
  EXPECT_NEAR(w.background({0, -1, 0}).r, 0.5, 1e-5);
}

TEST(Environment, SeveralAreSummed) {
  auto desc = empty_scene();
  add_shape(desc, sd::RectangleDesc{});
  add_emitter(desc, sd::ConstantEnvironmentDesc{Rgb(1, 0, 0)}, "a");
  add_emitter(desc, sd::ConstantEnvironmentDesc{Rgb(0, 2, 0)}, "b");
  sd::SunSkyDesc sky;
  sky.sun = false;
  sky.sun_direction = {0.3f, 0.8f, 0.2f};
  add_emitter(desc, sky, "c");
  const World w = build(desc);
  ASSERT_EQ(w.emitters().size(), 1u);
  EXPECT_EQ(w.emitters()[0].name, "a");
  EXPECT_EQ(w.background({0, -1, 0}), Rgb(1, 2, 0));
  const emitters::HosekWilkieSky model(3, sky.albedo, normalize(Vec3f{0.3f, 0.8f, 0.2f}));
  const Rgb zenith = w.background({0, 1, 0}), expected = model.radiance({0, 1, 0}) + Rgb(1, 2, 0);
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(zenith[k] / expected[k], 1, 0.01);  // one texel is 0.7° wide
}

TEST(Sun, ShinesFromItsDirection) {
  auto desc = empty_scene();
  add_shape(desc, sd::RectangleDesc{});
  sd::SunSkyDesc day;
  day.sun_direction = {0, 2, 2};
  day.to_world = Transform::rotate(1, 0, 0, 90);  // z up: local +y becomes +z, local +z becomes -y
  day.sun_scale = 3, day.sun_radius_scale = 2;
  add_emitter(desc, day, "day");
  const World w = build(desc);
  ASSERT_EQ(w.emitters().size(), 2u);
  EXPECT_EQ(w.environment(), 1);
  EXPECT_EQ(w.emitters()[0].group, w.emitters()[1].group);
  const auto& sun = std::get<emitters::DirectionalEmitter>(w.emitters()[0].kind);
  const Vec3f towards = normalize(Vec3f{0, -1, 1});
  EXPECT_LT(length(sun.direction + towards), 1e-6f);
  EXPECT_NEAR(std::acos(sun.cos_half_angle), 2 * 0.2679 * kPiD / 180, 1e-4);
  // The irradiance is that of the undilated disc: L π sin²α.
  const double expected = 3 * luminance(emitters::hosek_wilkie_sun(3, static_cast<float>(kPiD / 4))) * kPiD *
                          std::pow(std::sin(0.2679 * kPiD / 180), 2);
  EXPECT_NEAR(luminance(sun.irradiance) / expected, 1, 1e-3);
  // Seen directly, the disc has the radiance that integrates to the irradiance: E = L π sin²α. The half angle
  // comes from a float cosine near 1, whose rounding of 6·10⁻⁸ is 1.4·10⁻³ of 1 - cos α = 4.4·10⁻⁵.
  const double sine = std::sin(2 * 0.2679 * kPiD / 180);
  EXPECT_NEAR(w.sun_disc(towards).g / (sun.irradiance.g / (kPiD * sine * sine)), 1, 3e-3);
  EXPECT_EQ(w.sun_disc(normalize(towards + Vec3f{0.02f, 0, 0})), Rgb(0));
  EXPECT_EQ(w.sun_disc(-towards), Rgb(0));
  // The mean over the disc of the facing irradiance.
  RunningMean mean;
  for (std::uint64_t i = 0; i < 1000; ++i) {
    Rng rng(4, Stage::test, i);
    const auto s = w.sample_direct(0, {0, 0, 0}, 0, rng.next_2d());
    EXPECT_GT(dot(s.direction, towards), sun.cos_half_angle - 1e-6f);
    mean.add(s.radiance.g * dot(s.direction, towards));
  }
  expect_mean(mean, sun.irradiance.g);
}

TEST(World, EmissionStartsOutsideOfTheScene) {
  auto desc = empty_scene();
  add_shape(desc, sd::SphereDesc{{4, 5, 6}, 2});
  add_emitter(desc, sd::ConstantEnvironmentDesc{});
  add_emitter(desc, sd::DirectionalLightDesc{{1, 1, 0}, Rgb(1)});
  const World w = build(desc);
  for (int e = 0; e < 2; ++e)
    for (std::uint64_t i = 0; i < 200; ++i) {
      Rng rng(5, Stage::test, i);
      const Vec2f up = rng.next_2d(), ud = rng.next_2d();
      const auto s = w.sample_emission(e, 0, up, ud);
      EXPECT_GE(length(s.origin - Vec3f{4, 5, 6}), 2);
      EXPECT_NEAR(length(s.direction), 1, 1e-5);
    }
}

}  // namespace
}  // namespace lumirank::world
