// Scenes of any size and place are built in units of their own, and most keep the file's.
#include "world/units.h"

#include <gtest/gtest.h>

#include "base/error.h"
#include "image/image_io.h"
#include "support/scene_file.h"
#include "world/scene_maker.h"

namespace lumirank::test {
namespace {

using world::Units;

Bounds3d box(Vec3d center, double half) {
  Bounds3d b;
  b.extend(center - Vec3d{half, half, half}), b.extend(center + Vec3d{half, half, half});
  return b;
}

TEST(Units, OrdinaryScenesKeepTheirs) {
  for (const double half : {0.02, 1.0, 100.0, 3e6})
    for (const double away : {0.0, 2.0, 13.0}) {  // in halves: the radius is √3 of them
      EXPECT_TRUE(Units(box({away * half, 0, -half}, half)).are_the_files()) << half << " " << away;
    }
  EXPECT_TRUE(Units(Bounds3d{}).are_the_files());
}

TEST(Units, FarTinyAndHugeScenesAreMovedAndScaledByRoundNumbers) {
  const Units far(box({4e5, -5e6, 3}, 2));
  EXPECT_EQ(far.scale(), 1);
  EXPECT_EQ(far.origin(), Vec3d(4e5, -5e6, 0));  // multiples of 2; along z it is near
  EXPECT_EQ(far.to_world(Vec3d{400001.25, -4999999.5, 3}), (Vec3f{1.25f, 0.5f, 3}));
  for (const double half : {1e-3, 1e-9, 1e-30, 1e9, 1e12, 1e30}) {
    const Units units(box({0, 0, 0}, half));
    EXPECT_EQ(units.scale(), std::exp2(std::round(std::log2(units.scale()))));
    const double radius = units.scale() * half * std::sqrt(3.0);
    const double min_radius = half < 1 ? 1 : 0x1p23;
    EXPECT_TRUE(radius >= min_radius && radius <= 2 * min_radius) << half;
  }
}

// Something huge or far away leaves small things beside it as they are.
TEST(Units, OneStrayShapeDoesNotShrinkTheOthers) {
  for (const double away : {1e9, 1e15, 1e30}) {
    sd::SceneDesc desc = empty_scene();
    add_shape(desc, sd::CubeDesc{});
    add_shape(desc, sd::CubeDesc{}, Transform::translate(away, 0, 0) * Transform::scale(0.1 * away, 1, 1));
    const world::World w = build(desc);
    EXPECT_TRUE(w.units().are_the_files()) << away;
    const auto hit = w.intersect(ray({0.25f, 0.5f, 9}, {0, 0, -1}));
    ASSERT_TRUE(hit) << away;
    // Narrower vectors of Embree divide less exactly.
    EXPECT_FLOAT_EQ(hit->hit.t, 8);
  }
}

TEST(Units, GoBackToTheFiles) {
  const Units units(box({3e5, 2e-4, -7e4}, 1e-3));
  EXPECT_NE(units.scale(), 1);
  const Vec3d place{3e5 + 0.6e-3, 1e-4, -7e4 - 0.3e-3};
  const Vec3f own = units.to_world(place);
  EXPECT_LT(std::abs(own.x), 2);
  const Vec3d back = units.place_in_file(own);
  // 2⁻²⁴ of the scene's size by rounding to 32 bits, 2⁻⁵³ of the place's by that to 64.
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(back[k], place[k], 1e-3 * 0x1p-23 + std::abs(place[k]) * 0x1p-52);
  EXPECT_FLOAT_EQ(units.power_in_file(units.power_to_world(Rgb(3))).g, 3);
  EXPECT_FLOAT_EQ(units.length_in_file(static_cast<float>(units.scale())), 1);
}

// Shapes of every kind are met where they are.
TEST(Units, FarShapesAreMetWhereTheFileHasThem) {
  const double d = 1e6;
  const Transform there = Transform::translate(d, -d, d);
  auto mesh = std::make_shared<sd::MeshData>();
  mesh->origin = {d, -d, d};
  mesh->positions = {{-1, 2, -1}, {1, 2, -1}, {0, 2, 1}}, mesh->indices = {0, 1, 2};
  sd::SceneDesc desc = empty_scene();
  add_shape(desc, sd::SphereDesc{{d + 4, -d, d}, 0.5f});
  add_shape(desc, sd::CylinderDesc{{d - 4, -d, d - 1}, {d - 4, -d, d + 1}, 0.25f});
  add_shape(desc, sd::CubeDesc{}, there * Transform::translate(0, -4, 0));
  add_shape(desc, sd::InlineMeshDesc{mesh, "triangle"});
  sd::CurvesDesc curves;
  curves.basis = sd::CurvesDesc::Basis::linear;
  curves.origin = {d, -d, d};
  curves.points = {{-1, 0, 4}, {1, 0, 4}}, curves.radii = {0.125f, 0.125f}, curves.first = {0, 2};
  add_shape(desc, curves);
  const world::World w = build(desc);
  EXPECT_FALSE(w.units().are_the_files());
  const auto distance = [&](Vec3d from, Vec3f direction) {
    const auto hit = w.intersect(ray(w.units().to_world(from + Vec3d{d, -d, d}), direction));
    return hit ? w.units().length_in_file(hit->hit.t) : kInfinity;
  };
  EXPECT_NEAR(distance({0, 0, 0}, {1, 0, 0}), 3.5, 3.5 * 1e-3);  // tessellated: within 10⁻³
  EXPECT_NEAR(distance({0, 0, 0}, {-1, 0, 0}), 3.75, 1e-3);
  EXPECT_NEAR(distance({0.25, 0, 0.125}, {0, -1, 0}), 3, 8 * 0x1p-22);
  EXPECT_NEAR(distance({0, 0, 0}, {0, 1, 0}), 2, 8 * 0x1p-22);
  EXPECT_NEAR(distance({0, 0, 0}, {0, 0, 1}), 4, 8 * 0x1p-22);  // a ribbon through the axis
}

TEST(Units, PointLightsKeepTheirIrradiance) {
  sd::SceneDesc desc = empty_scene();
  const double s = 1e-8;
  add_shape(desc, sd::CubeDesc{}, Transform::scale(s, s, s));
  add_emitter(desc, sd::PointLightDesc{{3 * s, 0, 0}, Rgb(static_cast<float>(s * s))});
  const world::World w = build(desc);
  const auto seen = w.sample_direct(0, w.units().to_world(Vec3d{s, 0, 0}), 0, {});
  EXPECT_NEAR(seen.radiance.r, 0.25, 1e-6);
}

// Bumps are lengths: the slope of the surface does not depend on the unit.
TEST(Units, BumpsKeepTheirSlope) {
  const TemporaryFolder folder;
  image::LayeredImage ramp;
  ramp.color = image::Image(4, 1);
  for (int x = 0; x < 4; ++x) ramp.color.at(x, 0) = Rgb(0.25f * static_cast<float>(x));
  image::write_image(folder / "ramp.pfm", ramp);
  const auto normal = [&](double s) {
    sd::SceneDesc desc = empty_scene();
    sd::BitmapTextureDesc heights;
    heights.filename = folder / "ramp.pfm";
    sd::BumpMapDesc bump;
    bump.texture = add_texture(desc, heights);
    bump.scale = static_cast<float>(s);
    bump.nested = add_bsdf(desc, sd::DiffuseDesc{});
    const int plane = add_shape(desc, sd::RectangleDesc{}, Transform::scale(s, s, s));
    desc.shapes[static_cast<std::size_t>(plane)].bsdf = add_bsdf(desc, bump);
    const world::World w = build(desc);
    const auto hit = w.intersect(ray(w.units().to_world(Vec3d{0.1 * s, 0.5 * s, s}), {0, 0, -1}));
    return w.materials().closure(hit->material, hit->point, {0, 0, 1}).frame.n;
  };
  const Vec3f here = normal(1), tiny = normal(1e-7);
  EXPECT_NEAR(here.x, -1 / std::sqrt(5.0f), 1e-3f);  // 1 up over a width of 2
  EXPECT_LT(length(here - tiny), 1e-4f);
}

template <typename Desc>
void refuses(const Desc& change, const std::string& what) {
  sd::SceneDesc desc = empty_scene();
  add_shape(desc, sd::SphereDesc{});
  change(desc);
  try {
    build(desc);
    ADD_FAILURE() << what << " was taken";
  } catch (const InputError& e) {
    EXPECT_NE(std::string(e.what()).find("32-bit arithmetic"), std::string::npos) << e.what();
    EXPECT_NE(std::string(e.what()).find("scene.xml:7"), std::string::npos) << e.what();
  }
}

TEST(GreatNumbers, AreRefusedWhereTheyAreStated) {
  refuses(
      [](sd::SceneDesc& d) {
        shine(d, 0, {Rgb(1e25f)});
        d.shapes[0].emitter->where = {"scene.xml", 7};
      },
      "radiance");
  refuses([](sd::SceneDesc& d) { add_emitter(d, sd::SpotLightDesc{{}, Rgb(1e25f)}, "", 7); }, "intensity");
  refuses([](sd::SceneDesc& d) { add_emitter(d, sd::PointLightDesc{{}, Rgb(1e17f)}, "", 7); }, "intensity");
  refuses(
      [](sd::SceneDesc& d) {
        add_emitter(d, sd::DirectionalLightDesc{{0, 0, 1}, Rgb(2e16f)}, "", 7);
      },
      "irradiance");
  refuses([](sd::SceneDesc& d) { add_emitter(d, sd::ConstantEnvironmentDesc{Rgb(1e38f)}, "", 7); },
          "environment");
  refuses(
      [](sd::SceneDesc& d) {
        sd::ConductorDesc metal;
        metal.eta = metal.k = Rgb(1e30f), metal.alpha_u.value = metal.alpha_v.value = 0.1f;
        d.shapes[0].bsdf = add_bsdf(d, metal, 7);
      },
      "index of a conductor");
  refuses(
      [](sd::SceneDesc& d) {
        sd::DielectricDesc glass;
        glass.eta = 1e30f;
        d.shapes[0].bsdf = add_bsdf(d, glass, 7);
      },
      "index of a dielectric");
}

TEST(GreatNumbers, OfSunAndLampsAreTaken) {
  sd::SceneDesc desc = empty_scene();
  add_shape(desc, sd::SphereDesc{});
  shine(desc, 0, {Rgb(1e12f)});
  add_emitter(desc, sd::DirectionalLightDesc{{0, 0, 1}, Rgb(1e6f)});
  EXPECT_NO_THROW(build(desc));
}

}  // namespace
}  // namespace lumirank::test
