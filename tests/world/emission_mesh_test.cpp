// Meshes that shine by a texture: no light is lost between the points of a mean, and places are drawn where
// it is.
#include "world/emission_mesh.h"

#include <gtest/gtest.h>

#include <set>
#include <tuple>

#include "base/random.h"
#include "emitters/area.h"
#include "geometry/tessellate.h"
#include "world/lights.h"
#include "world/surface.h"

namespace lumirank::world {
namespace {

constexpr int kTexels = 256;

// Black but for a square of `side` texels, whose lower left corner is so far from the picture's.
scatter::TextureSet spot(int from_left, int from_bottom, int side) {
  auto pixels = std::make_shared<scatter::TexturePixels>();
  pixels->width = pixels->height = kTexels;
  pixels->rgb.assign(kTexels * kTexels, Rgb(0));
  for (int y = from_bottom; y < from_bottom + side; ++y)
    for (int x = from_left; x < from_left + side; ++x)
      pixels->rgb[static_cast<std::size_t>((kTexels - 1 - y) * kTexels + x)] = Rgb(100);
  scatter::TextureSet set;
  set.textures.emplace_back(scatter::BitmapTexture{.pixels = std::move(pixels)});
  return set;
}

double power_of(const emitters::AreaEmitter& emitter) {
  double sum = 0;
  for (const auto& t : emitter.triangles) sum += static_cast<double>(t.area * luminance(t.mean_radiance));
  return sum;
}

TEST(EmissionMesh, ASmallBrightSpotOfAPictureIsNotLost) {
  const scatter::TextureSet textures = spot(37, 150, 6);
  const double truth = 4 * 100.0 * 6 * 6 / (kTexels * kTexels);  // of a rectangle of 2 × 2
  const geometry::TriangleMesh whole = geometry::make_rectangle();
  const geometry::TriangleMesh mesh = divided_by_texture(whole, 0, textures, 1 << 15);
  ASSERT_GT(mesh.triangle_count(), 1000u);
  EXPECT_NEAR(power_of(make_area_emitter(mesh, 0, {{}, 0}, textures)) / truth, 1, 0.05);
  // Undivided it is known roughly, but known.
  EXPECT_NEAR(power_of(make_area_emitter(whole, 0, {{}, 0}, textures)) / truth, 1, 0.5);
}

TEST(EmissionMesh, PlacesAreDrawnWhereThePictureShines) {
  const scatter::TextureSet textures = spot(37, 150, 6);
  const geometry::TriangleMesh mesh = divided_by_texture(geometry::make_rectangle(), 0, textures, 1 << 15);
  const emitters::AreaEmitter emitter = make_area_emitter(mesh, 0, {{}, 0}, textures);
  int lit = 0;
  double light = 0;
  constexpr int kDraws = 4000;
  for (std::uint64_t k = 0; k < kDraws; ++k) {
    Rng rng(1, Stage::test, k);
    const float u = rng.next_float();
    const auto point = emitters::sample_area(emitter, u, rng.next_2d());
    ASSERT_GT(point.pdf, 0);
    const Rgb radiance = textures.lookup(0, interpolate_uv(mesh, point.triangle, point.barycentric));
    lit += !is_black(radiance);
    light += static_cast<double>(luminance(radiance) / point.pdf) / kDraws;
  }
  EXPECT_GT(lit, kDraws / 4) << "evenly it would be one in 1,800";
  EXPECT_NEAR(light / (4 * 100.0 * 6 * 6 / (kTexels * kTexels)), 1, 0.05);
}

TEST(EmissionMesh, DivisionKeepsTheSurfaceAndSharesEdges) {
  // Two triangles that meet in an edge whose corners each has for itself, in different orders.
  geometry::TriangleMesh mesh;
  const Vec3f a{0.1f, 0.7f, 0.3f}, b{1.3f, 0.2f, 0.9f}, c{0.4f, 1.9f, 0.2f}, d{1.7f, 1.6f, 0.5f};
  mesh.positions = {a, b, c, c, b, d};
  mesh.normals.assign(6, Vec3f{0, 0, 1});
  mesh.uvs = {{0, 0}, {1, 0}, {0, 1}, {0, 1}, {1, 0}, {1, 1}};
  mesh.indices = {0, 1, 2, 5, 3, 4};
  const geometry::TriangleMesh parts = divided_by_texture(mesh, 0, spot(10, 10, 3), 2 * 12 * 12);
  ASSERT_EQ(parts.triangle_count(), 2u * 12 * 12);
  double area = 0, area_of_parts = 0;
  for (std::size_t t = 0; t < 2; ++t) area += static_cast<double>(length(mesh.area_vector(t)));
  std::set<std::tuple<float, float, float>> places;
  for (std::size_t t = 0; t < parts.triangle_count(); ++t) {
    area_of_parts += static_cast<double>(length(parts.area_vector(t)));
    // Each part faces where its triangle does.
    EXPECT_GT(dot(parts.area_vector(t), mesh.area_vector(t < 144 ? 0 : 1)), 0) << t;
  }
  EXPECT_NEAR(area_of_parts, area, 1e-5);
  for (const Vec3f& p : parts.positions) places.emplace(p.x, p.y, p.z);
  EXPECT_EQ(places.size(), 2u * (13 * 14 / 2) - 13) << "13 places lie on the common edge";
  for (std::size_t k = 0; k < parts.positions.size(); ++k)
    EXPECT_NEAR(length(parts.normals[k] - Vec3f{0, 0, 1}), 0, 1e-6);
}

TEST(EmissionMesh, EvenPicturesAndMeshesWithoutUvsStayAsTheyAre) {
  scatter::TextureSet even = spot(0, 0, kTexels);
  EXPECT_EQ(divided_by_texture(geometry::make_rectangle(), 0, even, 1 << 15).triangle_count(), 2u);
  geometry::TriangleMesh bare = geometry::make_rectangle();
  bare.uvs.clear();
  EXPECT_EQ(divided_by_texture(bare, 0, spot(10, 10, 3), 1 << 15).triangle_count(), 2u);
}

}  // namespace
}  // namespace lumirank::world
