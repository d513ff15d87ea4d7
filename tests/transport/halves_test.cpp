// The two halves of the lights are independent estimates of the same.
#include "transport/lights/halves.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "support/scenes.h"
#include "support/statistics.h"
#include "transport/cpu/scene_matrix.h"
#include "transport/false_alarms.h"
#include "transport/lights/virtual_lights.h"
#include "transport/rows/receivers.h"

namespace lumirank::transport {
namespace {

using test::SceneMaker;

// A box with a lamp under its ceiling and a lit sphere in it.
SceneMaker lit_box() {
  SceneMaker scene;
  scene.box_inside(1, scene.diffuse(Rgb(0.6f)));
  scene.lamp({0.2f, 0, 0.9f}, {0, 0.4f, 0}, {0.3f, 0, 0}, {5, 4, 3}, scene.diffuse(Rgb(0)));
  scene.shape(scenedesc::SphereDesc{{-0.3f, 0.2f, -0.5f}, 0.3f}, {}, scene.diffuse(Rgb(0.8f)));
  return scene;
}

struct Sums {
  std::array<double, 3> half{};  // by matrix::ColumnFeatures::half
};

// What some receivers get, red, per half.
Sums received(const world::World& world, const Receivers& receivers, const LightSettings& settings,
              bool indirect) {
  LightSettings s = settings;
  s.direct = !indirect, s.indirect = indirect;
  const VirtualLights lights = trace_virtual_lights(world, s);
  const SceneMatrix matrix(world, receivers, lights, {});
  EXPECT_EQ(matrix.column_features().half.size(), matrix.columns());
  Sums sums;
  std::vector<Rgb> row(matrix.columns());
  for (std::size_t i = 0; i < matrix.rows(); i += 16) {
    matrix.row(static_cast<matrix::Index>(i), row, matrix::Part::value);
    for (std::size_t j = 0; j < row.size(); ++j) sums.half[lights.half[j]] += row[j].r;
  }
  return sums;
}

// Var(A − B) = Var(A + B) exactly if A and B are uncorrelated, and E A = E B. Halves of one evenly spread set
// would be anticorrelated: Var(A + B) is then many times smaller (see the direct light of the lamp).
void expect_independent(bool indirect) {
  const auto world = lit_box().build();
  const world::Camera camera(test::sensor({-0.9f, -0.9f, 0.2f}, {0.5f, 0.5f, -0.6f}, {0, 0, 1}, 60, 8, 8));
  ReceiverSettings one;
  one.spp = 1;
  const auto receivers = trace_receivers(world, camera, one);
  constexpr std::size_t kSeeds = 300;
  std::vector<double> a, b, difference;
  for (std::size_t seed = 0; seed < kSeeds; ++seed) {
    LightSettings settings;
    settings.seed = seed, settings.count = 60;
    settings.receivers =
        seed % 10 == 0 ? &receivers : nullptr;  // the guide is slow, and shared by the halves
    const Sums sums = received(world, receivers, settings, indirect);
    EXPECT_EQ(sums.half[0], 0);  // neither the lamp's samples nor particles are exact
    a.push_back(sums.half[1]), b.push_back(sums.half[2]);
    difference.push_back(a.back() - b.back());
  }
  const auto ma = test::mean_of(a), mb = test::mean_of(b), d = test::mean_of(difference);
  EXPECT_NEAR(d.mean, 0, test::student_quantile(kAlpha, 2, kSeeds - 1) * d.standard_error);
  double covariance = 0;
  for (std::size_t k = 0; k < kSeeds; ++k) covariance += (a[k] - ma.mean) * (b[k] - mb.mean);
  const double n = static_cast<double>(kSeeds);
  const double r = covariance / (n * (n - 1) * ma.standard_error * mb.standard_error);
  const double t = r * std::sqrt((n - 2) / (1 - r * r));
  EXPECT_LT(std::abs(t), test::student_quantile(kAlpha, 2, kSeeds - 2)) << "correlation " << r;
}

TEST(Halves, OfEmitterSamplesAreIndependent) { expect_independent(false); }
TEST(Halves, OfParticlesAreIndependent) { expect_independent(true); }

TEST(Halves, ExactLightsHaveNone) {
  SceneMaker scene = lit_box();
  scene.point_light({0, 0, 0.5f}, Rgb(1));
  scenedesc::DirectionalLightDesc sun;
  sun.direction = {0, 0, -1}, sun.irradiance = Rgb(2);
  scene.light(sun);
  LightSettings settings;
  settings.count = 200;
  const auto lights = trace_virtual_lights(scene.build(), settings);
  ASSERT_EQ(lights.half.size(), lights.size());
  std::array<std::size_t, 3> oriented{};
  for (std::size_t j = 0; j < lights.size(); ++j) {
    const bool exact = lights.kind[j] == LightKind::omni || lights.kind[j] == LightKind::directional;
    EXPECT_EQ(lights.half[j] == kNoHalf, exact);
    if (lights.kind[j] == LightKind::oriented) ++oriented[lights.half[j]];
  }
  EXPECT_EQ(lights.paths % 2, 0u);
  EXPECT_EQ(oriented[1], oriented[2]);
}

// More lamps than lights: which lamps stand for all is a sample as well.
TEST(Halves, SomeOfManyLampsAreSamples) {
  SceneMaker scene;
  scene.rectangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, scene.diffuse(Rgb(0.5f)));
  for (int k = 0; k < 50; ++k) scene.point_light({0.1f * static_cast<float>(k), 0, 1}, Rgb(1));
  LightSettings settings;
  settings.count = 9, settings.indirect = false;
  const auto lights = trace_virtual_lights(scene.build(), settings);
  ASSERT_EQ(lights.size(), 10u);  // made even
  std::array<int, 3> halves{};
  for (std::uint8_t h : lights.half) ++halves[h];
  EXPECT_EQ(halves, (std::array<int, 3>{0, 5, 5}));
}

}  // namespace
}  // namespace lumirank::transport
