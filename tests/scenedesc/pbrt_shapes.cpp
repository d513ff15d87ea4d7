// Shapes of pbrt scenes.
#include <cmath>
#include <fstream>

#include "scenedesc/pbrt_scene.h"

namespace lumirank::scenedesc {
namespace {

const MeshData& mesh(const SceneDesc& scene, std::size_t index = 0) {
  return *shape<InlineMeshDesc>(scene, index).mesh;
}

double area(const MeshData& m) {
  double sum = 0;
  for (std::size_t t = 0; t < m.indices.size(); t += 3) {
    const Vec3f a = m.positions[m.indices[t]];
    sum += 0.5 * length(cross(m.positions[m.indices[t + 1]] - a, m.positions[m.indices[t + 2]] - a));
  }
  return sum;
}

// Corners run counter-clockwise around the normals.
void expect_consistent(const MeshData& m) {
  for (std::size_t t = 0; t < m.indices.size(); t += 3) {
    const Vec3f a = m.positions[m.indices[t]];
    const Vec3f n = cross(m.positions[m.indices[t + 1]] - a, m.positions[m.indices[t + 2]] - a);
    for (int k = 0; k < 3; ++k)
      EXPECT_GT(dot(n, m.normals[m.indices[t + static_cast<std::size_t>(k)]]), 0) << t;
  }
}

TEST(PbrtShape, TriangleMesh) {
  const SceneDesc scene = pbrt_world(
      "Shape \"trianglemesh\" \"point3 P\" [ 0 0 0  1 0 0  0 1 0  1 1 0 ] \"integer indices\" [ 0 1 2  2 1 3 "
      "]\n"
      "\"normal N\" [ 0 0 1  0 0 1  0 0 1  0 0 1 ] \"point2 uv\" [ 0 0  1 0  0 1  1 1 ] \"vector3 S\" [ 1 0 "
      "0  1 0 0  1 0 0  1 0 0 ]\n");
  EXPECT_TRUE(scene.warnings.empty());
  EXPECT_EQ(mesh(scene).indices, (std::vector<std::uint32_t>{0, 1, 2, 2, 1, 3}));
  EXPECT_EQ(mesh(scene).uvs[3], (Vec2f{1, 1}));
  EXPECT_EQ(mesh(scene).normals.size(), 4u);
  // Without normals flat, and of one triangle the indices go without saying.
  EXPECT_TRUE(
      mesh(pbrt_world("Shape \"trianglemesh\" \"point3 P\" [ 0 0 0  1 0 0  0 1 0 ]\n")).normals.empty());
}

// The world leaves them out, with a warning, and counts them.
TEST(PbrtShape, MeshesWithoutAreaHaveNoTriangle) {
  const SceneDesc scene = pbrt_world("Shape \"trianglemesh\" \"point3 P\" [ 0 0 0  1 0 0  2 0 0 ]\n");
  EXPECT_TRUE(mesh(scene).indices.empty());
  EXPECT_EQ(mesh(scene).left_out, std::vector<std::string>{"1 degenerate triangle"});
}

TEST(PbrtShape, PlyMeshesKeepTheirUvAndAreFlatWithoutNormals) {
  std::ofstream(testing::TempDir() + "one.ply")
      << "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float "
         "z\nproperty float u\n"
         "property float v\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0 0 "
         "0.25\n1 0 0 1 0\n0 1 0 0 1\n3 0 1 2\n";
  const SceneDesc scene = pbrt_world("Shape \"plymesh\" \"string filename\" \"one.ply\"\n");
  const MeshData read = read_mesh(shape<MeshFileDesc>(scene));
  EXPECT_TRUE(read.normals.empty());
  EXPECT_EQ(read.uvs.at(0), (Vec2f{0, 0.25f}));
}

// As pbrt parametrizes it: u = φ/2π, v from the south pole up. The built-in sphere's v runs from +z down, so
// it is turned over.
TEST(PbrtShape, SphereHasPbrtsV) {
  const SceneDesc scene = pbrt_world("Shape \"sphere\" \"float radius\" 2\n");
  EXPECT_EQ(shape<SphereDesc>(scene).radius, 2);
  EXPECT_EQ(scene.shapes[0].to_world.point({1, 2, 3}), (Vec3f{1, 2, -3}));
}

TEST(PbrtShape, PartsOfQuadrics) {
  // Half of the zone between z = -½ and ½ of a sphere of radius 1: π · 1 = 2πr·h / 2.
  const SceneDesc sphere =
      pbrt_world("Shape \"sphere\" \"float zmin\" -0.5 \"float zmax\" 0.5 \"float phimax\" 180\n");
  EXPECT_NEAR(area(mesh(sphere)) / M_PI, 1, 1e-3);
  expect_consistent(mesh(sphere));
  EXPECT_EQ(mesh(sphere).positions[0].y, 0);  // φ = 0, v = 0
  EXPECT_NEAR(mesh(sphere).positions[0].z, -0.5f, 1e-6f);
  const SceneDesc tube =
      pbrt_world("Shape \"cylinder\" \"float radius\" 2 \"float zmin\" 1 \"float zmax\" 4\n");
  EXPECT_NEAR(area(mesh(tube)) / (2 * M_PI * 2 * 3), 1, 1e-3);
  expect_consistent(mesh(tube));
  const SceneDesc ring =
      pbrt_world("Shape \"disk\" \"float radius\" 2 \"float innerradius\" 1 \"float height\" 5\n");
  EXPECT_NEAR(area(mesh(ring)) / (3 * M_PI), 1, 1e-3);
  expect_consistent(mesh(ring));
  EXPECT_EQ(mesh(ring).positions[0], (Vec3f{2, 0, 5}));
  EXPECT_EQ(mesh(ring).uvs[0], (Vec2f{0, 0}));
  const SceneDesc disk = pbrt_world("Shape \"disk\"\n");
  EXPECT_NEAR(area(mesh(disk)) / M_PI, 1, 1e-3);
  EXPECT_TRUE(disk.warnings.empty());
}

TEST(PbrtShape, BilinearPatches) {
  // A parallelogram is two triangles, in pbrt's order (0,0), (1,0), (0,1), (1,1), facing ∂u × ∂v = +z.
  const SceneDesc flat = pbrt_world("Shape \"bilinearmesh\" \"point3 P\" [ 0 0 0  2 0 0  0 1 0  2 1 0 ]\n");
  EXPECT_EQ(mesh(flat).triangle_count(), 2u);
  EXPECT_NEAR(area(mesh(flat)), 2, 1e-6);
  EXPECT_EQ(mesh(flat).normals[0], (Vec3f{0, 0, 1}));
  expect_consistent(mesh(flat));
  // z = xy over the unit square: ∫∫ √(1 + x² + y²) = 1.28079 (Simpson with 200² cells).
  const SceneDesc saddle = pbrt_world(
      "Shape \"bilinearmesh\" \"point3 P\" [ 0 0 0  1 0 0  0 1 0  1 1 1 ] \"integer indices\" [ 0 1 2 3 ]\n");
  EXPECT_NEAR(area(mesh(saddle)), 1.28079, 1e-3);
  expect_consistent(mesh(saddle));
  for (const Vec3f& p : mesh(saddle).positions) EXPECT_NEAR(p.z, p.x * p.y, 1e-6f);
}

TEST(PbrtShape, CurvesOfTheSameLooksAreOneShape) {
  const std::string one =
      "Shape \"curve\" \"string type\" \"cylinder\" \"string basis\" \"bspline\" \"float width0\" 4 \"float "
      "width1\" 2 "
      "\"point3 P\" [ 0 0 0  1 0 0  2 0 0  3 0 0  4 0 0 ]\n";
  const SceneDesc scene = pbrt_world(one + one + "Material \"conductor\"\n" + one);
  ASSERT_EQ(scene.shapes.size(), 2u);
  const auto& curves = shape<CurvesDesc>(scene);
  EXPECT_EQ(curves.basis, CurvesDesc::Basis::bspline);
  EXPECT_EQ(curves.first, (std::vector<std::uint32_t>{0, 5, 10}));
  EXPECT_EQ(curves.points[9], (Vec3f{4, 0, 0}));
  // The radius falls linearly from 2 to 1 along the two pieces, which begin at the second point and end at
  // the last but one; b-splines reproduce lines.
  const float want[] = {2.5f, 2, 1.5f, 1, 0.5f};
  for (std::size_t i = 0; i < 5; ++i) EXPECT_FLOAT_EQ(curves.radii[i], want[i]);
}

TEST(PbrtShape, BezierCurves) {
  const SceneDesc scene = pbrt_world(
      "Shape \"curve\" \"string type\" \"cylinder\" \"float width0\" 2 \"float width1\" 8 \"point3 P\" [ 0 0 "
      "0  1 0 0  2 0 0  3 0 0 ]\n");
  EXPECT_EQ(shape<CurvesDesc>(scene).basis, CurvesDesc::Basis::bezier);
  EXPECT_EQ(shape<CurvesDesc>(scene).radii, (std::vector<float>{1, 2, 3, 4}));
  // A quadratic piece raised to a cubic one: ⅓ of the way from the ends, ⅔ towards the middle point.
  const SceneDesc two = pbrt_world(
      "Shape \"curve\" \"string type\" \"cylinder\" \"integer degree\" 2 \"point3 P\" [ 0 0 0  3 3 0  6 0 0 "
      "]\n");
  const auto& raised = shape<CurvesDesc>(two).points;
  ASSERT_EQ(raised.size(), 4u);
  EXPECT_NEAR(length(raised[1] - Vec3f{2, 2, 0}), 0, 1e-6f);
  EXPECT_NEAR(length(raised[2] - Vec3f{4, 2, 0}), 0, 1e-6f);
}

// pbrt's default is a flat ribbon that faces the ray, which hair is here; other materials see a round thread.
TEST(PbrtShape, FlatCurvesOfHairAreAsTheyAre) {
  const std::string curve = "Shape \"curve\" \"point3 P\" [ 0 0 0  1 0 0  2 0 0  3 0 0 ]\n";
  EXPECT_TRUE(pbrt_world("Material \"hair\"\n" + curve).warnings.empty());
  EXPECT_NE(only_warning(pbrt_world(curve)).what.find("flat"), std::string::npos);
  EXPECT_NE(only_warning(pbrt_world("Material \"diffuse\"\n" + curve)).what.find("flat"), std::string::npos);
}

}  // namespace
}  // namespace lumirank::scenedesc
