// The matrix against the path tracer, and row-column sampling against the matrix.
#include <gtest/gtest.h>

#include <cstring>

#include "api/whole_renders.h"
#include "lumirank/lumirank.h"
#include "support/channel_means.h"
#include "support/scene_file.h"
#include "support/statistics.h"

namespace lumirank {
namespace {

using test::box;
using test::kAlpha;
using test::mean_color;
using test::mean_of;
using test::normal_quantile;
using test::student_quantile;

// Brute force over unclamped columns estimates the same as the path tracer over the paths that columns carry.
// The window shows the middle of the back wall: farther than 5 % of the scene from every other surface, so
// 1/d² leaves the variance finite.
void expect_equal_means(const char* only) {
  const Scene scene = box();
  RenderSettings settings;
  settings.traced.rest = RestOfPaths::skip;
  settings.view.width = settings.view.height = 64;
  settings.view.crop[0] = 26, settings.view.crop[1] = 12, settings.view.crop[2] = 12,
  settings.view.crop[3] = 8;
  set_field(settings, "only", only);
  settings.view.max_depth = 6;
  settings.method.name = "brute-force";
  settings.lights.clamp = 0;
  settings.traced.direct = DirectLight::matrix;
  settings.lights.count = 16000;  // they are aimed at the whole film
  ReferenceSettings how;
  how.paths = ReferencePaths::columns;
  how.spp = 512;
  constexpr int kSeeds = 32;
  test::ChannelMeans lights, paths;
  for (int k = 0; k < kSeeds; ++k) {
    settings.seed = 100 + static_cast<std::uint64_t>(k);
    lights.add(render(scene, settings).picture);
    paths.add(reference(scene, settings, how).picture);
  }
  test::expect_equal_means(lights, paths, 0.06, only);
}

TEST(Unbiased, BruteForceAgreesWithThePathTracerOnDirectLight) { expect_equal_means("direct"); }
TEST(Unbiased, BruteForceAgreesWithThePathTracerOnIndirectLight) { expect_equal_means("indirect"); }

// A picture that a point light throws has its colors by columns and by paths.
TEST(Unbiased, AProjectedPictureIsTheSameByColumnsAndByPaths) {
  const Scene scene = test::load_text(
      test::point_camera("0,0.5,3", "0,0,0", 16, 40) +
      "<shape type=\"rectangle\"><transform name=\"to_world\"><rotate x=\"1\" angle=\"-20\"/><scale "
      "value=\"2\"/></transform></shape><emitter type=\"projector\"><texture type=\"checkerboard\" "
      "name=\"irradiance\"><rgb name=\"color0\" value=\"1, 0.2, 0\"/><rgb name=\"color1\" value=\"0, 0.5, "
      "3\"/></texture><transform name=\"to_world\"><lookat origin=\"0.5,1,2\" target=\"0,0,0\" "
      "up=\"0,1,0\"/></transform></emitter>");
  RenderSettings settings;
  settings.denoise = Denoise::off;
  settings.view.only = LightPart::direct;
  settings.traced.direct = DirectLight::matrix;
  settings.method.name = "brute-force";
  settings.view.spp = 256;
  const auto columns = mean_color(render(scene, settings).picture),
             paths = mean_color(reference(scene, settings, {.spp = 256}).picture);
  for (std::size_t c = 0; c < 3; ++c) {
    EXPECT_GT(paths[c], 0.01);
    EXPECT_NEAR(columns[c] / paths[c], 1, 0.01) << c;  // where samples lie in pixels
  }
}

// A lamp over a shining floor: however the direct light is divided between columns and traced samples, the
// sum is the same.
TEST(Unbiased, DirectLightAtGlossyReceiversAgreesHoweverItIsDivided) {
  const Scene scene = test::load_text(
      test::point_camera("0,1,3", "0,0,0.5", 16, 20) +
      "<shape type=\"rectangle\"><transform name=\"to_world\"><rotate x=\"1\" angle=\"-90\"/><scale "
      "value=\"4\"/>"
      "</transform><bsdf type=\"roughplastic\"><float name=\"alpha\" value=\"0.2\"/></bsdf></shape>"
      "<shape type=\"rectangle\"><transform name=\"to_world\"><rotate x=\"1\" angle=\"60\"/><scale "
      "value=\"0.4\"/>"
      "<translate y=\"1.2\" z=\"-1.5\"/></transform><emitter type=\"area\"><rgb name=\"radiance\" value=\"5, "
      "6, 7\"/>"
      "</emitter></shape>");
  RenderSettings settings;
  settings.traced.rest = RestOfPaths::skip;
  settings.view.only = LightPart::direct;
  settings.method.name = "brute-force";
  settings.lights.clamp = 0;
  settings.lights.count = 400;
  ReferenceSettings how;
  how.spp = 128;
  constexpr int kSeeds = 32;
  std::vector<double> truth;
  for (std::uint64_t k = 0; k < kSeeds; ++k) {
    settings.seed = 500 + k;
    truth.push_back(mean_color(reference(scene, settings, how).picture)[1]);
  }
  const auto expected = mean_of(truth);
  for (const char* direct : {"matrix", "auto", "traced"}) {
    set_field(settings, "direct", direct);
    std::vector<double> means;
    for (std::uint64_t k = 0; k < kSeeds; ++k) {
      settings.seed = 500 + k;
      means.push_back(mean_color(render(scene, settings).picture)[1]);
    }
    const auto m = mean_of(means);
    const double error = std::hypot(m.standard_error, expected.standard_error);
    EXPECT_NEAR(m.mean, expected.mean, student_quantile(kAlpha, 3, kSeeds - 1) * error) << direct;
    EXPECT_LT(student_quantile(kAlpha, 3, kSeeds - 1) * error, 0.03 * expected.mean) << direct;
  }
}

TEST(Unbiased, RowColumnSamplingAgreesWithBruteForceOver48Seeds) {
  // Scalar representatives, zero columns sampled, fixed rows and columns: the estimator of section 3.3,
  // unbiased by construction. The lights stay the same; what varies is the method's own choices.
  const Scene scene = box();
  RenderSettings settings;
  settings.traced.rest = RestOfPaths::skip;
  settings.view.width = 32, settings.view.height = 32;
  settings.lights.count = 600;
  settings.view.spp = 1;
  settings.traced.direct = DirectLight::matrix;
  settings.method.name = "brute-force";
  const Picture truth = render(scene, settings).picture;

  settings.method.name = "row-column-sampling";
  settings.method.parameters = {{"rows", "20"},
                                {"columns", "30"},
                                {"color", "scalar"},
                                {"zero-columns", "sample"},
                                {"max-contribution", "0"}};
  constexpr int kSeeds = 48, kBlock = 8, kBlocks = 32 / kBlock;
  std::vector<std::vector<double>> blocks(kBlocks * kBlocks * 3);
  const auto add = [&](const Picture& picture, auto&& keep) {
    std::vector<double> sums(blocks.size());
    for (int y = 0; y < 32; ++y)
      for (int x = 0; x < 32; ++x)
        for (int c = 0; c < 3; ++c)
          sums[static_cast<std::size_t>(((y / kBlock) * kBlocks + x / kBlock) * 3 + c)] +=
              picture.planes[0].rgb[static_cast<std::size_t>((y * 32 + x) * 3 + c)];
    for (std::size_t k = 0; k < sums.size(); ++k) keep(k, sums[k]);
  };
  std::vector<double> expected(blocks.size());
  add(truth, [&](std::size_t k, double v) { expected[k] = v; });
  for (int seed = 0; seed < kSeeds; ++seed) {
    settings.method.seed = 1000 + static_cast<std::uint64_t>(seed);
    add(render(scene, settings).picture, [&](std::size_t k, double v) { blocks[k].push_back(v); });
  }
  for (std::size_t k = 0; k < blocks.size(); ++k) {
    const auto m = mean_of(blocks[k]);
    EXPECT_NEAR(m.mean, expected[k],
                student_quantile(kAlpha, blocks.size(), kSeeds - 1) * m.standard_error + 1e-6 * expected[k])
        << "block " << k / 3 << ", channel " << k % 3;
  }
}

TEST(Determinism, TheSameBitsOnOneTwoAndFourThreads) {
  const Scene scene = test::example("interior.xml");
  RenderSettings settings;
  settings.traced.rest = RestOfPaths::skip;
  settings.view.width = 48, settings.view.height = 32;
  settings.lights.count = 4000;
  for (const char* method : {"brute-force", "instant-radiosity", "power-sampling", "row-column-sampling"}) {
    settings.method.name = method;
    settings.threads = 1;
    const Picture one = render(scene, settings).picture;
    for (int threads : {2, 4}) {
      settings.threads = threads;
      const Picture many = render(scene, settings).picture;
      ASSERT_EQ(one.planes[0].rgb.size(), many.planes[0].rgb.size());
      EXPECT_EQ(std::memcmp(one.planes[0].rgb.data(), many.planes[0].rgb.data(),
                            one.planes[0].rgb.size() * sizeof(float)),
                0)
          << method << " on " << threads << " threads";
    }
  }
}

TEST(Determinism, TheReferenceToo) {
  const Scene scene = box();
  RenderSettings settings;
  settings.traced.rest = RestOfPaths::skip;
  settings.view.width = settings.view.height = 32;
  ReferenceSettings how;
  how.spp = 8;
  settings.threads = 1;
  const Picture one = reference(scene, settings, how).picture;
  for (int threads : {2, 4}) {
    settings.threads = threads;
    const Picture many = reference(scene, settings, how).picture;
    EXPECT_EQ(one.planes[0].rgb, many.planes[0].rgb) << threads << " threads";
  }
}

}  // namespace
}  // namespace lumirank
