// Emission and features of pixels, against what geometry says.
#include "pipeline/pixel_features.h"

#include <gtest/gtest.h>

#include "support/statistics.h"
#include "world/scene_maker.h"

namespace lumirank::pipeline {
namespace {

using namespace test;

constexpr int kFilmSide = 16;

// From z = 10 the square [-1, 1]² of the plane z = 0 fills the film.
sd::SceneDesc square_in_view() {
  auto desc = empty_scene();
  auto& sensor = desc.sensors[0];
  sensor.to_world = Transform::look_at({0, 0, 10}, {0, 0, 0}, {0, 1, 0});
  sensor.fov_x = static_cast<float>(2 * 180 / 3.14159265358979 * std::atan(0.1));
  sensor.film.width = sensor.film.height = kFilmSide;
  return desc;
}

View view_of(const sd::SceneDesc& desc) { return make_view(desc, {}); }

PixelFeatures traced(const sd::SceneDesc& desc, double* differing = nullptr) {
  const world::World world = build(desc);
  const View view = view_of(desc);
  RenderSettings settings;
  PixelFeatureTracing tracing(world, view, make_recipe(settings, view));
  EXPECT_TRUE(tracing.trace_all(4, {}));
  if (differing) *differing = tracing.differing();
  EXPECT_TRUE(tracing.trace_differing(252, {}));
  return tracing.means();
}

void use(sd::SceneDesc& desc, int shape, int bsdf) {
  desc.shapes[static_cast<std::size_t>(shape)].bsdf = bsdf;
}

// A lamp whose edge runs through a column of pixels, before a gray wall.
TEST(PixelFeatures, EdgesHaveTheirCoverageAndTheRestFewSamples) {
  auto desc = square_in_view();
  const int gray = add_bsdf(desc, sd::DiffuseDesc{sd::ColorInput{Rgb(0.4f)}});
  use(desc, add_shape(desc, sd::RectangleDesc{}, Transform::scale(3, 3, 1)), gray);
  // 0.3 of a pixel beyond the middle of the film.
  const double edge = 0.3 * 2 / kFilmSide;
  const int lamp = add_shape(desc, sd::RectangleDesc{},
                             Transform::translate(3 + edge, 0, 1e-4) * Transform::scale(3, 3, 1));
  use(desc, lamp, add_bsdf(desc, sd::DiffuseDesc{sd::ColorInput{Rgb(0)}}));
  shine(desc, lamp, sd::ColorInput{Rgb(2)});
  double differing = 0;
  const PixelFeatures features = traced(desc, &differing);
  EXPECT_NEAR(differing, 2.0 / kFilmSide, 1.0 / kFilmSide);
  for (int y = 0; y < kFilmSide; ++y)
    for (int x = 0; x < kFilmSide; ++x) {
      const float lit = x < kFilmSide / 2 ? 0.0f : (x == kFilmSide / 2 ? 0.7f : 1.0f);
      EXPECT_NEAR(features.emission.at(x, y).g, 2 * lit, lit > 0 && lit < 1 ? 0.05f : 1e-4f) << x << ' ' << y;
      EXPECT_NEAR(features.albedo.at(x, y).g, 0.4f * (1 - lit), lit > 0 && lit < 1 ? 0.02f : 1e-4f);
      EXPECT_EQ(features.noisy_emission.at(x, y), Rgb(0));
      EXPECT_NEAR(features.cover.at(x, y).g, 1 - lit, lit > 0 && lit < 1 ? 0.05f : 0.0f);
      EXPECT_NEAR(features.normal.at(x, y).b, 1 - lit,
                  lit > 0 && lit < 1 ? 0.05f : 1e-4f);  // a black lamp receives nothing
    }
}

// A tenth of a window in a pixel is white on a screen, so its edge takes more samples than that of two walls.
TEST(PixelFeatures, EdgesOfWhatGlaresAreKnownFromOthers) {
  const auto glaring = [](Rgb radiance) {
    auto desc = square_in_view();
    const int gray = add_bsdf(desc, sd::DiffuseDesc{sd::ColorInput{Rgb(0.9f)}});
    use(desc, add_shape(desc, sd::RectangleDesc{}, Transform::scale(3, 3, 1)), gray);
    const int lamp =
        add_shape(desc, sd::RectangleDesc{},
                  Transform::translate(3 + 0.6 / kFilmSide, 0, 1e-4) * Transform::scale(3, 3, 1));
    use(desc, lamp, add_bsdf(desc, sd::DiffuseDesc{sd::ColorInput{Rgb(0)}}));
    shine(desc, lamp, sd::ColorInput{radiance});
    const world::World world = build(desc);
    const View view = view_of(desc);
    PixelFeatureTracing tracing(world, view, make_recipe({}, view));
    EXPECT_TRUE(tracing.trace_all(4, {}));
    EXPECT_GT(tracing.differing(), 0);
    EXPECT_TRUE(tracing.trace_glaring(252, {}));
    for (int y = 0; y < kFilmSide; ++y)
      EXPECT_NEAR(tracing.means().emission.at(kFilmSide / 2, y).g, 0.7f * radiance.g,
                  radiance.g > 1 ? 0.04f * radiance.g : 0.5f * radiance.g);
    return tracing.glaring();
  };
  EXPECT_NEAR(glaring(Rgb(20)), 2.0 / kFilmSide, 1.0 / kFilmSide);
  EXPECT_EQ(glaring(Rgb(0.8f)), 0);
}

// A small lamp far behind the focus is a disc, of which few samples see anything: it comes by the part that
// is denoised, and all pixels around those that found it are looked at again. In focus one sample sees what
// all do.
TEST(PixelFeatures, ALampOutOfFocusIsNoisyEmission) {
  const auto seen = [](float focus, double& glaring) {
    auto desc = square_in_view();
    auto& sensor = desc.sensors[0];
    sensor.kind = sd::SensorKind::thinlens;
    sensor.aperture_radius = 0.8f, sensor.focus_distance = focus;
    const int lamp = add_shape(desc, sd::DiskDesc{}, Transform::scale(0.1, 0.1, 1));
    use(desc, lamp, add_bsdf(desc, sd::DiffuseDesc{sd::ColorInput{Rgb(0)}}));
    shine(desc, lamp, sd::ColorInput{Rgb(100)});
    const world::World world = build(desc);
    const View view = view_of(desc);
    PixelFeatureTracing tracing(world, view, make_recipe({}, view));
    EXPECT_TRUE(tracing.trace_all(4, {}));
    glaring = tracing.glaring();
    EXPECT_TRUE(tracing.trace_glaring(1020, {}));
    return tracing.means();
  };
  const auto total = [](const image::Image& image) {
    double sum = 0;
    for (const Rgb& p : image.pixels) sum += static_cast<double>(p.g);
    return sum;
  };
  // What the lamp covers of the film, wherever it is sharp: 100 times its area over a pixel's.
  const double light = 100 * 3.14159265 * square(0.1 * kFilmSide / 2);
  double glaring = 0;
  const PixelFeatures sharp = seen(10, glaring), blurred = seen(5, glaring);
  EXPECT_NEAR(total(sharp.emission), light, 0.03 * light);
  EXPECT_EQ(total(sharp.noisy_emission), 0);
  // Of the lamp alone light needs no denoiser; where there is nothing it does no harm.
  EXPECT_NEAR(total(sharp.cover), kFilmSide * kFilmSide - light / 100, 0.03 * light / 100);
  for (const Rgb& p : blurred.cover.pixels) EXPECT_EQ(p, Rgb(1));
  EXPECT_EQ(total(blurred.emission), 0);
  EXPECT_NEAR(total(blurred.noisy_emission), light, 0.08 * light);
  // Its circle of confusion has a radius of 0.8, of 1 that are half of the film; one sample in 64 meets the
  // lamp.
  EXPECT_GT(glaring, 0.9 * 3.14159265 * square(0.8) / 4);
}

// The edge of a lamp before a mirror that shows another one, which is noisy: such a pixel is left whole.
TEST(PixelFeatures, WhereEmissionIsNoisyAllIsCovered) {
  auto desc = square_in_view();
  const int mirror = add_bsdf(desc, sd::ConductorDesc{}),
            black = add_bsdf(desc, sd::DiffuseDesc{sd::ColorInput{Rgb(0)}});
  use(desc, add_shape(desc, sd::RectangleDesc{}, Transform::scale(3, 3, 1)), mirror);
  const Transform faces_it = Transform::translate(0, 0, 20) * Transform::rotate(0, 1, 0, 180);
  const double edge = 0.3 * 2 / kFilmSide;
  for (const Transform& at : {faces_it * Transform::scale(50, 50, 1),
                              Transform::translate(3 + edge, 0, 1e-4) * Transform::scale(3, 3, 1)}) {
    const int lamp = add_shape(desc, sd::RectangleDesc{}, at);
    use(desc, lamp, black);
    shine(desc, lamp, sd::ColorInput{Rgb(1)});
  }
  const PixelFeatures features = traced(desc);
  for (int y = 0; y < kFilmSide; ++y)
    for (int x = 0; x < kFilmSide; ++x)
      EXPECT_EQ(features.cover.at(x, y), Rgb(x <= kFilmSide / 2 ? 1.0f : 0.0f)) << x << ' ' << y;
}

// A mirror shows a lamp behind the camera, and beside it a red wall.
TEST(PixelFeatures, OfAMirrorAreThoseOfWhatItShows) {
  auto desc = square_in_view();
  const int mirror = add_bsdf(desc, sd::ConductorDesc{});
  use(desc, add_shape(desc, sd::RectangleDesc{}, Transform::scale(3, 3, 1)), mirror);
  const Transform faces_it = Transform::translate(0, 0, 20) * Transform::rotate(0, 1, 0, 180);
  const int wall = add_shape(desc, sd::RectangleDesc{}, faces_it * Transform::scale(50, 50, 1));
  use(desc, wall, add_bsdf(desc, sd::DiffuseDesc{sd::ColorInput{Rgb(0.5f, 0, 0)}}));
  shine(desc, wall, sd::ColorInput{Rgb(1)});
  const PixelFeatures features = traced(desc);
  for (const Rgb& p : features.emission.pixels) EXPECT_EQ(p, Rgb(0));
  for (const Rgb& p : features.noisy_emission.pixels) EXPECT_GT(p.g, 0.5f);
  for (const Rgb& p : features.cover.pixels) EXPECT_EQ(p, Rgb(1));
  for (const Rgb& p : features.albedo.pixels) {
    EXPECT_GT(p.r, 0.25f);
    EXPECT_EQ(p.g, 0);
  }
  for (const Rgb& p : features.normal.pixels) EXPECT_LT(p.b, -0.99f);
}

// A wall in fog: what the fog hides of it is of the fog's albedo, and has no normal.
TEST(PixelFeatures, AMediumHidesWhatIsBehindIt) {
  auto desc = square_in_view();
  const int gray = add_bsdf(desc, sd::DiffuseDesc{sd::ColorInput{Rgb(0.4f)}});
  use(desc, add_shape(desc, sd::RectangleDesc{}, Transform::scale(3, 3, 1)), gray);
  sd::MediumDesc fog;
  fog.extinction.value = Rgb(0.1f, 0.05f, 0), fog.albedo.value = Rgb(0.9f);
  desc.media.push_back(fog);
  desc.sensors[0].medium = 0;
  const PixelFeatures features = traced(desc);
  const float red = std::exp(-1.0f), green = std::exp(-0.5f);
  double normal = 0, r = 0, g = 0;
  for (std::size_t p = 0; p < features.albedo.pixels.size(); ++p) {
    r += features.albedo.pixels[p].r, g += features.albedo.pixels[p].g;
    normal += features.normal.pixels[p].b;
    EXPECT_NEAR(features.albedo.pixels[p].b, 0.4f, 1e-3f);
  }
  constexpr double kPixels = kFilmSide * kFilmSide;
  EXPECT_NEAR(r / kPixels, 0.4f * red + 0.9f * (1 - red), 0.02);
  EXPECT_NEAR(g / kPixels, 0.4f * green + 0.9f * (1 - green), 0.02);
  EXPECT_NEAR(normal / kPixels, luminance(Rgb(red, green, 1)), 0.05);
}

// Smoke in layers before a wall, which all pixels see alike: so are their features, of few samples.
TEST(PixelFeatures, SmokeHasNoNoise) {
  auto desc = square_in_view();
  const int gray = add_bsdf(desc, sd::DiffuseDesc{sd::ColorInput{Rgb(0.4f)}});
  use(desc, add_shape(desc, sd::RectangleDesc{}, Transform::scale(3, 3, 1)), gray);
  sd::MediumDesc smoke;
  smoke.extinction = {Rgb(1), 0}, smoke.albedo.value = Rgb(0.9f);
  desc.media.push_back(smoke);
  auto grid = std::make_shared<sd::GridData>();
  grid->size = {2, 2, 8};
  for (int k = 0; k < 2 * 2 * 8; ++k) grid->values.push_back(k / 4 % 2 ? 0.4f : 0.0f);
  sd::VolumeDesc volume;
  volume.to_world = Transform::translate(-4, -4, 1) * Transform::scale(8, 8, 4);
  volume.kind = std::shared_ptr<const sd::GridData>(grid);
  desc.volumes.push_back(volume);
  desc.sensors[0].medium = 0;
  const world::World world = build(desc);
  const View view = view_of(desc);
  PixelFeatureTracing tracing(world, view, make_recipe({}, view));
  ASSERT_TRUE(tracing.trace_all(1, {}));
  const PixelFeatures features = tracing.means();
  // Half of four units of length have 0.4.
  const float through = std::exp(-0.8f), expected = 0.4f * through + 0.9f * (1 - through);
  for (const Rgb& p : features.albedo.pixels) EXPECT_NEAR(p.g, expected, 0.02f);
  for (const Rgb& p : features.normal.pixels) EXPECT_NEAR(p.b, through, 0.02f);
}

// A wall behind four blocks of glass, whose eight faces are more than an eye ray follows both ways; behind
// the eye, which the faces mirror, it is red. Film samples that drew another way than most tell nothing of
// the wall.
TEST(PixelFeatures, ManyPanesHaveNoNoise) {
  auto desc = square_in_view();
  const int gray = add_bsdf(desc, sd::DiffuseDesc{sd::ColorInput{Rgb(0.4f)}}),
            red = add_bsdf(desc, sd::DiffuseDesc{sd::ColorInput{Rgb{1, 0, 0}}}),
            glass = add_bsdf(desc, sd::DielectricDesc{.eta = 1.5f});
  use(desc, add_shape(desc, sd::RectangleDesc{}, Transform::scale(5, 5, 1)), gray);
  use(desc,
      add_shape(desc, sd::RectangleDesc{},
                Transform::translate(0, 0, 12) * Transform::rotate(1, 0, 0, 180) * Transform::scale(9, 9, 1)),
      red);
  for (const double z : {1.0, 2.5, 4.0, 5.5})
    use(desc, add_shape(desc, sd::CubeDesc{}, Transform::translate(0, 0, z) * Transform::scale(8, 8, 0.5)),
        glass);
  const world::World world = build(desc);
  const View view = view_of(desc);
  PixelFeatureTracing tracing(world, view, make_recipe({}, view));
  ASSERT_TRUE(tracing.trace_all(8, {}));
  const PixelFeatures features = tracing.means();
  // What the first faces mirror is followed by all samples, and is as red everywhere.
  test::RunningMean green, towards_eye;
  for (const Rgb& p : features.albedo.pixels) green.add(static_cast<double>(p.g));
  for (const Rgb& p : features.normal.pixels) towards_eye.add(static_cast<double>(p.b));
  EXPECT_GT(green.mean(), 0.2);
  EXPECT_LT(green.standard_error() * kFilmSide, 0.02);
  EXPECT_LT(towards_eye.standard_error() * kFilmSide, 0.05);
}

TEST(PixelFeatures, OnePixelIsAFireflyAndTwoAreALamp) {
  image::Image picture(8, 8);
  picture.at(2, 2) = Rgb(1000);
  picture.at(5, 5) = picture.at(6, 5) = Rgb(1000, 900, 800);
  const image::Image without = without_fireflies(picture, 0.5f);
  EXPECT_NEAR(without.at(2, 2).g, 8, 1e-4f);
  EXPECT_EQ(without.at(5, 5), picture.at(5, 5));
  EXPECT_EQ(without.at(6, 5), picture.at(6, 5));
}

}  // namespace
}  // namespace lumirank::pipeline
