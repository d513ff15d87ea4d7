// Scenes of pbrt-v3, which end with WorldEnd.
#include <cmath>

#include "base/bounds.h"
#include "scenedesc/pbrt_scene.h"

namespace lumirank::scenedesc {
namespace {

SceneDesc old_world(const std::string& world, const std::string& head = "") {
  return pbrt_world(world + "\nWorldEnd\n", head);
}
SceneDesc old_material(const std::string& material, const std::string& before = "") {
  return old_world(before + "Material " + material + "\n" + kSphere);
}
template <typename Kind>
Kind old_light(const std::string& text) {
  const SceneDesc scene = old_world("LightSource " + text);
  EXPECT_TRUE(scene.warnings.empty()) << describe(scene);
  return std::get<Kind>(scene.emitters.at(0).kind);
}
float alpha_of(float roughness) {
  const float x = std::log(roughness);
  return 1.62142f + 0.819955f * x + 0.1734f * x * x + 0.0171201f * x * x * x + 0.000640711f * x * x * x * x;
}

TEST(PbrtVersion3, IsToldByItsEnd) {
  EXPECT_EQ(pbrt_world(kSphere).format, "pbrt-v4");
  EXPECT_EQ(old_world(kSphere).format, "pbrt-v3");
  EXPECT_EQ(old_world(kSphere + "AttributeBegin\nAttributeEnd").shapes.size(), 1u);
  EXPECT_EQ(pbrt_world(kSphere + "# WorldEnd\n").format, "pbrt-v4");
  // What comes after it is another scene, which is not read.
  EXPECT_EQ(pbrt_world(kSphere + "WorldEnd # of the first\nWorldBegin\nShape\n").shapes.size(), 1u);
  EXPECT_THROW(pbrt_world("AttributeBegin\n" + kSphere + "WorldEnd\n"), InputError);
}

TEST(PbrtVersion3, FilmFilterAndCamera) {
  const SceneDesc plain =
      old_world(kSphere, "Film \"image\" \"integer xresolution\" [ 30 ] \"integer yresolution\" 20");
  EXPECT_EQ(plain.sensors.at(0).film.width, 30);
  EXPECT_EQ(plain.sensors.at(0).film.filter.kind, FilterKind::box);
  EXPECT_EQ(plain.sensors.at(0).film.filter.radius, 0.5f);
  const SceneDesc wide = old_world(
      kSphere, "PixelFilter \"gaussian\" \"float alpha\" 8\nCamera \"perspective\" \"float halffov\" 20");
  EXPECT_TRUE(wide.warnings.empty()) << describe(wide);
  EXPECT_EQ(wide.sensors.at(0).film.filter.radius, 2);
  EXPECT_NEAR(wide.sensors.at(0).film.filter.stddev, 0.25f, 1e-6f);
  const SceneDesc named =
      old_world(kSphere, "PixelFilter \"triangle\" \"float xwidth\" 3 \"float ywidth\" 3");
  EXPECT_EQ(named.sensors.at(0).film.filter.radius, 3);
  // No exposure: what is open for long is as bright. The film's "scale" is all.
  const SceneDesc bright =
      old_world("LightSource \"point\" \"color I\" [ 1 2 3 ]\n" + kSphere,
                "Film \"image\" \"float scale\" 7\nCamera \"perspective\" \"float shutterclose\" .1");
  expect_near(std::get<PointLightDesc>(bright.emitters.at(0).kind).intensity, Rgb(7, 14, 21), 1e-5f);
}

TEST(PbrtVersion3, LightsAreScaledByColorsAndKeepTheirLuminance) {
  expect_near(old_light<PointLightDesc>("\"point\" \"rgb I\" [ 3 2 1 ] \"rgb scale\" [ 2 3 4 ]").intensity,
              Rgb(6, 6, 4), 1e-6f);
  EXPECT_NEAR(luminance(old_light<PointLightDesc>("\"point\" \"spectrum I\" [ 300 5 900 5 ]").intensity), 5,
              1e-2f);
  EXPECT_NEAR(luminance(old_light<PointLightDesc>("\"point\" \"blackbody I\" [ 3000 1.5 ]").intensity), 1.5f,
              1e-4f);
  expect_near(
      old_light<DirectionalLightDesc>("\"distant\" \"xyz L\" [ .9505 1 1.089 ] \"integer nsamples\" 4")
          .irradiance,
      Rgb(1), 2e-3f);
  expect_near(
      old_light<ConstantEnvironmentDesc>("\"infinite\" \"string mapname\" [ \"\" ] \"color L\" [ 1 2 3 ]")
          .radiance,
      Rgb(1, 2, 3), 1e-6f);
  EXPECT_EQ(old_light<SpotLightDesc>("\"spot\"").edge, SpotLightDesc::Edge::fourth_power);
  const SceneDesc lamp =
      old_world("AreaLightSource \"area\" \"color L\" [ 4 5 6 ] \"bool twosided\" \"false\"\n" + kSphere);
  expect_near(lamp.shapes.at(0).emitter->radiance.value, Rgb(4, 5, 6), 1e-6f);
}

TEST(PbrtVersion3, MaterialsThatReflect) {
  EXPECT_EQ(inner<DiffuseDesc>(old_material("\"matte\" \"color Kd\" [ .1 .2 1.3 ]")).reflectance.value,
            Rgb(.1f, .2f, 1));
  EXPECT_NEAR(inner<RoughDiffuseDesc>(old_material("\"matte\" \"float sigma\" 20")).alpha.value,
              20 * kPi / 180 * std::sqrt(2.0f), 1e-6f);
  const auto plastic =
      inner<PlasticDesc>(old_material("\"plastic\" \"color Ks\" [ .3 .3 .3 ] \"float roughness\" .05"));
  EXPECT_EQ(plastic.diffuse_reflectance.value, Rgb(0.25f));
  EXPECT_EQ(plastic.specular_reflectance.value, Rgb(0.3f));
  EXPECT_NEAR(plastic.alpha.value, alpha_of(0.05f), 1e-5f);
  const auto plain = inner<PlasticDesc>(
      old_material("\"plastic\" \"float roughness\" .05 \"bool remaproughness\" \"false\""));
  EXPECT_EQ(plain.alpha.value, 0.05f);
  const auto paint =
      inner<PlasticDesc>(old_material("\"substrate\" \"rgb Kd\" [ .4 .03 .03 ] \"rgb Ks\" [ .3 .3 .3 ]"));
  EXPECT_TRUE(paint.schlick);
  EXPECT_EQ(paint.specular_reflectance.value, Rgb(0.3f));
  // An index of 1 reflects nothing.
  EXPECT_EQ(inner<DiffuseDesc>(old_material("\"uber\" \"float index\" 1")).reflectance.value, Rgb(0.25f));
  EXPECT_EQ(inner<ConductorDesc>(old_material("\"mirror\"")).specular_reflectance.value, Rgb(0.9f));
  const auto metal = inner<ConductorDesc>(
      old_material("\"metal\" \"spectrum eta\" \"spds/Au.eta.spd\" \"spectrum k\" \"spds/Au.k.spd\""));
  const auto gold = inner<ConductorDesc>(
      pbrt_material("\"conductor\" \"spectrum eta\" \"metal-Au-eta\" \"spectrum k\" \"metal-Au-k\""));
  EXPECT_EQ(metal.k, gold.k);
  EXPECT_NEAR(metal.alpha_u.value, alpha_of(0.01f), 1e-5f);
}

TEST(PbrtVersion3, MaterialsThatTransmit) {
  const auto smooth =
      inner<DielectricDesc>(old_material("\"glass\" \"float index\" 1.3 \"color Kr\" [ .5 .5 .5 ]"));
  EXPECT_EQ(smooth.eta, 1.3f);
  EXPECT_EQ(smooth.alpha_u.value, 0);
  EXPECT_EQ(smooth.specular_reflectance.value, Rgb(0.5f));
  const auto rough =
      inner<DielectricDesc>(old_material("\"glass\" \"float uroughness\" .2 \"float vroughness\" .2"));
  EXPECT_NEAR(rough.alpha_v.value, alpha_of(0.2f), 1e-5f);
  const auto leaf = inner<DiffuseTransmitterDesc>(
      old_material("\"translucent\" \"color Kd\" [ .4 .8 .2 ] \"color transmit\" [ .25 .25 .25 ]"));
  expect_near(leaf.reflectance.value, Rgb(.2f, .4f, .1f), 1e-6f);
  expect_near(leaf.transmittance.value, Rgb(.1f, .2f, .05f), 1e-6f);
  const auto clear =
      inner<DielectricDesc>(old_material("\"uber\" \"color Kd\" [ 0 0 0 ] \"color Ks\" [ 0 0 0 ] \"color "
                                         "Kr\" [ 1 1 1 ] \"color Kt\" [ .9 .8 .7 ]"));
  EXPECT_EQ(clear.specular_transmittance.value, Rgb(.9f, .8f, .7f));
  EXPECT_NEAR(inner<MaskDesc>(old_material("\"uber\" \"color opacity\" [ .3 .3 .3 ]")).opacity.value, 0.3f,
              1e-6f);
  EXPECT_TRUE(std::holds_alternative<NullBsdfDesc>(old_material("\"none\"").bsdfs.at(0).kind));
}

TEST(PbrtVersion3, WhatIsMattAndLetsLightThroughHasTheColorsOfBoth) {
  const SceneDesc scene =
      old_material("\"uber\" \"color Kd\" [ .2 .2 .1 ] \"color Ks\" [ 0 0 0 ] \"color Kt\" [ .4 .4 .4 ]");
  const auto& mixture = inner<MixtureDesc>(scene);
  ASSERT_EQ(mixture.parts.size(), 2u);
  const float share = mixture.parts[0].weight.value;
  EXPECT_FALSE(mixture.parts[0].complement);
  EXPECT_TRUE(mixture.parts[1].complement);
  EXPECT_EQ(mixture.parts[1].weight.value, share);
  const auto& glass =
      std::get<DielectricDesc>(scene.bsdfs.at(static_cast<std::size_t>(mixture.parts[0].bsdf)).kind);
  expect_near(glass.specular_transmittance.value * share, Rgb(.4f), 1e-6f);
  const auto& two =
      std::get<TwoSidedDesc>(scene.bsdfs.at(static_cast<std::size_t>(mixture.parts[1].bsdf)).kind);
  const auto& matt = std::get<DiffuseDesc>(scene.bsdfs.at(static_cast<std::size_t>(two.front)).kind);
  expect_near(matt.reflectance.value * (1 - share), Rgb(.2f, .2f, .1f), 1e-6f);
}

TEST(PbrtVersion3, MixturesCountTheAmountOfTheFirst) {
  const SceneDesc scene = old_material(
      "\"mix\" \"string namedmaterial1\" \"a\" \"string namedmaterial2\" \"b\" \"rgb amount\" [ .2 .2 .2 ]",
      "MakeNamedMaterial \"a\" \"string type\" \"matte\"\n"
      "MakeNamedMaterial \"b\" \"string type\" \"mirror\"\n");
  const auto& mixture = inner<MixtureDesc>(scene);
  for (const auto& part : mixture.parts) {
    const float weight = part.complement ? 1 - part.weight.value : part.weight.value;
    EXPECT_NEAR(weight, scene.bsdfs.at(static_cast<std::size_t>(part.bsdf)).id == "a" ? 0.2f : 0.8f, 1e-6f);
  }
}

TEST(PbrtVersion3, NamesMayBeGivenAgain) {
  const SceneDesc scene = old_world(
      "MakeNamedMaterial \"m\" \"string type\" \"matte\" \"rgb Kd\" [ .1 .1 .1 ]\nNamedMaterial \"m\"\n" +
      kSphere +
      "MakeNamedMaterial \"m\" \"string type\" \"matte\" \"rgb Kd\" [ .9 .9 .9 ]\nNamedMaterial \"m\"\n" +
      kSphere +
      "Texture \"t\" \"color\" \"constant\" \"rgb value\" [ .2 .2 .2 ]\nTexture \"t\" \"color\" \"constant\" "
      "\"rgb value\" [ .3 .3 .3 ]\n"
      "Material \"matte\" \"texture Kd\" \"t\"\n" +
      kSphere);
  EXPECT_EQ(inner<DiffuseDesc>(scene, 0).reflectance.value, Rgb(0.1f));
  EXPECT_EQ(inner<DiffuseDesc>(scene, 1).reflectance.value, Rgb(0.9f));
  EXPECT_EQ(inner<DiffuseDesc>(scene, 2).reflectance.value, Rgb(0.3f));
}

TEST(PbrtVersion3, ShapesThatPbrtHasNoMore) {
  const auto extent = [](const std::string& text) {
    const SceneDesc scene = old_world("Shape " + text);
    EXPECT_TRUE(scene.warnings.empty()) << describe(scene);
    Bounds3f box;
    for (const Vec3f& p : shape<InlineMeshDesc>(scene).mesh->positions) box.extend(p);
    return box;
  };
  const Bounds3f cone = extent("\"cone\" \"float radius\" 2 \"float height\" 3");
  EXPECT_NEAR(cone.lo.x, -2, 1e-5f);
  EXPECT_NEAR(cone.hi.z, 3, 1e-5f);
  const Bounds3f bowl = extent("\"paraboloid\" \"float radius\" 2 \"float zmax\" 4 \"float phimax\" 90");
  EXPECT_NEAR(bowl.lo.x, 0, 1e-5f);
  EXPECT_NEAR(bowl.hi.x, 2, 1e-5f);
  EXPECT_NEAR(bowl.hi.z, 4, 1e-5f);
  const Bounds3f waist = extent("\"hyperboloid\" \"point p1\" [ 1 0 -1 ] \"point p2\" [ 0 1 1 ]");
  EXPECT_NEAR(waist.hi.x, 1, 1e-3f);
  EXPECT_NEAR(waist.lo.z, -1, 1e-5f);
  const Bounds3f land =
      extent("\"heightfield\" \"integer nu\" 3 \"integer nv\" 2 \"float Pz\" [ 0 1 2 3 4 5 ]");
  EXPECT_EQ(land.hi.x, 1);
  EXPECT_EQ(land.hi.z, 5);
  EXPECT_EQ(only_warning(old_world(kSphere + "Shape \"nurbs\" \"integer nu\" 4")).used_instead, "");
}

TEST(PbrtVersion3, NormalsOfWhatIsTurnedPointOneWay) {
  const SceneDesc scene = old_world("Shape \"cone\"");
  const MeshData& cone = *shape<InlineMeshDesc>(scene).mesh;
  // Outwards and up, by the slope of a cone as high as wide.
  for (std::size_t k = 0; k < cone.positions.size(); ++k) {
    EXPECT_NEAR(cone.normals[k].z, std::sqrt(0.5f), 1e-3f) << k;
    const Vec3f p = cone.positions[k];
    EXPECT_GE(dot(cone.normals[k], Vec3f{p.x, p.y, 0}), -1e-6f) << k;
  }
}

TEST(PbrtVersion3, TextureCoordinatesAreNumbers) {
  const SceneDesc scene = old_world(
      "Shape \"trianglemesh\" \"point P\" [ 0 0 0 1 0 0 0 1 0 ] \"float st\" [ 0 0 5 0 0 5 ] \"integer "
      "indices\" [ 0 1 2 ]");
  EXPECT_TRUE(scene.warnings.empty()) << describe(scene);
  EXPECT_EQ(shape<InlineMeshDesc>(scene).mesh->uvs.at(1), (Vec2f{5, 0}));
}

TEST(PbrtVersion3, ProductsAndGammaOfTextures) {
  const SceneDesc scene =
      old_material("\"matte\" \"texture Kd\" \"p\"",
                   "Texture \"c\" \"color\" \"checkerboard\" \"string aamode\" \"none\"\n"
                   "Texture \"p\" \"color\" \"scale\" \"texture tex1\" \"c\" \"color tex2\" [ .5 .25 1 ]\n");
  EXPECT_TRUE(scene.warnings.empty()) << describe(scene);
  const auto& scaled = std::get<ScaleTextureDesc>(
      scene.textures.at(static_cast<std::size_t>(inner<DiffuseDesc>(scene).reflectance.texture)).kind);
  EXPECT_EQ(scaled.scale, Rgb(.5f, .25f, 1));
}

TEST(PbrtVersion3, MediaOfWhichNothingIsStated) {
  const SceneDesc scene = old_world(
      "MakeNamedMedium \"m\" \"string type\" \"homogeneous\"\nMediumInterface \"m\" \"\"\n" + kSphere);
  expect_near(scene.media.at(0).scattering.value, Rgb(2.55f, 3.21f, 3.77f), 1e-5f);
  const SceneDesc smoke = old_world(
      "MakeNamedMedium \"s\" \"string type\" \"heterogeneous\" \"integer nx\" 1 \"integer ny\" 1 \"integer "
      "nz\" 2 \"float density\" [ 1 2 ]\n"
      "MediumInterface \"s\" \"\"\n" +
      kSphere);
  EXPECT_EQ(smoke.volumes.size(), 1u);
}

TEST(PbrtVersion3, WhatItDoesNotKnowIsSaid) {
  EXPECT_THROW(old_material("\"diffuse\""), InputError);  // of pbrt-v4
  EXPECT_THROW(old_world("Shape \"cone\" \"float radius\" -1"), InputError);
  EXPECT_THROW(old_world("Shape \"heightfield\" \"integer nu\" 3 \"integer nv\" 2 \"float Pz\" [ 0 1 ]"),
               InputError);
  EXPECT_THROW(pbrt_world("Shape \"cone\"\n"), InputError);
  EXPECT_THROW(pbrt_world("LightSource \"point\" \"color I\" [ 1 1 1 ]\n"), InputError);
}

}  // namespace
}  // namespace lumirank::scenedesc
