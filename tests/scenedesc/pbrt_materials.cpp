// Materials, textures and spectra of pbrt scenes.
#include <cmath>
#include <fstream>

#include "scenedesc/pbrt_scene.h"
#include "scenedesc/schema/hair.h"

namespace lumirank::scenedesc {
namespace {

TEST(PbrtMaterial, DiffuseIsTwoSided) {
  const SceneDesc scene = pbrt_material("\"diffuse\" \"rgb reflectance\" [ .1 .2 .3 ]");
  EXPECT_TRUE(std::holds_alternative<TwoSidedDesc>(
      scene.bsdfs.at(static_cast<std::size_t>(scene.shapes.at(0).bsdf)).kind));
  EXPECT_EQ(inner<DiffuseDesc>(scene).reflectance.value, Rgb(.1f, .2f, .3f));
}

TEST(PbrtMaterial, RoughnessIsTheSquareOfTheWidthUnlessSaidOtherwise) {
  const auto alpha = [](const std::string& parameters) {
    const SceneDesc scene = pbrt_material("\"dielectric\" " + parameters);
    const auto& d = inner<DielectricDesc>(scene);
    EXPECT_EQ(d.distribution, Distribution::ggx);
    return Vec2f{d.alpha_u.value, d.alpha_v.value};
  };
  EXPECT_EQ(alpha(""), (Vec2f{0, 0}));
  EXPECT_EQ(alpha("\"float roughness\" 0.25"), (Vec2f{0.5f, 0.5f}));
  EXPECT_EQ(alpha("\"float roughness\" 0.25 \"bool remaproughness\" false"), (Vec2f{0.25f, 0.25f}));
  EXPECT_EQ(alpha("\"float uroughness\" 0.04 \"float vroughness\" 0.16"), (Vec2f{0.2f, 0.4f}));
  EXPECT_EQ(alpha("\"float roughness\" 0.01 \"float vroughness\" 0.16"), (Vec2f{0.1f, 0.4f}));
  EXPECT_EQ(alpha("\"float roughness\" 0.0009 \"bool remaproughness\" false"),
            (Vec2f{0, 0}));  // smooth for pbrt
}

TEST(PbrtMaterial, TexturedRoughnessIsRemappedPointByPoint) {
  const std::string texture = "Texture \"r\" \"float\" \"checkerboard\"\n";
  const SceneDesc scene = pbrt_material("\"dielectric\" \"texture roughness\" \"r\"", texture);
  const auto& d = inner<DielectricDesc>(scene);
  EXPECT_EQ(d.alpha_u.texture, d.alpha_v.texture);
  const auto& root =
      std::get<RootTextureDesc>(scene.textures.at(static_cast<std::size_t>(d.alpha_u.texture)).kind);
  EXPECT_EQ(scene.textures.at(static_cast<std::size_t>(root.input.texture)).id, "r");
}

TEST(PbrtMaterial, HairIsThatOfItsAbsorption) {
  const auto expect = [](const std::string& parameters, Rgb sigma_a, float eta, float beta_m, float beta_n,
                         float tilt) {
    const SceneDesc scene = pbrt_material("\"hair\" " + parameters);
    EXPECT_TRUE(scene.warnings.empty()) << parameters;
    const auto& got = inner<HairFiberDesc>(scene);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(got.sigma_a[c], sigma_a[c], 1e-6f) << parameters;
    EXPECT_EQ(got.eta, eta);
    EXPECT_EQ(got.beta_m, beta_m);
    EXPECT_EQ(got.beta_n, beta_n);
    EXPECT_EQ(got.tilt, tilt);
  };
  // Brown by default, as pbrt's.
  expect("", hair_absorption(1.3f, 0), 1.55f, 0.3f, 0.3f, 2);
  expect("\"float pheomelanin\" 0.7 \"float alpha\" 3", hair_absorption(0, 0.7f), 1.55f, 0.3f, 0.3f, 3);
  expect("\"rgb sigma_a\" [ .1 .5 2 ] \"float eta\" 1.4 \"float beta_m\" 0.2 \"float beta_n\" 0.4",
         Rgb(.1f, .5f, 2), 1.4f, 0.2f, 0.4f, 2);
  // Chiang et al. 2016, section 4.2, at β_n = 0.5: the width is 5.969 - 0.1075 + 0.633 - 1.34125 + 0.348375 +
  // 0.00765625 = 5.50928.
  const float w = std::log(0.25f) / 5.50928f;
  expect("\"rgb reflectance\" [ .25 .25 .25 ] \"float beta_n\" 0.5", Rgb(w * w), 1.55f, 0.3f, 0.5f, 2);
  for (const char* bad : {"\"float beta_m\" 1.5", "\"float beta_n\" -0.1", "\"float alpha\" 21",
                          "\"rgb sigma_a\" [ -1 0 0 ]", "\"float eta\" 0"})
    EXPECT_THROW(pbrt_material(std::string("\"hair\" ") + bad), InputError) << bad;
}

TEST(PbrtMaterial, HairOfATexturedColorIsKajiyaKay) {
  const SceneDesc scene = pbrt_material("\"hair\" \"texture color\" \"t\" \"float beta_m\" 0.2",
                                        "Texture \"t\" \"spectrum\" \"checkerboard\"\n");
  EXPECT_NE(only_warning(scene).what.find("hair"), std::string::npos);
  const auto& got = inner<HairDesc>(scene);
  const auto texture = static_cast<std::size_t>(got.diffuse_reflectance.texture);
  EXPECT_EQ(scene.textures.at(texture).id, "t");
  EXPECT_EQ(got.exponent.value, hair_from_absorption(Rgb(0), 1.55f, 0.2f).exponent.value);
}

// What a thick body of the medium sends back.
TEST(PbrtMaterial, SubsurfaceScatteringHasTheColorOfDepth) {
  const auto color = [](const std::string& parameters) {
    const SceneDesc scene = pbrt_material("\"subsurface\" " + parameters);
    EXPECT_NE(only_warning(scene).what.find("subsurface"), std::string::npos) << parameters;
    return inner<PlasticDesc>(scene).diffuse_reflectance.value;
  };
  EXPECT_EQ(color("\"rgb reflectance\" [ .2 .4 .6 ] \"rgb mfp\" [ 1 2 3 ]"), Rgb(.2f, .4f, .6f));
  // Half of all that meets the medium is absorbed: s = √½, (1 - s)(1 - 0.139s)/(1 + 1.17s) = 0.1445; and of
  // isotropic scattering without absorption everything comes back.
  const Rgb half = color("\"rgb sigma_a\" [ 1 0 3 ] \"rgb sigma_s\" [ 1 2 0 ]");
  EXPECT_NEAR(half.r, 0.1445f, 1e-3f);
  EXPECT_EQ(half.g, 1);
  EXPECT_EQ(half.b, 0);
  // Forward scattering goes in deeper: g = 1/2 at albedo 2/3 is isotropic scattering of half.
  const Rgb forward = color("\"rgb sigma_a\" [ 1 1 1 ] \"rgb sigma_s\" [ 2 2 2 ] \"float g\" 0.5");
  EXPECT_NEAR(forward.r, half.r, 1e-5f);
  const Rgb skin = color("\"string name\" \"Skin1\" \"float scale\" 50");
  EXPECT_GT(skin.r, skin.g);
  EXPECT_GT(skin.g, skin.b);
  EXPECT_EQ(color(""), color("\"string name\" \"Wholemilk\""));
  EXPECT_EQ(pbrt_material("\"subsurface\" \"string name\" \"Nothing\"").warnings.size(), 2u);
}

TEST(PbrtMaterial, Dielectrics) {
  EXPECT_EQ(inner<DielectricDesc>(pbrt_material("\"dielectric\"")).eta, 1.5f);
  EXPECT_EQ(inner<DielectricDesc>(pbrt_material("\"dielectric\" \"float eta\" 1.33")).eta, 1.33f);
  const SceneDesc glass = pbrt_material("\"dielectric\" \"spectrum eta\" \"glass-BK7\"");
  EXPECT_EQ(inner<DielectricDesc>(glass).eta, 1.5168f);
  EXPECT_NE(only_warning(glass).what.find("dispersion"), std::string::npos);
  // 1.6 at 500 nm and 1.5 at 700 nm: at 587.6 nm 1.6 - 0.1 · 87.6/200.
  const SceneDesc list = pbrt_material("\"dielectric\" \"spectrum eta\" [ 500 1.6 700 1.5 ]");
  EXPECT_FLOAT_EQ(inner<DielectricDesc>(list).eta, 1.5562f);
  EXPECT_EQ(inner<ThinDielectricDesc>(pbrt_material("\"thindielectric\" \"float eta\" 1.7")).eta, 1.7f);
}

TEST(PbrtMaterial, ConductorOfAColorHasThatReflectanceAtNormalIncidence) {
  const SceneDesc scene = pbrt_material("\"conductor\" \"rgb reflectance\" [ .9 .5 .2 ]");
  const auto& c = inner<ConductorDesc>(scene);
  const float want[] = {.9f, .5f, .2f};
  for (int i = 0; i < 3; ++i) {
    const float n = c.eta[i], k = c.k[i];
    EXPECT_NEAR(((n - 1) * (n - 1) + k * k) / ((n + 1) * (n + 1) + k * k), want[i], 1e-5f);
  }
}

TEST(PbrtMaterial, ConductorsByColorsAndByNames) {
  const SceneDesc by_numbers = pbrt_material("\"conductor\" \"rgb eta\" [ 1.6 .9 .5 ] \"rgb k\" [ 9 6 4 ]");
  const auto& rgb = inner<ConductorDesc>(by_numbers);
  EXPECT_EQ(rgb.eta, Rgb(1.6f, .9f, .5f));
  EXPECT_EQ(rgb.k, Rgb(9, 6, 4));
  // Reflectance of copper under D65: reddish, of gold more so in the blue, of silver white.
  const auto reflectance = [](const std::string& material) {
    const SceneDesc scene = pbrt_material(material);
    EXPECT_TRUE(scene.warnings.empty());
    const auto& c = inner<ConductorDesc>(scene);
    Rgb r;
    for (int i = 0; i < 3; ++i)
      r[i] = (lumirank::square(c.eta[i] - 1) + lumirank::square(c.k[i])) /
             (lumirank::square(c.eta[i] + 1) + lumirank::square(c.k[i]));
    return r;
  };
  const Rgb copper = reflectance("\"conductor\"");
  EXPECT_EQ(copper,
            reflectance("\"conductor\" \"spectrum eta\" \"metal-Cu-eta\" \"spectrum k\" \"metal-Cu-k\""));
  EXPECT_GT(copper.r, copper.g + 0.2f);
  EXPECT_GT(copper.g, copper.b);
  const Rgb silver =
      reflectance("\"conductor\" \"spectrum eta\" \"metal-Ag-eta\" \"spectrum k\" \"metal-Ag-k\"");
  for (int i = 0; i < 3; ++i) EXPECT_GT(silver[i], 0.9f);
  // A metal of constant n = 1, k = 2: k²/(4 + k²) = ½ at all wavelengths, so ½ in all channels.
  expect_near(reflectance("\"conductor\" \"spectrum eta\" [ 300 1 900 1 ] \"spectrum k\" [ 300 2 900 2 ]"),
              Rgb(0.5f), 1e-5f);
}

TEST(PbrtMaterial, Coatings) {
  const SceneDesc scene = pbrt_material(
      "\"coateddiffuse\" \"rgb reflectance\" [ .1 .2 .3 ] \"float roughness\" 0.04 \"float eta\" 1.6 "
      "\"float thickness\" 0.1 \"integer maxdepth\" 20 \"integer nsamples\" 2 \"float g\" 0.1");
  EXPECT_TRUE(scene.warnings.empty());
  const auto& layer = inner<CoatingDesc>(scene);
  EXPECT_EQ(layer.eta, 1.6f);
  EXPECT_EQ(layer.alpha_u.value, 0.2f);
  EXPECT_EQ(
      std::get<DiffuseDesc>(scene.bsdfs.at(static_cast<std::size_t>(layer.nested)).kind).reflectance.value,
      Rgb(.1f, .2f, .3f));
  const SceneDesc metal = pbrt_material(
      "\"coatedconductor\" \"rgb conductor.eta\" [ 3 3 3 ] \"rgb conductor.k\" [ 6 6 6 ] \"float "
      "interface.eta\" 1.5 "
      "\"float conductor.roughness\" 0.01 \"float interface.roughness\" 0.09");
  EXPECT_TRUE(metal.warnings.empty());
  const auto& over = inner<CoatingDesc>(metal);
  EXPECT_FLOAT_EQ(over.alpha_u.value, 0.3f);
  const auto& under = std::get<ConductorDesc>(metal.bsdfs.at(static_cast<std::size_t>(over.nested)).kind);
  EXPECT_FLOAT_EQ(under.eta.r, 2);  // relative to the layer
  EXPECT_FLOAT_EQ(under.k.r, 4);
  EXPECT_FLOAT_EQ(under.alpha_u.value, 0.1f);
  EXPECT_EQ(pbrt_material("\"coateddiffuse\" \"rgb albedo\" [ .5 .5 .5 ]").warnings.size(), 1u);
}

TEST(PbrtMaterial, MixWeighsItsSecondByTheAmount) {
  const SceneDesc scene =
      pbrt_material("\"mix\" \"string materials\" [ \"a\" \"b\" ] \"float amount\" 0.3",
                    "MakeNamedMaterial \"b\" \"string type\" \"dielectric\"\nMakeNamedMaterial \"a\" "
                    "\"string type\" \"diffuse\"\n");
  const auto& mix = inner<MixtureDesc>(scene);
  ASSERT_EQ(mix.parts.size(), 2u);
  EXPECT_TRUE(mix.parts[0].complement);
  EXPECT_FALSE(mix.parts[1].complement);
  EXPECT_EQ(mix.parts[1].weight.value, 0.3f);
  EXPECT_TRUE(std::holds_alternative<DielectricDesc>(
      scene.bsdfs.at(static_cast<std::size_t>(mix.parts[1].bsdf)).kind));
}

TEST(PbrtMaterial, NamesMayBeUsedBeforeTheirDefinition) {
  const SceneDesc scene = pbrt_world(
      "NamedMaterial \"late\"\nShape \"sphere\"\nMakeNamedMaterial \"late\" \"string type\" "
      "\"thindielectric\"\n");
  EXPECT_NO_THROW(inner<ThinDielectricDesc>(scene));
}

TEST(PbrtMaterial, InterfaceIsNothing) {
  for (const char* type : {"\"interface\"", "\"none\"", "\"\""})
    EXPECT_NO_THROW(inner<NullBsdfDesc>(pbrt_material(type))) << type;
}

TEST(PbrtMaterial, DiffuseTransmission) {
  const SceneDesc scene = pbrt_material(
      "\"diffusetransmission\" \"rgb reflectance\" [ .4 .4 .4 ] \"rgb transmittance\" [ .6 .5 .4 ] \"float "
      "scale\" "
      "0.5");
  const auto& sheet = inner<DiffuseTransmitterDesc>(scene);
  EXPECT_EQ(sheet.reflectance.value, Rgb(0.2f));
  EXPECT_EQ(sheet.transmittance.value, Rgb(0.3f, 0.25f, 0.2f));
  EXPECT_TRUE(scene.warnings.empty());
  const SceneDesc usual = pbrt_material("\"diffusetransmission\"");
  EXPECT_EQ(inner<DiffuseTransmitterDesc>(usual).reflectance.value, Rgb(0.25f));
  EXPECT_EQ(inner<DiffuseTransmitterDesc>(usual).transmittance.value, Rgb(0.25f));
}

TEST(PbrtMaterial, NormalMapsAndDisplacement) {
  const std::string picture = testing::TempDir() + "bumps.png";
  std::ofstream(picture) << "only its name matters here";
  const SceneDesc scene = pbrt_material("\"diffuse\" \"string normalmap\" \"bumps.png\"");
  const auto& map = inner<NormalMapDesc>(scene);
  const auto& bitmap =
      std::get<BitmapTextureDesc>(scene.textures.at(static_cast<std::size_t>(map.texture)).kind);
  EXPECT_EQ(bitmap.filename, picture);
  EXPECT_TRUE(bitmap.raw);
  const SceneDesc bump =
      pbrt_material("\"diffuse\" \"texture displacement\" \"d\"",
                    "Texture \"d\" \"float\" \"imagemap\" \"string filename\" \"bumps.png\"\n");
  EXPECT_EQ(inner<BumpMapDesc>(bump).scale, 1);
}

TEST(PbrtTexture, ImageMap) {
  std::ofstream(testing::TempDir() + "picture.png") << "only its name matters here";
  const auto texture = [](const std::string& parameters) {
    const SceneDesc scene = pbrt_world(
        "Texture \"t\" \"spectrum\" \"imagemap\" \"string filename\" \"picture.png\" " + parameters);
    return std::get<BitmapTextureDesc>(scene.textures.at(0).kind);
  };
  const BitmapTextureDesc plain = texture("");
  EXPECT_FALSE(plain.raw);
  EXPECT_EQ(plain.filter, FilterMode::bilinear);
  EXPECT_EQ(plain.to_uv, UvTransform{});
  EXPECT_EQ(plain.channel, TextureChannel::rgb);
  EXPECT_EQ(texture("\"string filter\" \"point\"").filter, FilterMode::nearest);
  EXPECT_EQ(texture("\"string wrap\" \"clamp\"").wrap_v, WrapMode::clamp);
  EXPECT_TRUE(texture("\"string encoding\" \"linear\"").raw);
  const UvTransform moved{{2, 0, .25f, 0, 3, .5f}};
  EXPECT_EQ(texture("\"float uscale\" 2 \"float vscale\" 3 \"float udelta\" .25 \"float vdelta\" .5").to_uv,
            moved);
}

TEST(PbrtTexture, ScaleAndInvertOfPictures) {
  std::ofstream(testing::TempDir() + "picture.png") << "only its name matters here";
  const SceneDesc scene = pbrt_material("\"diffuse\" \"texture reflectance\" \"t\"",
                                        "Texture \"t\" \"spectrum\" \"imagemap\" \"string filename\" "
                                        "\"picture.png\" \"float scale\" 0.5 \"bool invert\" true\n");
  const auto at = [&](int index) { return scene.textures.at(static_cast<std::size_t>(index)).kind; };
  // 1 - ½ picture = the mix of 1 and 0 by ½ picture.
  const auto mix = std::get<MixTextureDesc>(at(inner<DiffuseDesc>(scene).reflectance.texture));
  EXPECT_EQ(mix.a.value, Rgb(1));
  EXPECT_EQ(mix.b.value, Rgb(0));
  const auto scale = std::get<ScaleTextureDesc>(at(mix.amount.texture));
  EXPECT_EQ(scale.scale, Rgb(0.5f));
  EXPECT_TRUE(std::holds_alternative<BitmapTextureDesc>(at(scale.input.texture)));
}

TEST(PbrtTexture, ConstantsAreFolded) {
  const SceneDesc scene =
      pbrt_material("\"diffuse\" \"texture reflectance\" \"m\"",
                    "Texture \"a\" \"spectrum\" \"constant\" \"rgb value\" [ .2 .4 .6 ]\n"
                    "Texture \"s\" \"spectrum\" \"scale\" \"texture tex\" \"a\" \"rgb scale\" [ .5 .5 .5 ]\n"
                    "Texture \"m\" \"spectrum\" \"mix\" \"texture tex1\" \"s\" \"rgb tex2\" [ 1 1 1 ] "
                    "\"float amount\" 0.25\n");
  EXPECT_TRUE(scene.textures.empty());
  // ¾ · ½ (.2, .4, .6) + ¼
  expect_near(inner<DiffuseDesc>(scene).reflectance.value, Rgb(.325f, .4f, .475f), 1e-6f);
}

TEST(PbrtTexture, FieldsOfACheckerboardAreOneUnitWide) {
  const SceneDesc scene = pbrt_world(
      "Texture \"t\" \"spectrum\" \"checkerboard\" \"float uscale\" 8 \"float vscale\" 4 \"rgb tex1\" [ .1 "
      ".1 .1 ]\n");
  const auto& board = std::get<CheckerboardTextureDesc>(scene.textures.at(0).kind);
  // Lumirank's pattern has two fields in a unit.
  EXPECT_EQ(board.to_uv, (UvTransform{{4, 0, 0, 0, 2, 0}}));
  EXPECT_EQ(board.color0.value, Rgb(.1f));
  EXPECT_EQ(board.color1.value, Rgb(0));
}

TEST(PbrtTexture, AlphaOfAShapeCutsItOut) {
  std::ofstream(testing::TempDir() + "leaf.png") << "only its name matters here";
  const SceneDesc scene = pbrt_world(
      "Texture \"leaf\" \"float\" \"imagemap\" \"string filename\" \"leaf.png\"\n"
      "Shape \"sphere\" \"texture alpha\" \"leaf\"\nShape \"disk\" \"texture alpha\" \"leaf\"\nShape "
      "\"sphere\" \"float alpha\" 0.5\n");
  const auto& mask = inner<MaskDesc>(scene, 0);
  EXPECT_EQ(mask.opacity.texture, 0);
  EXPECT_EQ(std::get<BitmapTextureDesc>(scene.textures[0].kind).channel, TextureChannel::scalar);
  EXPECT_EQ(scene.shapes[0].bsdf, scene.shapes[1].bsdf);  // made once
  EXPECT_EQ(inner<MaskDesc>(scene, 2).opacity.value, 0.5f);
}

Rgb reflectance(const std::string& parameter) {
  return inner<DiffuseDesc>(pbrt_material("\"diffuse\" " + parameter)).reflectance.value;
}

TEST(PbrtSpectrum, Reflectances) {
  expect_near(reflectance("\"spectrum reflectance\" [ 300 0.4 900 0.4 ]"), Rgb(0.4f), 1e-5f);
  std::ofstream(testing::TempDir() + "gray.spd") << "# of paint\n300 0.7\n900 0.7\n";
  expect_near(reflectance("\"spectrum reflectance\" \"gray.spd\""), Rgb(0.7f), 1e-5f);
}

TEST(PbrtSpectrum, ColorSpaces) {
  const auto in = [](const char* space) {
    const SceneDesc scene =
        pbrt_world("ColorSpace \"" + std::string(space) +
                   "\" Material \"diffuse\" \"rgb reflectance\" [ .5 .5 .5 ] Shape \"sphere\"\n"
                   "LightSource \"point\" \"rgb I\" [ 0 .5 0 ]");
    return std::pair{inner<DiffuseDesc>(scene).reflectance.value,
                     std::get<PointLightDesc>(scene.emitters.at(0).kind).intensity};
  };
  // Grays are gray in every space; the green of BT.2020 lies outside of Rec. 709 and is cut there.
  for (const char* space : {"srgb", "dci-p3", "rec2020", "aces2065-1"})
    expect_near(in(space).first, Rgb(0.5f), 1e-5f);
  expect_near(in("rec2020").second, Rgb(0, 0.56645f, 0), 1e-5f);
}

}  // namespace
}  // namespace lumirank::scenedesc
