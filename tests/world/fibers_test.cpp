// Curves in a world: where shading sees a fiber, what may lie on one, and what is refused.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "base/error.h"
#include "base/random.h"
#include "base/warp.h"
#include "scene_maker.h"

namespace lumirank::test {
namespace {

sd::CurvesDesc rod(Vec3f a, Vec3f b, float radius) {
  sd::CurvesDesc c;
  c.basis = sd::CurvesDesc::Basis::linear;
  c.points = {a, b}, c.radii = {radius, radius}, c.first = {0, 2};
  return c;
}

sd::SceneDesc one_rod(int* bsdf = nullptr) {
  sd::SceneDesc desc = empty_scene();
  const int shape = add_shape(desc, rod({-1, 0, 0}, {1, 0, 0}, 0.1f));
  const int hair = add_bsdf(desc, sd::HairDesc{}, 7);
  desc.shapes[static_cast<std::size_t>(shape)].bsdf = hair;
  if (bsdf) *bsdf = hair;
  return desc;
}

TEST(WorldFibers, HairLiesOnTheAxisAndHasNoSides) {
  const world::World world = build(one_rod());
  const auto hit = world.intersect(ray({0.5f, 0.06f, -3}, {0, 0, 1}));
  ASSERT_TRUE(hit);
  EXPECT_LT(length(hit->point.position - Vec3f{0.5f, 0, 0}), 1e-6f);
  EXPECT_EQ(hit->point.ng, Vec3f{});
  EXPECT_NEAR(std::abs(hit->point.shading.s.x), 1, 1e-6f);
  EXPECT_LT(length(hit->point.shading.n - Vec3f{0, 0, -1}), 1e-5f);
  EXPECT_NEAR(hit->point.uv.uv.x, 0.75f, 1e-6f);
  const auto closure = world.materials().closure(hit->material, hit->point, {0, 0, -1});
  EXPECT_TRUE(closure.is_fiber());
  EXPECT_FALSE(is_black(scatter::eval(closure, {0, 0, -1}, {0, 0, 1})));
}

// The ribbon turns to the ray; the thread that other BSDFs see does not.
TEST(WorldFibers, OtherBsdfsSeeARoundThread) {
  sd::SceneDesc desc = empty_scene();
  const Transform to_world =
      Transform::translate(3, -1, 2) * Transform::rotate(1, 1, 0, 33) * Transform::scale(2, 2, 2);
  add_shape(desc, rod({-1, 0, 0}, {1, 0, 0}, 0.1f), to_world);
  const world::World world = build(desc);
  const Vec3f a = to_world.point({-1, 0, 0}), along = normalize(to_world.vector({1, 0, 0}));
  Rng rng(1, Stage::test);
  int hits = 0;
  for (int k = 0; k < 500; ++k) {
    const Vec3f target = a + along * (0.2f + 3.6f * rng.next_float());
    const Vec3f sideways = warp_sphere(rng.next_2d());
    const Vec3f origin = target + warp_sphere(rng.next_2d()) * 5.0f, d = target + sideways * 0.15f - origin;
    const auto hit = world.intersect(ray(origin, d));
    if (!hit) continue;
    ++hits;
    const Vec3f off = hit->point.position - a;
    const Vec3f radial = off - along * dot(off, along);
    EXPECT_NEAR(length(radial), 0.2f, 2e-5f);
    EXPECT_LT(length(hit->point.ng - radial / 0.2f), 2e-3f);
    EXPECT_LT(dot(hit->point.ng, d), 1e-3f * length(d));
    EXPECT_NEAR(dot(hit->point.shading.n, along), 0, 1e-5f);
    // Seen along the ray, both lie equally far beside the axis.
    const Vec3f met = origin + d * hit->hit.t - hit->point.position;
    EXPECT_LT(std::abs(dot(met, normalize(cross(along, d)))), 1e-4f);
    // Light from outside of the thread reaches the point, and rays leave it.
    const Vec3f w = normalize(hit->point.ng + warp_sphere(rng.next_2d()) * 0.9f);
    EXPECT_FALSE(
        world.rays().occluded({world::World::offset_origin(hit->point.position, hit->point.ng, w), w}, 0));
  }
  EXPECT_GT(hits, 300);
}

TEST(WorldFibers, InstancesScaleTheRadius) {
  sd::SceneDesc desc = empty_scene();
  const int member = add_shape(desc, rod({-1, 0, 0}, {1, 0, 0}, 0.1f));
  desc.shapes[static_cast<std::size_t>(member)].in_group = true;
  const int group = add_shape(desc, sd::ShapeGroupDesc{{member}});
  add_shape(desc, sd::InstanceDesc{group}, Transform::scale(3, 3, 3));
  add_shape(desc, sd::InstanceDesc{group}, Transform::translate(0, 5, 0) * Transform::scale(0.5, 0.5, 0.5));
  const world::World world = build(desc);
  EXPECT_EQ(world.info().segments, 2u);
  EXPECT_TRUE(world.intersect(ray({0, 0.29f, -3}, {0, 0, 1})));
  EXPECT_FALSE(world.intersect(ray({0, 0.31f, -3}, {0, 0, 1})));
  const auto hit = world.intersect(ray({0, 5, -3}, {0, 0, 1}));
  ASSERT_TRUE(hit);
  EXPECT_LT(length(hit->point.position - Vec3f{0, 5, -0.05f}), 1e-5f);
}

TEST(WorldFibers, WhatHairCannotBeIsReplacedByName) {
  int hair = 0;
  sd::SceneDesc desc = one_rod(&hair);
  auto& rod_bsdf = desc.shapes[0].bsdf;
  const auto words = [&] {
    std::vector<sd::Warning> warnings;
    build(desc, &warnings);
    std::string all;
    for (const auto& w : warnings) all += w.what + " -> " + w.used_instead + "\n";
    return all;
  };
  EXPECT_EQ(words().find("hair"), std::string::npos);
  const int diffuse = add_bsdf(desc, sd::DiffuseDesc{});
  rod_bsdf =
      add_bsdf(desc, sd::MixtureDesc{{{{0.5f, sd::kNone}, false, hair}, {{0.5f, sd::kNone}, true, diffuse}}});
  EXPECT_NE(words().find("a mixture of hair with a BSDF of surfaces -> the hair alone"), std::string::npos);
  rod_bsdf = add_bsdf(desc, sd::TwoSidedDesc{hair, hair});
  EXPECT_EQ(words().find("hair"), std::string::npos);
  rod_bsdf = add_bsdf(desc, sd::MaskDesc{{0.5f, sd::kNone}, hair});
  EXPECT_EQ(words().find("hair"), std::string::npos);
  const int plate = add_shape(desc, sd::RectangleDesc{});
  desc.shapes[static_cast<std::size_t>(plate)].bsdf = hair;
  EXPECT_NE(words().find("a hair BSDF on a surface -> diffuse"), std::string::npos);
  shine(desc, 0, {Rgb(1), sd::kNone});
  EXPECT_NE(words().find("an emitter on curves -> the curves without it"), std::string::npos);
}

TEST(WorldFibers, CurvesThatMakeNoSenseAreRefused) {
  const auto refused = [](const sd::CurvesDesc& curves, const char* says) {
    sd::SceneDesc desc = empty_scene();
    add_shape(desc, curves, {}, 12);
    try {
      build(desc);
      ADD_FAILURE() << says;
    } catch (const InputError& e) {
      EXPECT_EQ(e.where().line, 12);
      EXPECT_NE(std::string(e.what()).find(says), std::string::npos) << e.what();
    }
  };
  sd::CurvesDesc c = rod({0, 0, 0}, {1, 0, 0}, 0.1f);
  c.basis = sd::CurvesDesc::Basis::bspline;
  refused(c, "too few points");
  c = rod({0, 0, 0}, {1, 0, 0}, 0.1f);
  c.radii.pop_back();
  refused(c, "do not fit");
  c = rod({0, 0, 0}, {1, 0, 0}, -0.1f);
  refused(c, "negative");
  c = rod({0, 0, 0}, {1, kInfinity, 0}, 0.1f);
  refused(c, "not finite");
  refused(sd::CurvesDesc{}, "too few points");
}

}  // namespace
}  // namespace lumirank::test
