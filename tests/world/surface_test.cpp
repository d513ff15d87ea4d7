// Points of surfaces: normals, tangents, transforms.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "world/scene_maker.h"

namespace lumirank::world {
namespace {

using namespace test;

void expect_near(Vec3f a, Vec3f b, float tolerance = 1e-5f) {
  EXPECT_LT(length(a - b), tolerance)
      << a.x << ' ' << a.y << ' ' << a.z << " is not " << b.x << ' ' << b.y << ' ' << b.z;
}

TEST(Surface, RectangleHasItsTangentsAndNormal) {
  auto desc = empty_scene();
  add_shape(desc, sd::RectangleDesc{}, Transform::translate(0, 0, 2) * Transform::scale(3, 0.5, 1));
  const World w = build(desc);
  const auto hit = w.intersect(ray({1, 0.25f, 5}, {0, 0, -1}));
  ASSERT_TRUE(hit);
  expect_near(hit->point.position, {1, 0.25f, 2});
  expect_near(hit->point.ng, {0, 0, 1});
  expect_near(hit->point.shading.n, {0, 0, 1});
  // u runs over [0, 1] along the width of 6, v along the height of 1.
  expect_near(hit->point.dpdu, {6, 0, 0});
  expect_near(hit->point.dpdv, {0, 1, 0});
  EXPECT_NEAR(hit->point.uv.uv.x, 0.5 + 1.0 / 6, 1e-5);
  EXPECT_NEAR(hit->point.uv.uv.y, 0.75, 1e-5);
  expect_near(hit->point.shading.s, {1, 0, 0});
  EXPECT_EQ(hit->emitter, -1);
}

TEST(Surface, NormalsPointOutwardsUnderMirroringAndTurnWhenFlipped) {
  for (const Transform& t : {Transform{}, Transform::scale(-1, 1, 1), Transform::scale(-2, -1, -0.5),
                             Transform::rotate(1, 1, 0, 70) * Transform::scale(1, -3, 1)})
    for (const bool flip : {false, true})
      for (const int copies : {1, 2}) {  // placed once: moved into the world; twice: shared
        auto desc = empty_scene();
        const int first = add_shape(desc, sd::SphereDesc{{0, 0, 0}, 1}, t);
        desc.shapes[static_cast<std::size_t>(first)].flip_normals = flip;
        if (copies == 2) add_shape(desc, sd::SphereDesc{{0, 0, 0}, 1}, Transform::translate(100, 0, 0));
        const World w = build(desc);
        for (const Vec3f d : {Vec3f{1, 0.2f, 0.1f}, Vec3f{-0.3f, 1, 0.4f}, Vec3f{0.2f, 0.1f, -1}}) {
          const auto hit = w.intersect(ray(normalize(d) * 10.0f, -normalize(d)));
          ASSERT_TRUE(hit);
          // The exact normal of the ellipsoid |M⁻¹p| = 1 at p is along M⁻ᵀM⁻¹p; 64 rings of facets are within
          // 3°.
          const Transform inverse = *t.inverse();
          Vec3f expected = normalize(Transform::normal(inverse, inverse.point(hit->point.position)));
          if (flip) expected = -expected;
          EXPECT_GT(dot(hit->point.shading.n, expected), 0.99f);
          EXPECT_GT(dot(hit->point.ng, expected), 0.95f);
          EXPECT_GE(dot(hit->point.ng, hit->point.shading.n), 0);
          EXPECT_NEAR(length(hit->point.ng), 1, 1e-5);
          EXPECT_NEAR(length(hit->point.shading.n), 1, 1e-5);
        }
      }
}

TEST(Surface, SharedAndMovedMeshesAgree) {
  // The same sphere placed once and as one of two copies gives the same point, frame and coordinates.
  const Transform t =
      Transform::translate(1, 2, 3) * Transform::rotate(1, 2, 3, 40) * Transform::scale(1, -2, 0.5);
  auto one = empty_scene(), two = empty_scene();
  add_shape(one, sd::SphereDesc{{0.1f, 0, 0}, 1}, t);
  add_shape(two, sd::SphereDesc{{0.1f, 0, 0}, 1}, t);
  add_shape(two, sd::SphereDesc{{0.1f, 0, 0}, 1}, Transform::translate(50, 0, 0));
  const World a = build(one), b = build(two);
  EXPECT_EQ(b.info().meshes, 1u);
  EXPECT_EQ(b.info().instances, 2u);
  EXPECT_EQ(b.info().triangles, 2 * a.info().triangles);
  EXPECT_EQ(b.info().unique_triangles, a.info().triangles);
  for (int k = 0; k < 20; ++k) {
    const Vec3f d = normalize(Vec3f{std::sin(k * 1.3f), std::cos(k * 2.1f), std::sin(k * 0.7f + 1)});
    const auto p = a.intersect(ray(Vec3f{1, 2, 3} + d * 9.0f, -d)),
               q = b.intersect(ray(Vec3f{1, 2, 3} + d * 9.0f, -d));
    ASSERT_EQ(p.has_value(), q.has_value());
    if (!p) continue;
    expect_near(p->point.position, q->point.position, 1e-4f);
    // Facets are at least some 10⁻³ across, and their corners are rounded by 2⁻²⁴ of coordinates up to 5.
    expect_near(p->point.ng, q->point.ng, 1e-3f);
    expect_near(p->point.shading.n, q->point.shading.n, 1e-3f);
    expect_near(p->point.dpdu, q->point.dpdu, 1e-2f * length(p->point.dpdu));
    EXPECT_NEAR(p->point.uv.uv.x, q->point.uv.uv.x, 1e-3);
  }
}

TEST(Surface, InstancesOfAGroup) {
  auto desc = empty_scene();
  const int child = add_shape(desc, sd::RectangleDesc{}, Transform::translate(0, 0, 1));
  desc.shapes[static_cast<std::size_t>(child)].in_group = true;
  const int group = add_shape(desc, sd::ShapeGroupDesc{{child}});
  add_shape(desc, sd::InstanceDesc{group}, Transform::translate(10, 0, 0));
  add_shape(desc, sd::InstanceDesc{group}, Transform::translate(-10, 0, 0) * Transform::scale(1, 1, 2));
  const World w = build(desc);
  EXPECT_FALSE(w.intersect(ray({0, 0, 9}, {0, 0, -1})));  // the group itself is not in the world
  const auto right = w.intersect(ray({10, 0, 9}, {0, 0, -1})),
             left = w.intersect(ray({-10, 0, 9}, {0, 0, -1}));
  ASSERT_TRUE(right && left);
  EXPECT_NEAR(right->point.position.z, 1, 1e-5);
  EXPECT_NEAR(left->point.position.z, 2, 1e-5);  // the child's translation is scaled
  EXPECT_EQ(w.info().instances, 2u);
}

class TemporaryFile {
 public:
  TemporaryFile(const std::string& name, const std::string& text) {
    path_ = std::filesystem::temp_directory_path() /
            ("lumirank_world_" + std::to_string(::getpid()) + "_" + name);
    std::ofstream(path_) << text;
  }
  ~TemporaryFile() { std::filesystem::remove(path_); }
  std::string path() const { return path_.string(); }

