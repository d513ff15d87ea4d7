// Lights of pbrt scenes: their units above all.
#include <cmath>
#include <fstream>

#include "base/spectrum.h"
#include "scenedesc/pbrt_scene.h"

namespace lumirank::scenedesc {
namespace {

template <typename Kind>
Kind light(const std::string& text, const std::string& head = "") {
  const SceneDesc scene = pbrt_world("LightSource " + text + "\n", head);
  return std::get<Kind>(scene.emitters.at(0).kind);
}

TEST(PbrtLight, RgbValuesAreRadiometricallyThoseOfThePicture) {
  expect_near(light<PointLightDesc>("\"point\" \"rgb I\" [ 3 2 1 ] \"float scale\" 2").intensity,
              Rgb(6, 4, 2), 1e-6f);
  expect_near(light<PointLightDesc>("\"point\"").intensity, Rgb(1), 1e-6f);
}

TEST(PbrtLight, SpectraHaveLuminanceOne) {
  for (const char* spectrum :
       {"\"blackbody I\" 2700", "\"blackbody I\" 6500", "\"spectrum I\" [ 300 5 900 5 ]",
        "\"spectrum I\" \"stdillum-A\"", "\"spectrum I\" \"stdillum-F2\""})
    EXPECT_NEAR(luminance(light<PointLightDesc>(std::string("\"point\" ") + spectrum).intensity), 1, 1e-4f)
        << spectrum;
  // Illuminant A is a blackbody of 2856 K.
  expect_near(light<PointLightDesc>("\"point\" \"spectrum I\" \"stdillum-A\"").intensity,
              light<PointLightDesc>("\"point\" \"blackbody I\" 2856").intensity, 2e-3f);
  const Rgb warm = light<PointLightDesc>("\"point\" \"blackbody I\" 2700").intensity;
  EXPECT_GT(warm.r, warm.g);
  EXPECT_GT(warm.g, warm.b);
}

TEST(PbrtLight, ExposureScalesAllLights) {
  const std::string head = "Film \"rgb\" \"float iso\" 400 Camera \"perspective\" \"float shutterclose\" 0.5";
  expect_near(light<PointLightDesc>("\"point\"", head).intensity, Rgb(2), 1e-6f);
  expect_near(light<ConstantEnvironmentDesc>("\"infinite\"", head).radiance, Rgb(2), 1e-6f);
  // A pixel of 2 is then 1 nit.
  EXPECT_EQ(pbrt_world("", head).lumens_per_unit, 0.5);
}

TEST(PbrtLight, PowerOfPointsAndSpots) {
  // 4π sr of 1 are 100 lm.
  expect_near(light<PointLightDesc>("\"point\" \"float power\" 100").intensity, Rgb(100 / (4 * kPi)), 1e-5f);
  // pbrt: 2π ((1 - cos 50°) + (cos 50° - cos 60°)/2) steradians.
  const float full = std::cos(50 * kPi / 180), sr = 2 * kPi * ((1 - full) + (full - 0.5f) / 2);
  const auto spot =
      light<SpotLightDesc>("\"spot\" \"float coneangle\" 60 \"float conedeltaangle\" 10 \"float power\" 100");
  expect_near(spot.intensity, Rgb(100 / sr), 1e-4f);
  EXPECT_EQ(spot.cutoff_angle, 60);
  EXPECT_EQ(spot.beam_width, 50);
  EXPECT_EQ(spot.edge, SpotLightDesc::Edge::smooth_cosine);
}

// Of all that reach the picture's scale only "scale" and the film's ratio stay beside the power.
TEST(PbrtLight, PowerOfGoniometricLights) {
  std::ofstream(testing::TempDir() + "lamp.exr") << "only its name matters here";
  const auto lamp = light<ProfileLightDesc>(
      "\"goniometric\" \"string filename\" \"lamp.exr\" \"rgb I\" [ 3 2 1 ] \"float scale\" 2 \"float "
      "power\" 100");
  expect_near(lamp.intensity, Rgb(6, 4, 2), 1e-6f);
  EXPECT_EQ(lamp.power.value_or(0), 100);
  EXPECT_FALSE(light<ProfileLightDesc>("\"goniometric\" \"string filename\" \"lamp.exr\"").power);
}

TEST(PbrtLight, Projections) {
  std::ofstream(testing::TempDir() + "slide.exr") << "only its name matters here";
  const auto slide = light<ProjectionLightDesc>(
      "\"projection\" \"string filename\" \"slide.exr\" \"float scale\" 2 \"float fov\" 40 \"float power\" "
      "9");
  expect_near(slide.intensity, Rgb(2), 1e-6f);
  EXPECT_EQ(slide.means, ProjectionLightDesc::Picture::intensity);
  EXPECT_EQ(slide.fov, 40);
  EXPECT_EQ(slide.axis, FieldAxis::smaller);
  EXPECT_EQ(slide.power.value_or(0), 9);
  EXPECT_EQ(slide.picture.texture, 0);
  // Upright: v is 1 at the top.
  EXPECT_EQ(slide.to_uv, (UvTransform{{0.5f, 0, 0.5f, 0, 0.5f, 0.5f}}));
  EXPECT_EQ(light<ProjectionLightDesc>("\"projection\" \"string filename\" \"slide.exr\"").fov, 90);
}

TEST(PbrtLight, PlacesAndDirections) {
  const SceneDesc scene = pbrt_world(
      "Translate 0 0 1 Scale 2 2 2\nLightSource \"point\" \"point3 from\" [ 1 2 3 ]\n"
      "LightSource \"distant\" \"point3 from\" [ 1 1 1 ] \"point3 to\" [ 1 0 1 ] \"rgb L\" [ 4 4 4 ]\n"
      "LightSource \"spot\" \"point3 from\" [ 0 1 0 ] \"point3 to\" [ 0 0 0 ] \"float conedeltaangle\" 0\n");
  EXPECT_TRUE(scene.warnings.empty());
  EXPECT_EQ(std::get<PointLightDesc>(scene.emitters.at(0).kind).position, (Vec3f{2, 4, 7}));
  const auto& sun = std::get<DirectionalLightDesc>(scene.emitters.at(1).kind);
  EXPECT_EQ(sun.direction, (Vec3f{0, -1, 0}));
  EXPECT_EQ(sun.irradiance, Rgb(4));
  const auto& spot = std::get<SpotLightDesc>(scene.emitters.at(2).kind);
  EXPECT_NEAR(length(spot.to_world.point({0, 0, 0}) - Vec3f{0, 2, 1}), 0, 1e-6f);
  EXPECT_NEAR(length(spot.to_world.vector({0, 0, 1}) - Vec3f{0, -1, 0}), 0, 1e-6f);
}

TEST(PbrtLight, IlluminanceOfSunAndSky) {
  expect_near(light<DirectionalLightDesc>("\"distant\" \"float illuminance\" 1000").irradiance, Rgb(1000),
              1e-3f);
  // A sky of radiance L gives πL.
  expect_near(light<ConstantEnvironmentDesc>("\"infinite\" \"float illuminance\" 1000").radiance,
              Rgb(1000 / kPi), 1e-3f);
}

TEST(PbrtLight, EnvironmentMaps) {
  std::ofstream(testing::TempDir() + "sky.exr") << "only its name matters here";
  const auto map = light<EnvironmentMapDesc>(
      "\"infinite\" \"string filename\" \"sky.exr\" \"float scale\" 3 \"float illuminance\" 7");
  EXPECT_EQ(map.projection, EnvironmentProjection::equal_area);
  EXPECT_EQ(map.scale, 3);
  EXPECT_EQ(map.illuminance.value_or(0), 7);
}

const std::string kQuad =
    "Shape \"trianglemesh\" \"point3 P\" [ 0 0 0  2 0 0  2 3 0  0 3 0 ] \"integer indices\" [ 0 1 2 0 2 3 "
    "]\n";

TEST(PbrtAreaLight, ShinesInTheDirectionOfTheNormal) {
  const SceneDesc scene = pbrt_world("AreaLightSource \"diffuse\" \"rgb L\" [ 1 2 3 ] \"float scale\" 2\n" +
                                     kQuad + "ReverseOrientation\n" + kQuad);
  ASSERT_EQ(scene.shapes.size(), 2u);
  EXPECT_EQ(scene.shapes[0].emitter->radiance.value, Rgb(2, 4, 6));
  EXPECT_EQ(scene.shapes[0].emitter->where.line, 3);
  EXPECT_FALSE(scene.shapes[0].flip_normals);
  EXPECT_TRUE(scene.shapes[1].flip_normals);
}

// pbrt makes a light of each triangle, and "power" is that of each: two of area 3 and 60 lm have the radiance
// 60/(3π). Twice as many sides have half of it.
TEST(PbrtAreaLight, PowerIsThatOfEachTriangle) {
  const SceneDesc one = pbrt_world("AreaLightSource \"diffuse\" \"float power\" 60\n" + kQuad);
  EXPECT_TRUE(one.warnings.empty());
  expect_near(one.shapes.at(0).emitter->radiance.value, Rgb(20 / kPi), 1e-4f);
  const SceneDesc moved = pbrt_world("Scale 2 1 1 AreaLightSource \"diffuse\" \"float power\" 60\n" + kQuad);
  expect_near(moved.shapes.at(0).emitter->radiance.value, Rgb(10 / kPi), 1e-4f);
  // A light of its own, after its transform like every triangle; quadrics count before it (Triangle::Area and
  // Disk::Area in pbrt-v4's shapes.h).
  const SceneDesc single = pbrt_world(
      "Scale 2 2 2 AreaLightSource \"diffuse\" \"float power\" 60\n"
      "Shape \"trianglemesh\" \"point3 P\" [ 0 0 0  2 0 0  0 3 0 ]\n"
      "Shape \"bilinearmesh\" \"point3 P\" [ 0 0 0  2 0 0  0 3 0  2 3 0 ]\nShape \"disk\"\n");
  expect_near(single.shapes.at(0).emitter->radiance.value, Rgb(60 / (kPi * 12)), 1e-4f);
  expect_near(single.shapes.at(1).emitter->radiance.value, Rgb(60 / (kPi * 24)), 1e-4f);
  expect_near(single.shapes.at(2).emitter->radiance.value, Rgb(60 / (kPi * kPi)),
              4e-3f);  // 128 segments: 0.04 %
  const SceneDesc sphere =
      pbrt_world("AreaLightSource \"diffuse\" \"float power\" 60 Shape \"sphere\" \"float radius\" 2\n");
  expect_near(sphere.shapes.at(0).emitter->radiance.value, Rgb(60 / (kPi * 16 * kPi)), 1e-5f);
  const SceneDesc uneven = pbrt_world(
      "AreaLightSource \"diffuse\" \"float power\" 60\n"
      "Shape \"trianglemesh\" \"point3 P\" [ 0 0 0  2 0 0  0 2 0  9 0 0  9 4 0  4 4 0 ] \"integer indices\" "
      "[ 0 1 2 3 4 5 ]\n");
  EXPECT_EQ(uneven.warnings.size(), 1u);
  expect_near(uneven.shapes.at(0).emitter->radiance.value, Rgb(2 * 60 / (kPi * 12)), 1e-4f);
}

TEST(PbrtAreaLight, TwoSidesAreTwoShapes) {
  const SceneDesc scene =
      pbrt_world("AreaLightSource \"diffuse\" \"rgb L\" [ 5 5 5 ] \"bool twosided\" true\n" + kQuad +
                 "Shape \"sphere\"\n");
  ASSERT_EQ(scene.shapes.size(), 4u);
  EXPECT_NE(scene.shapes[0].flip_normals, scene.shapes[1].flip_normals);
  EXPECT_EQ(scene.shapes[1].emitter->radiance.value, Rgb(5));
  const auto &front = *shape<InlineMeshDesc>(scene, 0).mesh, &back = *shape<InlineMeshDesc>(scene, 1).mesh;
  // The normal is +z, so the back lies below, at about 10⁻⁴ of the diagonal √13.
  EXPECT_EQ(front.positions[0].z, 0);
  EXPECT_LT(back.positions[0].z, -3e-4f);
  EXPECT_GT(back.positions[0].z, -6e-4f);
  EXPECT_LT(shape<SphereDesc>(scene, 3).radius, 1);
  EXPECT_NEAR(shape<SphereDesc>(scene, 3).radius, 1, 2e-4f);
}

// pbrt samples such a lamp, and no ray of its meets it.
TEST(PbrtAreaLight, AnAlphaOfNothingCannotBeSeen) {
  const SceneDesc scene = pbrt_world(
      "MakeNamedMedium \"fog\" \"string type\" \"homogeneous\"\nMediumInterface \"\" \"fog\"\n"
      "AreaLightSource \"diffuse\" \"bool twosided\" true\n"
      "Shape \"sphere\" \"float alpha\" 0\nShape \"sphere\" \"float alpha\" 1\n");
  ASSERT_EQ(scene.shapes.size(), 4u);
  EXPECT_TRUE(scene.warnings.empty());
  for (std::size_t k = 0; k < 4; ++k) {
    EXPECT_EQ(scene.shapes[k].emitter->seen, k >= 2);
    EXPECT_EQ(scene.shapes[k].media.divides, k >= 2);
    EXPECT_EQ(std::holds_alternative<NullBsdfDesc>(
                  scene.bsdfs.at(static_cast<std::size_t>(scene.shapes[k].bsdf)).kind),
              k < 2);
  }
}

TEST(PbrtAreaLight, InterfacesDoNotShine) {
  const SceneDesc scene = pbrt_world("AreaLightSource \"diffuse\" Material \"interface\" Shape \"sphere\"\n");
  EXPECT_FALSE(scene.shapes.at(0).emitter.has_value());
  EXPECT_EQ(scene.warnings.size(), 1u);
}

// The daylight of the temperature is white, as bright as it was.
TEST(PbrtFilm, WhiteBalanceMakesDaylightWhite) {
  const auto sky = [](const std::string& film) {
    const SceneDesc scene =
        pbrt_world("LightSource \"infinite\" \"rgb L\" [ 1 1 1 ]\n", "Film \"rgb\" " + film);
    EXPECT_TRUE(scene.warnings.empty()) << film;
    return std::get<ConstantEnvironmentDesc>(scene.emitters.at(0).kind).radiance;
  };
  const Rgb plain = sky(""), white = sky("\"float whitebalance\" 6504"),
            cool = sky("\"float whitebalance\" 4000"), warm = sky("\"float whitebalance\" 9000");
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(white[c], plain[c], 5e-3f * plain[c]);
  // D50 is (0.9642, 1, 0.8251) in XYZ, so (1.176, 0.976, 0.722) in linear sRGB.
  const Rgb d50 = sky("\"float whitebalance\" 5003");
  EXPECT_NEAR(d50.r / plain.r, 1 / 1.176f, 0.003f);
  EXPECT_NEAR(d50.g / plain.g, 1 / 0.976f, 0.003f);
  EXPECT_NEAR(d50.b / plain.b, 1 / 0.722f, 0.003f);
  EXPECT_LT(cool.r, cool.b);
  EXPECT_GT(warm.r, warm.b);
  EXPECT_THROW(sky("\"float whitebalance\" 10"), InputError);
}

}  // namespace
}  // namespace lumirank::scenedesc
