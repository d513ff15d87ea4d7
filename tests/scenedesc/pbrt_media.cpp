// Participating media of pbrt scenes, and what is between them.
#include <cmath>

#include "base/spectrum.h"
#include "scenedesc/pbrt_scene.h"

namespace lumirank::scenedesc {
namespace {

std::string medium_text(const std::string& name, const std::string& parameters) {
  return "MakeNamedMedium \"" + name + "\" \"string type\" " + parameters + "\n";
}
// A scene of this medium alone; nothing is in it.
MediumDesc medium(const std::string& parameters, const std::string& head = "") {
  return pbrt_world(medium_text("fog", parameters), head).media.at(0);
}
const GridData& grid(const SceneDesc& scene, const VolumeInput& input) {
  return *std::get<std::shared_ptr<const GridData>>(volume(scene, input).kind);
}
const std::string kFog = medium_text("fog", "\"homogeneous\"");

TEST(PbrtMedium, HomogeneousIsAbsorptionAndScatteringTimesAScale) {
  const SceneDesc scene = pbrt_world(medium_text(
      "fog",
      "\"homogeneous\" \"rgb sigma_a\" [ .1 .2 .3 ] \"rgb sigma_s\" [ 1 2 3 ] \"float scale\" 2 \"float "
      "g\" -.5"));
  ASSERT_EQ(scene.media.size(), 1u);
  const MediumDesc& m = scene.media[0];
  EXPECT_EQ(m.id, "fog");
  EXPECT_EQ(m.where.line, 3);
  EXPECT_EQ(m.form, MediumDesc::Form::absorption_and_scattering);
  expect_near(m.absorption.value, Rgb(0.2f, 0.4f, 0.6f), 1e-6f);
  expect_near(m.scattering.value, Rgb(2, 4, 6), 1e-6f);
  EXPECT_EQ(m.emission.value, Rgb(0));
  ASSERT_EQ(m.phase.size(), 1u);
  EXPECT_EQ(m.phase[0].kind, PhaseLobeDesc::Kind::henyey_greenstein);
  EXPECT_EQ(m.phase[0].g, Rgb(-0.5f));
  EXPECT_EQ(m.phase[0].weight, 1);
  EXPECT_TRUE(m.homogeneous());
  EXPECT_TRUE(scene.warnings.empty()) << describe(scene);
  const MediumDesc plain = medium("\"homogeneous\"");
  EXPECT_EQ(plain.absorption.value, Rgb(1));
  EXPECT_EQ(plain.scattering.value, Rgb(1));
  EXPECT_TRUE(plain.phase.empty());
}

TEST(PbrtMedium, EmissionIsThatOfWhatAbsorbs) {
  const std::string glow =
      "\"homogeneous\" \"rgb sigma_a\" [ 1 2 0 ] \"rgb Le\" [ 1 2 3 ] \"float Lescale\" 3";
  expect_near(medium(glow + " \"float scale\" .5").emission.value, Rgb(1.5f, 6, 0), 1e-5f);
  // As with lights, a spectrum has luminance 1, and the film's exposure counts, wherever the camera is.
  EXPECT_NEAR(luminance(medium("\"homogeneous\" \"blackbody Le\" 3000").emission.value), 1, 1e-4f);
  const std::string head = medium_text("early", glow) + "Film \"rgb\" \"float iso\" 400";
  expect_near(pbrt_world("", head).media.at(0).emission.value, Rgb(12, 48, 0), 1e-4f);
}

TEST(PbrtMedium, Presets) {
  const MediumDesc known = medium("\"homogeneous\" \"string preset\" \"milk\" \"float scale\" 10");
  EXPECT_EQ(known.scattering.value, Rgb(10));
  ASSERT_EQ(known.phase.size(), 1u);
  EXPECT_EQ(known.phase[0].g, Rgb(0.82f, 0.8f, 0.75f));
  const SceneDesc scene =
      pbrt_world(medium_text("food", "\"homogeneous\" \"string preset\" \"Mustard\" \"float g\" .3"));
  const Warning warning = only_warning(scene);
  EXPECT_NE(warning.what.find("\"Mustard\""), std::string::npos) << warning.what;
  expect_near(scene.media.at(0).absorption.value, Rgb(0.0011f, 0.0024f, 0.014f), 1e-7f);
  expect_near(scene.media.at(0).scattering.value, Rgb(2.55f, 3.21f, 3.77f), 1e-6f);
  EXPECT_EQ(scene.media.at(0).phase.at(0).g, Rgb(0.3f));
}

TEST(PbrtMedium, AttributesAreInherited) {
  const SceneDesc scene = pbrt_world("Attribute \"medium\" \"float g\" .25\n" + kFog);
  EXPECT_EQ(scene.media.at(0).phase.at(0).g, Rgb(0.25f));
}

TEST(PbrtMedium, GridsOfNumbersFillTheirBox) {
  const SceneDesc scene = pbrt_world(
      "Translate 10 0 0\nScale 2 2 2\n" +
      medium_text("smoke",
                  "\"uniformgrid\" \"integer nx\" 2 \"integer ny\" 1 \"integer nz\" 3 \"float density\" "
                  "[ 0 1 2 3 4 5 ] \"point3 p0\" [ 1 1 1 ] \"point3 p1\" [ 0 3 5 ] \"rgb sigma_a\" [ .5 "
                  ".5 .5 ] \"rgb sigma_s\" [ 2 3 4 ] \"float scale\" 2"));
  const MediumDesc& m = scene.media.at(0);
  EXPECT_FALSE(m.homogeneous());
  EXPECT_EQ(m.absorption.value, Rgb(1));
  EXPECT_EQ(m.scattering.value, Rgb(4, 6, 8));
  EXPECT_EQ(m.absorption.volume, m.scattering.volume);
  EXPECT_EQ(scene.volumes.size(), 1u);
  const VolumeDesc& v = volume(scene, m.scattering);
  EXPECT_EQ(v.sampling, GridSampling::fading_cells);
  EXPECT_FALSE(v.nearest);
  // The unit cube is the box, whichever corners are given, under the transform of the medium.
  EXPECT_EQ(v.to_world.point({0, 0, 0}), (Vec3f{10, 2, 2}));
  EXPECT_EQ(v.to_world.point({1, 1, 1}), (Vec3f{12, 6, 10}));
  const GridData& g = grid(scene, m.scattering);
  EXPECT_EQ(g.size, (std::array{2, 1, 3}));
  EXPECT_EQ(g.channels, 1);
  EXPECT_EQ(g.values, (std::vector<float>{0, 1, 2, 3, 4, 5}));
  EXPECT_EQ(m.emission.volume, kNone);
}

TEST(PbrtMedium, GridsOfNumbersThatShine) {
  const std::string two =
      "\"uniformgrid\" \"integer nx\" 2 \"float density\" [ 1 4 ] \"rgb sigma_a\" [ 2 2 2 ] \"rgb Le\" [ 1 0 "
      "0 ] ";
  const SceneDesc scene = pbrt_world(medium_text("fire", two + "\"float Lescale\" [ 5 .5 ]"));
  const MediumDesc& m = scene.media.at(0);
  EXPECT_EQ(m.emission.value, Rgb(2, 0, 0));
  EXPECT_EQ(grid(scene, m.emission).values, (std::vector<float>{5, 2}));
  EXPECT_EQ(grid(scene, m.absorption).values, (std::vector<float>{1, 4}));
  // Without "Lescale" pbrt has one cell of 1 all over the box, of which ¾ is left halfway to a face.
  const SceneDesc plain = pbrt_world(medium_text("fire", two));
  EXPECT_EQ(grid(plain, plain.media.at(0).emission).values, (std::vector<float>{0.75f, 3}));
}

TEST(PbrtMedium, GridsOfColors) {
  const SceneDesc scene = pbrt_world(
      medium_text("smoke",
                  "\"rgbgrid\" \"integer nz\" 2 \"rgb sigma_a\" [ 1 2 3 4 5 6 ] \"rgb sigma_s\" [ 7 8 9 1 1 "
                  "1 ] \"float scale\" .5 \"rgb Le\" [ 1 1 1 0 1 2 ] \"float Lescale\" 4"));
  const MediumDesc& m = scene.media.at(0);
  EXPECT_EQ(m.absorption.value, Rgb(0.5f));
  EXPECT_EQ(grid(scene, m.absorption).channels, 3);
  EXPECT_EQ(grid(scene, m.absorption).values, (std::vector<float>{1, 2, 3, 4, 5, 6}));
  EXPECT_EQ(grid(scene, m.scattering).values, (std::vector<float>{7, 8, 9, 1, 1, 1}));
  EXPECT_EQ(grid(scene, m.scattering).size, (std::array{1, 1, 2}));
  // Unlike other lights, these are not divided by the integral of the observer.
  expect_near(m.emission.value, Rgb(2 * 106.856895f), 1e-3f);
  EXPECT_EQ(grid(scene, m.emission).values, (std::vector<float>{1, 2, 3, 0, 5, 12}));
  // Of the two coefficients, one that is not given is 1.
  const MediumDesc half = medium("\"rgbgrid\" \"rgb sigma_s\" [ 7 8 9 ] \"float scale\" 2");
  EXPECT_EQ(half.absorption.volume, kNone);
  EXPECT_EQ(half.absorption.value, Rgb(2));
  EXPECT_NE(half.scattering.volume, kNone);
}

TEST(PbrtMedium, GridsOfNumbersThatGlow) {
  const SceneDesc hot = pbrt_world(medium_text(
      "fire",
      "\"uniformgrid\" \"integer nx\" 2 \"float density\" [ 1 3 ] \"float temperature\" [ 1000 40 ] \"float "
      "temperaturescale\" 2 \"float Lescale\" [ .5 1 ] \"rgb sigma_a\" [ 4 4 4 ]"));
  EXPECT_TRUE(hot.warnings.empty()) << describe(hot);
  const MediumDesc& m = hot.media.at(0);
  EXPECT_NEAR(m.emission.value.g, 4 * 106.856895f, 1e-2f);
  const GridData& glow = grid(hot, m.emission);
  EXPECT_EQ(glow.channels, 3);
  const Rgb color = blackbody_to_rgb(2000) * static_cast<float>(0.5 / planck(1448.8859775, 2000));
  expect_near({glow.values.at(0), glow.values[1], std::max(glow.values[2], 0.0f)},
              {color.r, color.g, std::max(color.b, 0.0f)}, 1e-5f);
  EXPECT_EQ(glow.values.at(3), 0) << "80 K is dark";
  EXPECT_THROW(
      pbrt_world(medium_text("fire",
                             "\"uniformgrid\" \"float density\" 1 \"float temperature\" 1000 \"rgb Le\" "
                             "[ 1 1 1 ]")),
      InputError);
}

TEST(PbrtMediumInterface, DividesWhereTheSidesDiffer) {
  const SceneDesc scene = pbrt_world(kSphere + kFog + medium_text("haze", "\"homogeneous\"") +
                                     "AttributeBegin\nMediumInterface \"fog\" \"haze\"\n" + kSphere +
                                     "MediumInterface \"haze\"\n" + kSphere +
                                     "AttributeEnd\nMediumInterface \"\" \"fog\"\n" + kSphere);
  const auto media = [&](std::size_t k) { return scene.shapes.at(k).media; };
  EXPECT_FALSE(media(0).divides);
  EXPECT_TRUE(media(1).divides);
  EXPECT_EQ(media(1).inside, 0);
  EXPECT_EQ(media(1).outside, 1);
  // One name is both sides.
  EXPECT_FALSE(media(2).divides);
  EXPECT_EQ(media(2).inside, kNone);
  EXPECT_TRUE(media(3).divides);
  EXPECT_EQ(media(3).inside, kNone);
  EXPECT_EQ(media(3).outside, 0);
}

TEST(PbrtMediumInterface, MayNameWhatIsDefinedLater) {
  const SceneDesc scene = pbrt_world(medium_text("haze", "\"homogeneous\"") +
                                     "MediumInterface \"fog\" \"haze\"\n" + kSphere + kFog);
  EXPECT_EQ(scene.media.at(1).id, "fog");
  EXPECT_EQ(scene.shapes.at(0).media.inside, 1);
  EXPECT_EQ(scene.shapes.at(0).media.outside, 0);
  // Where nothing is between them, nobody asks.
  EXPECT_TRUE(pbrt_world("MediumInterface \"none\" \"\"\n").shapes.empty());
}

TEST(PbrtMediumInterface, HoldsInObjectsAndOnInterfaces) {
  const SceneDesc scene =
      pbrt_world(kFog + "ObjectBegin \"ball\"\nMaterial \"interface\" MediumInterface \"fog\" \"\"\n" +
                 kSphere + "ObjectEnd\nObjectInstance \"ball\"\nMaterial \"\"\n" + kSphere);
  EXPECT_TRUE(scene.shapes.at(1).in_group);
  EXPECT_EQ(scene.shapes.at(1).media.inside, 0);
  EXPECT_TRUE(std::holds_alternative<NullBsdfDesc>(
      scene.bsdfs.at(static_cast<std::size_t>(scene.shapes.at(1).bsdf)).kind));
  EXPECT_FALSE(scene.shapes.at(2).media.divides) << "the instance itself";
  EXPECT_FALSE(scene.shapes.at(3).media.divides) << "after ObjectEnd";
}

TEST(PbrtMediumInterface, CameraIsInTheOuterOne) {
  const std::string head =
      kFog + "MediumInterface \"\" \"fog\"\nCamera \"perspective\"\nMediumInterface \"\" \"\"\n";
  const SceneDesc scene = pbrt_world(kSphere, head);
  EXPECT_EQ(scene.sensors.at(0).medium, 0);
  EXPECT_FALSE(scene.shapes.at(0).media.divides);
  EXPECT_EQ(pbrt_world("", "Camera \"perspective\"").sensors.at(0).medium, kNone);
  // What holds before WorldBegin holds after it.
  const SceneDesc all = pbrt_world(kSphere, kFog + "MediumInterface \"\" \"fog\"\nCamera \"perspective\"\n");
  EXPECT_TRUE(all.shapes.at(0).media.divides);
  EXPECT_EQ(all.shapes.at(0).media.outside, 0);
}

TEST(PbrtMediumInterface, LampsKeepTheirSides) {
  const SceneDesc scene =
      pbrt_world(kFog + medium_text("haze", "\"homogeneous\"") +
                 "MediumInterface \"fog\" \"haze\"\nAreaLightSource \"diffuse\" \"bool twosided\" "
                 "true\n" +
                 kSphere);
  ASSERT_EQ(scene.shapes.size(), 2u);
  // The back is turned round.
  EXPECT_EQ(scene.shapes[0].media.inside, 0);
  EXPECT_EQ(scene.shapes[0].media.outside, 1);
  EXPECT_EQ(scene.shapes[1].media.inside, 1);
  EXPECT_EQ(scene.shapes[1].media.outside, 0);
  const SceneDesc lit = pbrt_world(kFog + "MediumInterface \"\" \"fog\"\nLightSource \"point\"\n");
  EXPECT_EQ(lit.emitters.size(), 1u);
  EXPECT_TRUE(lit.warnings.empty());
}

TEST(PbrtMediumInterface, HairOfOtherMediaIsAnotherShape) {
  const std::string curve = "Shape \"curve\" \"point3 P\" [ 0 0 0 1 0 0 2 0 0 3 1 1 ]\n";
  const SceneDesc scene = pbrt_world(kFog + curve + curve + "MediumInterface \"fog\" \"\"\n" + curve +
                                     "MediumInterface \"\" \"fog\"\n" + curve);
  EXPECT_EQ(scene.shapes.size(), 3u);
}

}  // namespace
}  // namespace lumirank::scenedesc