 private:
  std::filesystem::path path_;
};

TEST(Surface, AMeshWithoutUvHasBarycentricsAndAFrame) {
  const TemporaryFile file("plain.obj", "v 0 0 0\nv 2 0 0\nv 0 2 0\nf 1 2 3\n");
  auto desc = empty_scene();
  sd::MeshFileDesc mesh;
  mesh.filename = file.path();
  add_shape(desc, mesh);
  const World w = build(desc);
  const auto hit = w.intersect(ray({0.5f, 1, 5}, {0, 0, -1}));
  ASSERT_TRUE(hit);
  EXPECT_NEAR(hit->point.uv.uv.x, 0.25, 1e-5);
  EXPECT_NEAR(hit->point.uv.uv.y, 0.5, 1e-5);
  EXPECT_EQ(hit->point.dpdu, (Vec3f{}));
  expect_near(hit->point.ng, {0, 0, 1});
  EXPECT_NEAR(dot(hit->point.shading.s, hit->point.shading.n), 0, 1e-6);
}

TEST(Surface, TheOutsideIsTheSideOfTheVertexNormals) {
  // The corners run clockwise seen from +z, but the file's normals point to +z; the third normal is slanted.
  const TemporaryFile file("normals.obj",
                           "v 0 0 0\nv 0 2 0\nv 2 0 0\nvn 0 0 1\nvn 0.6 0 0.8\nf 1//1 2//1 3//2\n");
  auto desc = empty_scene();
  sd::MeshFileDesc mesh;
  mesh.filename = file.path();
  const int shape = add_shape(desc, mesh);
  shine(desc, shape, {Rgb(1)});
  const World w = build(desc);
  const auto hit = w.intersect(ray({1, 0.5f, 5}, {0, 0, -1}));
  ASSERT_TRUE(hit);
  expect_near(hit->point.ng, {0, 0, 1});
  // Weights ¼, ¼, ½: (0.3, 0, 0.9) normalized.
  expect_near(hit->point.shading.n, normalize(Vec3f{0.3f, 0, 0.9f}));
  EXPECT_EQ(w.emitted(*hit, {0, 0, 1}), Rgb(1));
  EXPECT_EQ(w.emitted(*hit, {0, 0, -1}), Rgb(0));
  const auto& area = std::get<emitters::AreaEmitter>(w.emitters()[0].kind);
  expect_near(area.triangles[0].normal, {0, 0, 1});
}

TEST(Surface, FilesAreReadOnceAndDegenerateTrianglesNoted) {
  const TemporaryFile file("two.obj",
                           "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 2 0 0\nf 1 2 3\nf 1 2 4\n");  // the second is flat
  auto desc = empty_scene();
  sd::MeshFileDesc mesh;
  mesh.filename = file.path();
  add_shape(desc, mesh, {}, 7);
  add_shape(desc, mesh, Transform::translate(0, 0, 3), 8);
  add_emitter(desc, sd::ConstantEnvironmentDesc{});
  std::vector<sd::Warning> warnings;
  const World w = build(desc, &warnings, true);  // strict: a note is no error
  EXPECT_EQ(w.info().meshes, 1u);
  EXPECT_EQ(w.info().instances, 2u);
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_EQ(warnings[0].where, (SourceLocation{"scene.xml", 7}));
  EXPECT_NE(warnings[0].what.find("degenerate"), std::string::npos) << warnings[0].what;
  EXPECT_TRUE(warnings[0].harmless);
}

TEST(Surface, WhatWasMendedInAMeshIsAWarning) {
  const TemporaryFile file("bent.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 0\nf 1//1 2//1 3//1\n");
  auto desc = empty_scene();
  sd::MeshFileDesc mesh;
  mesh.filename = file.path();
  add_shape(desc, mesh, {}, 7);
  add_emitter(desc, sd::ConstantEnvironmentDesc{});
  std::vector<sd::Warning> warnings;
  build(desc, &warnings);
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_NE(warnings[0].what.find("3 missing normals"), std::string::npos) << warnings[0].what;
  EXPECT_FALSE(warnings[0].harmless);
  EXPECT_THROW(build(desc, nullptr, true), InputError);
}

TEST(Surface, OffsetKeepsAwayFromItsOwnTriangle) {
  // From points all over a large tilted triangle, rays into the upper half space leave without meeting it.
  const TemporaryFile file("large.obj", "v -900 -700 -333\nv 1100 -300 217\nv -200 1300 91\nf 1 2 3\n");
  auto desc = empty_scene();
  sd::MeshFileDesc mesh;
  mesh.filename = file.path();
  add_shape(desc, mesh);
  const World w = build(desc);
  int met = 0, tried = 0;
  for (int k = 0; k < 2000; ++k) {
    const float a = static_cast<float>(k % 45) / 46, b = static_cast<float>(k / 45) / 46;
    if (a + b > 1) continue;
    geometry::Hit hit;
    hit.barycentric = {a, b};
    const SurfaceHit at = w.surface(hit, {});
    const Frame f = Frame::from_normal(at.point.ng);
    for (const float cosine : {0.02f, 0.3f, 1.0f}) {
      const float phi = static_cast<float>(k);
      const float s = std::sqrt(1 - cosine * cosine);
      for (const float side : {1.0f, -1.0f}) {
        const Vec3f d = f.to_world({s * std::cos(phi), s * std::sin(phi), side * cosine});
        ++tried;
        if (w.intersect(ray(World::offset_origin(at.point.position, at.point.ng, d), d))) ++met;
      }
    }
  }
  EXPECT_GT(tried, 5000);
  EXPECT_EQ(met, 0);
}

}  // namespace
}  // namespace lumirank::world
