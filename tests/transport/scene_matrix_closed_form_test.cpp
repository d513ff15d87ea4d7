// Entries whose values are known on paper.
#include <gtest/gtest.h>

#include "matrix_fixture.h"

namespace lumirank::transport::testing {
namespace {

SceneMatrixSettings unclamped() {
  SceneMatrixSettings settings;
  settings.clamp = 0;
  return settings;
}

Rgb entry(const SceneMatrix& matrix, matrix::Index i, matrix::Index j) {
  Rgb out;
  matrix.entries(std::span(&i, 1), std::span(&j, 1), std::span(&out, 1), matrix::Part::value);
  return out;
}

// A plane z = 0 seen from above, of albedo 0.5; the light is at height 2 above the origin.
struct Plane {
  world::World world = build_world(empty_space());
  Receivers receivers;
  VirtualLights lights;
  explicit Plane(std::initializer_list<float> xs) {
    for (const float x : xs) add_receiver(receivers, {x, 0, 0}, {0, 0, 1}, {0, 0, 1}, Rgb(0.5f));
  }
};

TEST(SceneMatrixClosedForm, PointLightOverAPlane) {
  Plane plane{0.0f, 1.0f, 3.0f};
  add_light(plane.lights, LightKind::omni, {0, 0, 2}, {}, Rgb(3, 6, 9));
  const SceneMatrix matrix(plane.world, plane.receivers, plane.lights, unclamped());
  for (matrix::Index i = 0; i < 3; ++i) {
    const float x = plane.receivers.position[i].x;
    // I·cosθ/d²·ρ/π with cosθ = h/d.
    const float d = std::sqrt(4 + x * x), expected = 3 * 2 / (d * d * d) * 0.5f / kPi;
    EXPECT_NEAR(entry(matrix, i, 0).r, expected, 1e-6f * expected);
    EXPECT_NEAR(entry(matrix, i, 0).b, 3 * expected, 3e-6f * expected);
  }
}

TEST(SceneMatrixClosedForm, AreaSampleOverAPlane) {
  Plane plane{0.0f, 1.0f, 3.0f};
  add_light(plane.lights, LightKind::oriented, {0, 0, 2}, {0, 0, -1}, Rgb(5));  // Le·area = 5
  add_light(plane.lights, LightKind::oriented, {0, 0, 2}, {0, 0, 1}, Rgb(5));   // looks away
  const SceneMatrix matrix(plane.world, plane.receivers, plane.lights, unclamped());
  for (matrix::Index i = 0; i < 3; ++i) {
    const float x = plane.receivers.position[i].x;
    const float d2 = 4 + x * x, expected = 5 * (4 / d2) / d2 * 0.5f / kPi;  // both cosines are h/d
    EXPECT_NEAR(entry(matrix, i, 0).g, expected, 1e-6f * expected);
    EXPECT_EQ(entry(matrix, i, 1), Rgb(0));
  }
}

TEST(SceneMatrixClosedForm, SurfaceLightScattersItsFlux) {
  Plane plane{1.0f};
  add_light(plane.lights, LightKind::surface, {0, 0, 2}, {0, 0, -1}, Rgb(5));  // Φ = 5
  plane.lights.albedo.back() = Rgb(0.25f, 0.5f, 1);
  const SceneMatrix matrix(plane.world, plane.receivers, plane.lights, unclamped());
  const float d2 = 5, expected = 5 / kPi * (4 / d2) / d2 * 0.5f / kPi;
  EXPECT_NEAR(entry(matrix, 0, 0).r, 0.25f * expected, 1e-6f * expected);
  EXPECT_NEAR(entry(matrix, 0, 0).b, expected, 1e-6f * expected);
}

// Within its reach a light gives nothing, whatever is asked for; beyond it what it gives without one.
TEST(SceneMatrixClosedForm, NothingComesFromWithinALightsReach) {
  Plane plane{0.0f, 1.0f, 3.0f};
  for (const bool shining : {false, true}) {
    add_light(plane.lights, LightKind::surface, {0, 0, 2}, {0, 0, -1}, Rgb(5));
    if (shining) {
      scatter::Closure glossy = plane.lights.closure_at(0);
      glossy.lobes[0].kind = scatter::LobeKind::ward;
      glossy.lobes[0].alpha_u = glossy.lobes[0].alpha_v = 0.4f;
      plane.lights.closure.back() = plane.lights.closures.add(glossy, {0, 0, -1});
    }
  }
  const SceneMatrix whole(plane.world, plane.receivers, plane.lights, unclamped());
  plane.lights.reach = {2.1f, 2.1f};  // the first receiver is at 2, the second at √5
  const SceneMatrix without(plane.world, plane.receivers, plane.lights, unclamped());
  for (matrix::Index j = 0; j < 2; ++j) {
    EXPECT_EQ(entry(without, 0, j), Rgb(0)) << j;
    for (matrix::Index i = 1; i < 3; ++i) {
      EXPECT_GT(entry(whole, i, j).g, 0) << i << ' ' << j;
      EXPECT_EQ(entry(without, i, j), entry(whole, i, j)) << i << ' ' << j;
    }
  }
}

TEST(SceneMatrixClosedForm, DirectionalLight) {
  Plane plane{0.0f};
  const float angle = 0.6f;
  add_light(plane.lights, LightKind::directional, {}, {std::sin(angle), 0, -std::cos(angle)}, Rgb(7));
  add_light(plane.lights, LightKind::directional, {}, {0, 0, 1}, Rgb(7));  // from below
  const SceneMatrix matrix(plane.world, plane.receivers, plane.lights, unclamped());
  const float expected = 7 * std::cos(angle) * 0.5f / kPi;
  EXPECT_NEAR(entry(matrix, 0, 0).r, expected, 1e-6f * expected);
  EXPECT_EQ(entry(matrix, 0, 1), Rgb(0));
}

TEST(SceneMatrixClosedForm, SpotFallsOffLinearlyInTheAngle) {
  Plane plane{0.0f, 1.0f, 3.0f};
  const float beam = 0.2f, cutoff = 0.8f;
  add_light(plane.lights, LightKind::spot, {0, 0, 2}, {0, 0, -1}, Rgb(3));
  plane.lights.closure.back() = 0;
  plane.lights.spots.push_back({std::cos(cutoff), std::cos(beam), cutoff, beam, nullptr, {}});
  const SceneMatrix matrix(plane.world, plane.receivers, plane.lights, unclamped());
  EXPECT_NEAR(entry(matrix, 0, 0).r, 3 / 4.0f * 0.5f / kPi, 1e-7f);
  const float angle = std::atan2(1.0f, 2.0f), d = std::sqrt(5.0f);
  const float expected = 3 * (cutoff - angle) / (cutoff - beam) * 2 / (d * d * d) * 0.5f / kPi;
  EXPECT_NEAR(entry(matrix, 1, 0).r, expected, 2e-6f * expected);
  EXPECT_EQ(entry(matrix, 2, 0), Rgb(0));  // atan(3/2) = 0.98 is beyond the cutoff
}

// 4 W/sr straight down, 1 W/sr at 90°, linear in the angle between.
TEST(SceneMatrixClosedForm, AnAngularTableIsLookedUpForEachReceiver) {
  Plane plane{0.0f, 1.0f, 3.0f};
  add_light(plane.lights, LightKind::spot, {0, 0, 2}, {0, 0, -1}, Rgb(1, 2, 3));
  plane.lights.closure.back() = 0;
  SpotShape shape;
  shape.cos_cutoff = -2;
  shape.profile = std::make_shared<emitters::AngularProfile>(
      std::vector<float>{0, kPi / 2}, std::vector<float>{0, 2 * kPi}, std::vector<float>{4, 4, 1, 1});
  shape.frame = Frame::from_normal({0, 0, -1});
  plane.lights.spots.push_back(shape);
  const SceneMatrix matrix(plane.world, plane.receivers, plane.lights, unclamped());
  for (matrix::Index i = 0; i < 3; ++i) {
    const float x = plane.receivers.position[i].x, d = std::sqrt(4 + x * x);
    const float intensity = 4 - 3 * std::atan2(x, 2.0f) / (kPi / 2);
    const float expected = intensity * 2 / (d * d * d) * 0.5f / kPi;
    EXPECT_NEAR(entry(matrix, i, 0).r, expected, 2e-6f * expected);
    EXPECT_NEAR(entry(matrix, i, 0).b, 3 * expected, 6e-6f * expected);
  }
}

// Square light of side 2a at height c above the receiver: the form factor from a differential element to a
// parallel rectangle with a corner above it is (X/√(1+X²)·atan(Y/√(1+X²)) + Y/√(1+Y²)·atan(X/√(1+Y²)))/(2π),
// X = Y = a/c; here four of them. Reflected radiance: ρ·L·F. The midpoint rule's error falls with the square
// of the spacing.
TEST(SceneMatrixClosedForm, ManySamplesOfASquareLightConvergeToItsFormFactor) {
  const float a = 1, c = 0.8f, radiance = 2, albedo = 0.5f;
  const double x = a / c, s = std::sqrt(1 + x * x);
  const double form_factor = 4 * (2 * x / s * std::atan(x / s)) / (2 * 3.14159265358979324);
  const double exact = albedo * radiance * form_factor;
  double error[2];
  for (int level = 0; level < 2; ++level) {
    const int n = 16 << level;
    Plane plane{0.0f};
    const float cell = 2 * a / static_cast<float>(n);
    for (int u = 0; u < n; ++u)
      for (int v = 0; v < n; ++v)
        add_light(plane.lights, LightKind::oriented,
                  {-a + cell * (static_cast<float>(u) + 0.5f), -a + cell * (static_cast<float>(v) + 0.5f), c},
                  {0, 0, -1}, Rgb(radiance * cell * cell));
    const SceneMatrix matrix(plane.world, plane.receivers, plane.lights, unclamped());
    std::vector<Rgb> row(matrix.columns());
    matrix.row(0, row, matrix::Part::value);
    double sum = 0;
    for (const Rgb& e : row) sum += e.r;
    error[level] = std::abs(sum - exact) / exact;
  }
  EXPECT_LT(error[0], 5e-3);
  EXPECT_NEAR(error[0] / error[1], 4, 0.5);
}

TEST(SceneMatrixClosedForm, DepthsBeyondTheLimitAreZero) {
  Plane plane{0.0f, 0.0f};
  plane.receivers.depth[1] = 2;
  add_light(plane.lights, LightKind::omni, {0, 0, 2}, {}, Rgb(1));
  add_light(plane.lights, LightKind::surface, {0, 0, 2}, {0, 0, -1}, Rgb(1));
  // Path lengths: receiver + light + the segment between: 2, 3 and 3, 4.
  for (int max_depth = -1; max_depth <= 5; ++max_depth) {
    SceneMatrixSettings settings = unclamped();
    settings.max_depth = max_depth;
    const SceneMatrix matrix(plane.world, plane.receivers, plane.lights, settings);
    for (matrix::Index i = 0; i < 2; ++i)
      for (matrix::Index j = 0; j < 2; ++j) {
        const int length = plane.receivers.depth[i] + plane.lights.depth[j] + 1;
        EXPECT_EQ(entry(matrix, i, j).r > 0, max_depth < 0 || length <= max_depth) << max_depth << i << j;
      }
  }
}

TEST(SceneMatrixClosedForm, GlossyReceiversLeaveDirectLightToTracing) {
  scenedesc::SceneDesc desc = empty_space();
  scenedesc::ConductorDesc metal;
  metal.alpha_u.value = metal.alpha_v.value = 0.1f;
  add_shape(desc, scenedesc::RectangleDesc{}, Transform::translate(1010, 1000, 1000), add_bsdf(desc, metal));
  const world::World world = build_world(desc);
  Plane plane{0.0f, 0.0f};
  scatter::SurfacePoint at;
  at.ng = at.shading.n = {0, 0, 1};
  set_closure(plane.receivers, world.materials().closure(worn_materials(world).back(), at, {0, 0, 1}));
  add_light(plane.lights, LightKind::omni, {0, 0, 2}, {}, Rgb(1));
  add_light(plane.lights, LightKind::surface, {0, 0, 2}, {0, 0, -1}, Rgb(1));
  SceneMatrixSettings settings = unclamped();
  for (const float threshold : {0.05f, 0.2f}) {
    settings.traced_direct_below = threshold;
    const SceneMatrix matrix(world, plane.receivers, plane.lights, settings);
    EXPECT_GT(entry(matrix, 0, 0).r, 0);
    EXPECT_EQ(entry(matrix, 1, 0).r > 0, threshold < 0.1f);
    EXPECT_GT(entry(matrix, 1, 1).r, 0);
  }
}

// A pane of thin glass at normal incidence lets 1 - 2R/(1+R) through, R = ((n-1)/(n+1))², in E; a wall V = 0.
TEST(SceneMatrixClosedForm, ThinGlassAttenuatesEAndWallsBlockV) {
  scenedesc::SceneDesc desc;
  scenedesc::ThinDielectricDesc glass;
  glass.eta = 1.5f;
  add_shape(desc, scenedesc::RectangleDesc{}, Transform::translate(0, 0, 1), add_bsdf(desc, glass));
  add_shape(desc, scenedesc::RectangleDesc{}, Transform::translate(10, 0, 1));
  const world::World world = build_world(desc);
  Plane plane{0.0f, 10.0f};
  add_light(plane.lights, LightKind::omni, {0, 0, 2}, {}, Rgb(1));
  add_light(plane.lights, LightKind::omni, {10, 0, 2}, {}, Rgb(1));
  const SceneMatrix matrix(world, plane.receivers, plane.lights, unclamped());
  const float bare = 1 / 4.0f * 0.5f / kPi, r = 0.04f;
  EXPECT_NEAR(entry(matrix, 0, 0).r, bare * (1 - 2 * r / (1 + r)), 1e-5f * bare);
  EXPECT_EQ(entry(matrix, 1, 1), Rgb(0));
  std::vector<Rgb> part(4);
  const std::vector<matrix::Index> both{0, 1};
  matrix.block(both, both, part, matrix::Part::unoccluded);
  EXPECT_NEAR(part[0].r, bare * (1 - 2 * r / (1 + r)), 1e-5f * bare);
  EXPECT_NEAR(part[3].r, bare, 1e-5f * bare);
  matrix.block(both, both, part, matrix::Part::visibility);
  EXPECT_EQ(part[0], Rgb(1));
  EXPECT_EQ(part[3], Rgb(0));
}

}  // namespace
}  // namespace lumirank::transport::testing
