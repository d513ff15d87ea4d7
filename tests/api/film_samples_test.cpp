// Film samples apart from receivers: pictures against closed forms.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "api/whole_renders.h"
#include "lumirank/lumirank.h"
#include "lumirank/session.h"
#include "support/scene_file.h"

namespace lumirank {
namespace {

using test::box;
using test::example;
using test::load_text;

constexpr int kSize = 16;

// Straight down on [-1, 1]², which the film of 16 × 16 pixels shows exactly.
std::string camera_above(const char* filter = "box") {
  return std::string(
             "<sensor type=\"orthographic\"><transform name=\"to_world\"><lookat origin=\"0,0,5\" "
             "target=\"0,0,0\" up=\"0,1,0\"/></transform><film type=\"hdrfilm\"><integer "
             "name=\"width\" value=\"16\"/><integer name=\"height\" value=\"16\"/><rfilter type=\"") +
         filter + "\"/></film></sensor>";
}
// Of irradiance 2π from straight above: a white surface has a radiance of 2.
const std::string kSun =
    "<emitter type=\"directional\"><vector name=\"direction\" x=\"0\" y=\"0\" z=\"-1\"/><rgb "
    "name=\"irradiance\" value=\"6.2831853\"/></emitter>";

std::string floor_of(const std::string& reflectance) {
  return "<shape type=\"rectangle\"><bsdf type=\"diffuse\">" + reflectance + "</bsdf></shape>";
}
std::string checkers(double scale) {
  return "<texture name=\"reflectance\" type=\"checkerboard\"><rgb name=\"color0\" value=\"0.8\"/><rgb "
         "name=\"color1\" value=\"0.1\"/><transform name=\"to_uv\"><scale value=\"" +
         std::to_string(scale) + "\"/></transform></texture>";
}

RenderSettings settings_with(int spp, int film_samples) {
  RenderSettings s;
  s.method.name = "brute-force";
  s.lights.count = 64;
  s.traced.rest = RestOfPaths::skip;
  s.traced.direct = DirectLight::matrix;
  s.view.spp = spp, s.view.film_samples = film_samples;
  return s;
}

std::vector<float> render_pixels(const Scene& scene, const RenderSettings& settings) {
  return render(scene, settings).picture.planes[0].rgb;
}

// Four by four checkers in each pixel: 64 film samples have four in each of them, so that a pixel is the mean
// of both colors. One receiver per pixel sees one of them.
TEST(FilmSamples, ATexturedPlaneHasTheMeanOfItsTexture) {
  const Scene scene = load_text(camera_above() + floor_of(checkers(2 * kSize)) + kSun);
  for (const float v : render_pixels(scene, settings_with(1, 64))) ASSERT_NEAR(v, 2 * 0.45, 1e-5);
  for (const float v : render_pixels(scene, settings_with(1, 0)))
    ASSERT_NEAR(std::abs(v - 2 * 0.45), 2 * 0.35, 1e-5);
}

// Mean of the checkers' sign along one axis over [x, x + 1] pixels, for checkers of `cell` pixels.
double mean_sign(double x, double cell) {
  const auto integral = [cell](double at) {
    const double whole = std::floor(at / cell), rest = at - whole * cell;
    const bool odd = std::fmod(whole, 2) == 1;
    return odd ? cell - rest : rest;
  };
  return integral(x + 1) - integral(x);
}

// Checkers of 3.7 pixels, whose edges cut the pixels anywhere: the share of each color is that of its area.
TEST(FilmSamples, ACheckeredEdgeHasTheShareOfItsArea) {
  const double cell = 3.7;
  const Scene scene = load_text(camera_above() + floor_of(checkers(kSize / (2 * cell))) + kSun);
  const auto error_of = [&](int film_samples, bool strict) {
    const auto pixels = render_pixels(scene, settings_with(4, film_samples));
    double sum = 0;
    for (int y = 0; y < kSize; ++y)
      for (int x = 0; x < kSize; ++x) {
        // u grows to the left of the film of a camera that looks down with y up, v upwards.
        const double both = mean_sign(x, cell) * mean_sign(kSize - 1 - y, cell);
        const double expected = 2 * (0.45 + 0.35 * both);
        const double error = std::abs(pixels[static_cast<std::size_t>(3 * (kSize * y + x))] - expected);
        // At worst an edge crosses the strata of a row and a column: 16 of 256 that it decides at random.
        if (strict) {
          EXPECT_LT(error, 2 * 0.7 * 4 * std::sqrt(32 * 0.25) / 256) << x << " " << y;
        }
        sum += error;
      }
    return sum / (kSize * kSize);
  };
  const double fine = error_of(256, true), coarse = error_of(0, false);
  EXPECT_LT(fine, 0.007);
  EXPECT_GT(coarse, 5 * fine);
}

// A plain wall under a lamp close by: whatever film samples there are, a pixel is the mean of its receivers.
TEST(FilmSamples, APlainWallIsTheMeanOfItsReceivers) {
  const Scene scene =
      load_text(camera_above() + floor_of("<rgb name=\"reflectance\" value=\"0.3,0.5,0.7\"/>") +
                "<emitter type=\"point\"><point name=\"position\" x=\"0.2\" y=\"0.1\" "
                "z=\"0.3\"/><rgb name=\"intensity\" value=\"1\"/></emitter>");
  const auto receivers = render_pixels(scene, settings_with(4, 0));
  for (const int film_samples : {1, 16, 37}) {
    const RenderResult made = render(scene, settings_with(4, film_samples));
    EXPECT_EQ(made.report.numbers.at("film.samples"), film_samples);
    EXPECT_EQ(made.report.numbers.at("film.receivers_added"), 0);
    EXPECT_EQ(made.report.numbers.at("film.from_own_pixel"), 1);
    const auto& pixels = made.picture.planes[0].rgb;
    for (std::size_t k = 0; k < pixels.size(); ++k) ASSERT_NEAR(pixels[k] / receivers[k], 1, 1e-5);
  }
}

// Bright poles of a tenth of a pixel over a black floor: the pixels have a tenth of their light.
TEST(FilmSamples, ThinThingsHaveTheLightOfTheirArea) {
  std::string scene = camera_above() + floor_of("<rgb name=\"reflectance\" value=\"0.1\"/>") + kSun;
  for (int k = 0; k < kSize; ++k)
    scene += "<shape type=\"rectangle\"><transform name=\"to_world\"><scale x=\"0.00625\"/><translate x=\"" +
             std::to_string(-1 + (k + 0.5) / 8) +
             "\" z=\"1\"/></transform><bsdf type=\"diffuse\"><rgb name=\"reflectance\" value=\"0.9\"/>"
             "</bsdf></shape>";
  const RenderResult made = render(load_text(scene), settings_with(1, 64));
  EXPECT_GT(made.report.numbers.at("film.receivers_added"), 10);
  double sum = 0;
  for (const float v : made.picture.planes[0].rgb) {
    EXPECT_NEAR(v, 2 * (0.9 * 0.1 + 0.1 * 0.9), 2 * 0.8 * 4 * 0.034);  // 4 σ of 64 in 8 columns
    sum += v;
  }
  const double n = static_cast<double>(made.picture.planes[0].rgb.size());
  EXPECT_NEAR(sum / n, 0.36, 0.36 * 0.03);
}

RenderSettings small_settings(const char* method) {
  RenderSettings s;
  s.method.name = method;
  s.lights.count = 300;
  s.view.width = 40, s.view.height = 24;
  s.view.spp = 2;
  s.view.film_samples = 9;
  s.traced.rest = RestOfPaths::skip;
  return s;
}

TEST(FilmSamples, TheSameBitsWithAnyNumberOfThreads) {
  const Scene scene = example("interior.xml");
  RenderSettings settings = small_settings("slice-cuts");
  settings.threads = 1;
  const auto one = render_pixels(scene, settings);
  settings.threads = 3;
  EXPECT_EQ(one, render_pixels(scene, settings));
  EXPECT_EQ(one, develop(prepare(scene, settings), estimate_sums(prepare(scene, settings), settings.method))
                     .planes[0]
                     .rgb);
}

TEST(FilmSamples, AWindowHasTheBitsOfTheWhole) {
  const Scene scene = example("interior.xml");
  RenderSettings settings = small_settings("brute-force");
  const auto whole = render_pixels(scene, settings);
  settings.view.crop = {13, 7, 11, 9};
  const auto window = render_pixels(scene, settings);
  for (int y = 0; y < 9; ++y)
    for (int k = 0; k < 33; ++k)
      ASSERT_EQ(window[static_cast<std::size_t>(33 * y + k)],
                whole[static_cast<std::size_t>(120 * (y + 7) + 39 + k)]);
}

// Emission, direct and indirect light are of the same film samples as the picture.
TEST(FilmSamples, LayersAddUpToThePicture) {
  RenderSettings settings = small_settings("brute-force");
  settings.layers = {"emission", "direct", "indirect", "albedo"};
  const Picture picture = render(example("interior.xml"), settings).picture;
  for (std::size_t k = 0; k < picture.planes[0].rgb.size(); ++k) {
    const double sum =
        static_cast<double>(picture.planes[1].rgb[k]) + picture.planes[2].rgb[k] + picture.planes[3].rgb[k];
    ASSERT_NEAR(picture.planes[0].rgb[k], sum, 1e-4 * std::max(1.0, sum));
  }
}

TEST(FilmSamples, SumsOfWholePixelsAreLeftAsTheyAre) {
  RenderSettings settings = small_settings("multidimensional-lightcuts");
  EXPECT_THROW(render(box(), settings), InputError) << "asked for by hand";
  settings.view.film_samples.reset();
  EXPECT_EQ(render(box(), settings).report.numbers.at("film.samples"), 0);
  settings.method.name = "power-sampling";
  const Prepared prepared = prepare(box(), settings);
  EXPECT_THROW(estimate_sums(prepared, small_settings("multidimensional-lightcuts").method), InputError);
}

TEST(FilmSamples, WhereThereAreAsManyReceiversTheseAreTheFilmSamples) {
  RenderSettings settings = small_settings("power-sampling");
  settings.view.film_samples.reset();
  for (const auto& [spp, film_samples] : {std::pair{4, 16}, std::pair{15, 16}, std::pair{16, 0}}) {
    settings.view.spp = spp;
    const RenderResult made = render(box(), settings);
    EXPECT_EQ(made.report.numbers.at("film.samples"), film_samples);
    EXPECT_EQ(render(box(), render_settings_from_report(made.report.json())).picture.planes[0].rgb,
              made.picture.planes[0].rgb);
  }
  // Asked for by hand, they are there, and a report repeats that.
  settings.view.film_samples = 16;
  const RenderResult made = render(box(), settings);
  EXPECT_EQ(made.report.numbers.at("film.samples"), 16);
  EXPECT_EQ(render_settings_from_report(made.report.json()).view.film_samples_or_default(), 16);
}

}  // namespace
}  // namespace lumirank
