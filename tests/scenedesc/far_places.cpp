// What a text says of a place far from the origin is kept beyond 32 bits.
#include <gtest/gtest.h>

#include "base/near_origin.h"
#include "scenedesc/gltf_maker.h"
#include "scenedesc/pbrt_scene.h"
#include "scenedesc/readers.h"

namespace lumirank::scenedesc {
namespace {

// A triangle a few units wide, 10⁶ away: 32 bits would hold its places to 0.03.
const double kPlaces[3][3] = {
    {1e6 + 0.123, -2e6 + 0.25, 3e6}, {1e6 + 1.7, -2e6, 3e6}, {1e6, -2e6 + 1.9, 3e6 + 0.01}};

std::string number(double x) {
  char text[40];
  std::snprintf(text, sizeof text, "%.17g", x);
  return text;
}
std::string lines(const char* before, const char* after) {
  std::string out;
  for (const auto& p : kPlaces)
    out += before + number(p[0]) + " " + number(p[1]) + " " + number(p[2]) + after;
  return out;
}

void expect_places(const MeshData& mesh) {
  ASSERT_EQ(mesh.positions.size(), 3u);
  for (std::size_t k = 0; k < 3; ++k)
    for (int i = 0; i < 3; ++i)
      // Relative to the origin 32 bits hold 2 units to 2⁻²⁴; the file's 64 hold 3·10⁶ to 2⁻³¹.
      EXPECT_NEAR(mesh.origin[i] + mesh.positions[k][i], kPlaces[k][i], 0x1p-23 + 0x1p-30);
}

TEST(FarPlaces, OfTextMeshesAreKept) {
  expect_places(parse_obj(lines("v ", "\n") + "f 1 2 3\n", "far.obj"));
  expect_places(
      parse_ply("ply\nformat ascii 1.0\nelement vertex 3\nproperty double x\nproperty double y\n"
                "property double z\nelement face 1\nproperty list uchar int vertex_indices\n"
                "end_header\n" +
                    lines("", "\n") + "3 0 1 2\n",
                "far.ply"));
  std::string binary =
      "ply\nformat binary_little_endian 1.0\nelement vertex 3\nproperty double x\nproperty double y\n"
      "property double z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n";
  binary.append(reinterpret_cast<const char*>(kPlaces), sizeof kPlaces);
  binary += '\3';
  const std::int32_t corners[3] = {0, 1, 2};
  binary.append(reinterpret_cast<const char*>(corners), sizeof corners);
  expect_places(parse_ply(binary, "far.ply"));
}

TEST(FarPlaces, NearMeshesHaveNoOriginOfTheirOwn) {
  const MeshData mesh = parse_obj("v 10.1 0 0\nv 11 0 0\nv 10 1 0\nf 1 2 3\n", "near.obj");
  EXPECT_EQ(mesh.origin, Vec3d{});
  EXPECT_EQ(mesh.positions[0].x, 10.1f);
}

TEST(FarPlaces, OriginsAreRoundAndOnlyAlongFarAxes) {
  Bounds3d box;
  box.extend({99999, -1, 6}), box.extend({100002, 1, 9});
  EXPECT_EQ(near_origin(box, 64), Vec3d(100000, 0, 0));
  EXPECT_EQ(near_origin(Bounds3d{}, 64), Vec3d{});
}

TEST(FarPlaces, OfCamerasAreKept) {
  const Transform t = Transform::look_at({1e7 + 0.125, 2, 3}, {1e7 + 0.125, 2, 4.5}, {0, 1, 0});
  EXPECT_EQ(t.origin(), Vec3d(1e7 + 0.125, 2, 3));
  EXPECT_EQ(t.axis(2), Vec3d(0, 0, 1));
}

}  // namespace
}  // namespace lumirank::scenedesc
