// Parameters, includes, warnings, defaults and conversions of the Mitsuba reader.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <string>

#include "scenedesc/data/ior.h"
#include "scenedesc/data/mitsuba_metals.h"
#include "scenedesc/mitsuba/solar.h"
#include "scenedesc/readers.h"
#include "scenedesc/writer/mitsuba_writer.h"

namespace lumirank::scenedesc {
namespace {

SceneDesc parse(const std::string& content, const char* version = "3.0.0", const ReadOptions& options = {}) {
  return parse_mitsuba("<scene version=\"" + std::string(version) + "\">\n" + content + "\n</scene>",
                       testing::TempDir() + "elements.xml", options);
}
const std::string kCamera = "<sensor type=\"perspective\"/>";

float radius(const SceneDesc& scene) { return std::get<SphereDesc>(scene.shapes.at(0).kind).radius; }

TEST(MitsubaParameters, DefinesWinOverDefaults) {
  const std::string text =
      kCamera +
      "<default name=\"r\" value=\"2\"/><shape type=\"sphere\"><float name=\"radius\" value=\"$r\"/></shape>";
  EXPECT_EQ(radius(parse(text)), 2);
  EXPECT_EQ(radius(parse(text, "3.0.0", {{{"r", "5"}}, false})), 5);
}

TEST(MitsubaEmitters, PicturesOfProjectorsAndSpots) {
  const std::string picture =
      "<texture type=\"checkerboard\" name=\"NAME\"/><transform name=\"to_world\"><translate x=\"3\"/>"
      "</transform></emitter>";
  const auto with_picture = [&](const std::string& emitter, const char* name) {
    std::string text = emitter + picture;
    text.replace(text.find("NAME"), 4, name);
    const SceneDesc scene = parse(kCamera + text);
    EXPECT_TRUE(scene.warnings.empty());
    return std::get<ProjectionLightDesc>(scene.emitters.at(0).kind);
  };
  const auto projector = with_picture(
      "<emitter type=\"projector\"><float name=\"fov\" value=\"30\"/><string name=\"fov_axis\" "
      "value=\"larger\"/><float name=\"scale\" value=\"4\"/>",
      "irradiance");
  EXPECT_EQ(projector.means, ProjectionLightDesc::Picture::irradiance);
  EXPECT_EQ(projector.fov, 30);
  EXPECT_EQ(projector.axis, FieldAxis::larger);
  EXPECT_EQ(projector.intensity, Rgb(4));
  EXPECT_EQ(projector.picture.texture, 0);
  EXPECT_EQ(projector.to_world.origin().x, 3);
  // Its +x is left and its +y up, where v is 0 at the top.
  EXPECT_EQ(projector.to_uv, (UvTransform{{-0.5f, 0, 0.5f, 0, -0.5f, 0.5f}}));
  const auto spot = with_picture(
      "<emitter type=\"spot\"><float name=\"cutoff_angle\" value=\"40\"/><rgb name=\"intensity\" "
      "value=\"1, 2, 3\"/>",
      "texture");
  EXPECT_EQ(spot.means, ProjectionLightDesc::Picture::intensity);
  EXPECT_EQ(spot.fov, 80);
  EXPECT_TRUE(spot.square);
  EXPECT_EQ(spot.cutoff_angle, 40);
  EXPECT_EQ(spot.beam_width, 30);
  EXPECT_EQ(spot.intensity, Rgb(1, 2, 3));
  EXPECT_EQ(spot.to_uv, (UvTransform{{0.5f, 0, 0.5f, 0, 0.5f, 0.5f}}));
  EXPECT_THROW(parse(kCamera + "<emitter type=\"projector\"><float name=\"fov\" value=\"180\"/></emitter>"),
               InputError);
  // A texture on a plane does not reach beyond a half-space.
  const SceneDesc wide = parse(kCamera +
                               "<emitter type=\"spot\"><float name=\"cutoff_angle\" value=\"95\"/><texture "
                               "type=\"checkerboard\" name=\"texture\"/></emitter>");
  EXPECT_EQ(wide.warnings.size(), 1u);
  EXPECT_TRUE(std::holds_alternative<SpotLightDesc>(wide.emitters.at(0).kind));
}

TEST(MitsubaEmitters, ADirectionalAreaIsDark) {
  const SceneDesc scene =
      parse(kCamera + "<shape type=\"rectangle\"><emitter type=\"directionalarea\"/></shape>");
  ASSERT_EQ(scene.warnings.size(), 1u);
  EXPECT_NE(scene.warnings[0].what.find("directionalarea"), std::string::npos);
  EXPECT_FALSE(scene.shapes.at(0).emitter);
}

TEST(MitsubaShapes, MergedOnesAreThoseInThem) {
  const std::string two =
      "<shape type=\"merge\"><shape type=\"sphere\" id=\"a\"/><shape type=\"cube\"/></shape>";
  const SceneDesc scene = parse(kCamera + two);
  EXPECT_TRUE(scene.warnings.empty());
  ASSERT_EQ(scene.shapes.size(), 2u);
  EXPECT_EQ(scene.shapes[0].id, "a");
  const SceneDesc grouped = parse(kCamera + "<shape type=\"shapegroup\" id=\"g\"><shape type=\"disk\"/>" +
                                  two + "</shape><shape type=\"instance\"><ref id=\"g\"/></shape>");
  EXPECT_TRUE(grouped.warnings.empty());
  ASSERT_EQ(grouped.shapes.size(), 5u);
  EXPECT_EQ(std::get<ShapeGroupDesc>(grouped.shapes[3].kind).shapes.size(), 3u);
}

TEST(MitsubaShapes, AMergedOneCannotHoldItself) {
  const std::string itself = "<shape type=\"merge\" id=\"m\"><shape type=\"sphere\"/><ref id=\"m\"/></shape>";
  EXPECT_THROW(parse(kCamera + itself), InputError);
  EXPECT_THROW(parse(kCamera + "<shape type=\"shapegroup\" id=\"g\">" + itself +
                     "</shape><shape type=\"instance\"><ref id=\"g\"/></shape>"),
               InputError);
}

TEST(MitsubaShapes, MergesThatDoubleHaveAnEnd) {
  std::string text = kCamera + "<shape type=\"merge\" id=\"m0\"/>";
  for (int k = 1; k < 40; ++k) {
    const std::string before = "<ref id=\"m" + std::to_string(k - 1) + "\"/>";
    text += "<shape type=\"merge\" id=\"m" + std::to_string(k) + "\">" + before + before + "</shape>";
  }
  EXPECT_THROW(parse(text), InputError);
}

TEST(MitsubaColors, TabulatedSpectraAreThoseOfPairs) {
  const auto radiance = [](const std::string& spectrum) {
    const SceneDesc scene =
        parse(kCamera + "<shape type=\"sphere\"><emitter type=\"area\">" + spectrum + "</emitter></shape>");
    EXPECT_TRUE(scene.warnings.empty());
    return scene.shapes.at(0).emitter->radiance.value;
  };
  const Rgb pairs = radiance("<spectrum name=\"radiance\" value=\"400:1, 500:2, 600:5, 700:9\"/>");
  EXPECT_EQ(pairs,
            radiance("<spectrum type=\"irregular\" name=\"radiance\"><string name=\"wavelengths\" "
                     "value=\"400, 500, 600, 700\"/><string name=\"values\" value=\"1 2 5 9\"/></spectrum>"));
  const std::string regular =
      "<spectrum type=\"regular\" name=\"radiance\"><float name=\"wavelength_min\" "
      "value=\"400\"/><float name=\"wavelength_max\" value=\"700\"/><string "
      "name=\"values\" value=\"VALUES\"/></spectrum>";
  const auto of = [&](const std::string& values) {
    std::string text = regular;
    return radiance(text.replace(text.find("VALUES"), 6, values));
  };
  EXPECT_EQ(pairs, of("1, 2, 5, 9"));
  EXPECT_THROW(of("1"), InputError);
  EXPECT_THROW(radiance("<spectrum type=\"irregular\" name=\"radiance\"><string name=\"wavelengths\" "
                        "value=\"400, 500\"/><string name=\"values\" value=\"1 2 5\"/></spectrum>"),
               InputError);
}

TEST(MitsubaBsdfs, PolarizedPlasticIsARoughOne) {
  const SceneDesc scene =
      parse(kCamera + "<bsdf type=\"pplastic\"><float name=\"alpha\" value=\"0.3\"/></bsdf>");
  EXPECT_TRUE(scene.warnings.empty());
  const auto& plastic = std::get<PlasticDesc>(scene.bsdfs.at(0).kind);
  EXPECT_EQ(plastic.alpha.value, 0.3f);
  EXPECT_EQ(parse(kCamera + "<bsdf type=\"pplastic\"><float name=\"alpha_u\" value=\"0.3\"/><float "
                            "name=\"alpha_v\" value=\"0.1\"/></bsdf>")
                .warnings.size(),
            1u);
}

TEST(MitsubaParameters, AnUnusedDefineIsNamed) {
  const SceneDesc scene = parse(kCamera, "3.0.0", {{{"nobody", "5"}}, false});
  ASSERT_EQ(scene.warnings.size(), 1u);
  EXPECT_NE(scene.warnings[0].what.find("\"nobody\""), std::string::npos);
}

TEST(MitsubaParameters, TheLongestKnownNameCounts) {
  const std::string text = kCamera +
                           "<default name=\"r\" value=\"9\"/><default name=\"ra\" value=\"1\"/>"
                           "<shape type=\"sphere\"><float name=\"radius\" value=\"$ra.5\"/></shape>"
                           "<shape type=\"sphere\"><float name=\"radius\" value=\"${r}1\"/></shape>";
  const SceneDesc scene = parse(text);
  EXPECT_EQ(radius(scene), 1.5f);
  EXPECT_EQ(std::get<SphereDesc>(scene.shapes[1].kind).radius, 91);
}

TEST(MitsubaInclude, NamesAreSharedAndLinesAreThoseOfTheOtherFile) {
  std::ofstream(testing::TempDir() + "inc.xml")
      << "<scene version=\"3.0.0\">\n\n<bsdf type=\"diffuse\" id=\"white\"/>\n<bsdf type=\"odd\"/></scene>";
  const SceneDesc scene =
      parse(kCamera + "<shape type=\"sphere\"><ref id=\"white\"/></shape><include filename=\"inc.xml\"/>");
  EXPECT_EQ(scene.bsdfs.at(static_cast<std::size_t>(scene.shapes.at(0).bsdf)).where.line, 3);
  ASSERT_EQ(scene.warnings.size(), 1u);
  EXPECT_EQ(scene.warnings[0].where.line, 4);
  EXPECT_EQ(scene.warnings[0].where.file, testing::TempDir() + "inc.xml");
}

TEST(MitsubaAlias, IsASecondName) {
  const SceneDesc scene = parse(kCamera +
                                "<bsdf type=\"diffuse\" id=\"a\"/><alias id=\"a\" as=\"b\"/><shape "
                                "type=\"sphere\"><ref id=\"b\"/></shape>");
  EXPECT_EQ(scene.bsdfs.size(), 1u);
  EXPECT_EQ(scene.shapes.at(0).bsdf, 0);
}

TEST(MitsubaWarnings, NameTheLineAndWhatIsUsedInstead) {
  const SceneDesc scene =
      parse(kCamera +
            "\n<shape type=\"heightfield\"/>\n<bsdf type=\"normalized\"/>\n<bsdf type=\"varnish\"><bsdf "
            "type=\"null\"/></bsdf>\n" +
            "<shape type=\"sphere\"><float name=\"raduis\" value=\"2\"/></shape>\n" +
            "<shape type=\"sphere\"><medium name=\"interior\" type=\"homogeneous\"/></shape>");
  ASSERT_EQ(scene.warnings.size(), 4u);
  const std::pair<int, const char*> expected[] = {{3, "shape \"heightfield\""},
                                                  {4, "BSDF \"normalized\""},
                                                  {5, "BSDF \"varnish\""},
                                                  {6, "did you mean \"radius\"?"}};
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(scene.warnings[i].where.line, expected[i].first);
    EXPECT_NE(scene.warnings[i].what.find(expected[i].second), std::string::npos) << scene.warnings[i].what;
  }
  EXPECT_EQ(scene.shapes.size(), 2u);
}

TEST(MitsubaWarnings, StrictMakesTheFirstAnError) {
  try {
    parse(kCamera + "\n<shape type=\"heightfield\"/>", "3.0.0", {{}, true});
    FAIL();
  } catch (const InputError& error) {
    EXPECT_EQ(error.where().line, 3);
    EXPECT_NE(std::string(error.what()).find("\"heightfield\""), std::string::npos);
  }
}

TEST(MitsubaAnimation, WithoutATimeTheFirstKeyIsShown) {
  const SceneDesc scene =
      parse(kCamera +
                "<shape type=\"sphere\"><animation name=\"toWorld\"><transform time=\"0\"><translate "
                "x=\"3\"/></transform>"
                "<transform time=\"1\"><translate x=\"5\"/></transform></animation></shape>",
            "0.6.0");
  EXPECT_EQ(scene.shapes.at(0).to_world.point({0, 0, 0}), (Vec3f{3, 0, 0}));
  ASSERT_EQ(scene.warnings.size(), 1u);
  EXPECT_TRUE(scene.warnings[0].harmless);
}

// In both dialects a lamp without a BSDF is black; in 0.6 a boundary of media without one is not there.
TEST(MitsubaDefaults, BsdfOfLampsAndOfMediumBoundaries) {
  const std::string text =
      kCamera +
      "<shape type=\"sphere\"><emitter type=\"area\"/></shape><shape type=\"sphere\"><medium "
      "name=\"interior\" type=\"homogeneous\"/></shape><shape type=\"cube\"/>";
  for (const char* version : {"0.6.0", "3.0.0"}) {
    const SceneDesc scene = parse(text, version);
    const auto bsdf = [&](std::size_t shape) {
      return scene.bsdfs.at(static_cast<std::size_t>(scene.shapes.at(shape).bsdf)).kind;
    };
    EXPECT_EQ(std::get<DiffuseDesc>(bsdf(0)).reflectance.value, Rgb(0));
    if (version[0] == '0') {
      EXPECT_TRUE(std::holds_alternative<NullBsdfDesc>(bsdf(1)));
    } else {
      EXPECT_EQ(scene.shapes[1].bsdf, kNone);
    }
    EXPECT_EQ(scene.shapes[2].bsdf, kNone);
    EXPECT_EQ(scene.sensors[0].film.filter.kind, FilterKind::gaussian);
  }
}

TEST(MitsubaDefaults, ConductorsAreCopperIn06AndMirrorsIn3) {
  const std::string text = kCamera + "<bsdf type=\"conductor\"/>";
  const auto old = std::get<ConductorDesc>(parse(text, "0.6.0").bsdfs.at(0).kind),
             now = std::get<ConductorDesc>(parse(text).bsdfs.at(0).kind);
  EXPECT_EQ(now.eta, Rgb(0));
  EXPECT_EQ(now.k, Rgb(1));
  const auto copper = *mitsuba_metal("Cu");
  EXPECT_FLOAT_EQ(old.eta.g, copper.eta.g / 1.000277f);
}

// The focal length of a full-frame camera whose diagonal is sqrt(36² + 24²) mm; 4:3 film, so the half width
// is 4/5 of the half diagonal.
TEST(MitsubaSensor, FocalLength) {
  const double half_diagonal = std::hypot(36, 24) / (2 * 50.0);
  const float fov = parse(kCamera).sensors[0].fov_x;
  EXPECT_NEAR(fov, 2 * std::atan(half_diagonal * 0.8) * 180 / M_PI, 1e-4);
  EXPECT_NEAR(parse("<sensor type=\"perspective\"><string name=\"focal_length\" value=\"50mm\"/></sensor>")
                  .sensors[0]
                  .fov_x,
              fov, 1e-5);
}

TEST(MitsubaSensor, FieldOfViewAxes) {
  const auto fov = [](const char* axis) {
    return parse(std::string("<sensor type=\"perspective\"><float name=\"fov\" value=\"50\"/><string "
                             "name=\"fov_axis\" value=\"") +
                 axis +
                 "\"/><film type=\"hdrfilm\"><integer name=\"width\" value=\"300\"/><integer name=\"height\" "
                 "value=\"200\"/></film></sensor>")
        .sensors[0]
        .fov_x;
  };
  const double t = std::tan(25 * M_PI / 180), degrees = 360 / M_PI;
  EXPECT_EQ(fov("x"), 50);
  EXPECT_EQ(fov("larger"), 50);
  EXPECT_NEAR(fov("y"), std::atan(1.5 * t) * degrees, 1e-4);
  EXPECT_EQ(fov("smaller"), fov("y"));
  EXPECT_NEAR(fov("diagonal"), std::atan(t * 3 / std::sqrt(13.0)) * degrees, 1e-4);
}

TEST(MitsubaTexture, ColorsGammaAndOffsets06) {
  std::ofstream(testing::TempDir() + "t.png") << "x";
  const SceneDesc scene =
      parse(kCamera +
                "<texture type=\"bitmap\"><string name=\"filename\" value=\"t.png\"/><float name=\"gamma\" "
                "value=\"1\"/>"
                "<float name=\"uscale\" value=\"4\"/><float name=\"voffset\" value=\"0.25\"/></texture>",
            "0.6.0");
  const auto& texture = std::get<BitmapTextureDesc>(scene.textures.at(0).kind);
  EXPECT_TRUE(texture.raw);
  // v' = v + 1/4 down the picture is 3/4 - v up it.
  EXPECT_EQ(texture.to_uv, (UvTransform{{4, 0, 0, 0, -1, 0.75f}}));
  EXPECT_TRUE(scene.warnings.empty());
}

TEST(MitsubaTexture, OneChannelAlone) {
  std::ofstream(testing::TempDir() + "t.png") << "x";
  const auto with = [](const std::string& channel) {
    return parse(kCamera +
                     "<texture type=\"bitmap\"><string name=\"filename\" value=\"t.png\"/><string "
                     "name=\"channel\" value=\"" +
                     channel + "\"/></texture>",
                 "0.6.0");
  };
  const std::pair<const char*, TextureChannel> cases[] = {{"r", TextureChannel::red},
                                                          {"g", TextureChannel::green},
                                                          {"b", TextureChannel::blue},
                                                          {"a", TextureChannel::alpha}};
  for (const auto& [name, channel] : cases) {
    const SceneDesc scene = with(name);
    EXPECT_EQ(std::get<BitmapTextureDesc>(scene.textures.at(0).kind).channel, channel) << name;
    EXPECT_TRUE(scene.warnings.empty());
  }
  EXPECT_THROW(with("q"), InputError);
}

TEST(MitsubaPrincipled, SpecularIsAnIndex) {
  // Reflectance at normal incidence ((η - 1)/(η + 1))² = 0.08 · specular = 0.04 means η = 1.5.
  const SceneDesc scene = parse(kCamera +
                                "<bsdf type=\"principled\"><float name=\"specular\" value=\"0.5\"/><float "
                                "name=\"metallic\" value=\"1\"/></bsdf>");
  const auto& desc = std::get<PrincipledDesc>(scene.bsdfs.at(0).kind);
  EXPECT_NEAR(desc.eta, 1.5f, 1e-6);
  EXPECT_EQ(desc.metallic.value, 1);
}

TEST(MitsubaPrincipled, ThinSheets) {
  const SceneDesc scene = parse(
      kCamera +
      "<bsdf type=\"principledthin\"><float name=\"diff_trans\" value=\"1.5\"/><float name=\"spec_trans\" "
      "value=\"0.25\"/></bsdf><bsdf type=\"difftrans\"><rgb name=\"transmittance\" value=\"0.1 0.2 "
      "0.3\"/></bsdf>");
  EXPECT_TRUE(scene.warnings.empty());
  const auto& sheet = std::get<PrincipledThinDesc>(scene.bsdfs.at(0).kind);
  EXPECT_EQ(sheet.diff_trans.value, 1.5f);
  EXPECT_EQ(sheet.spec_trans.value, 0.25f);
  EXPECT_EQ(sheet.eta, 1.5f);
  EXPECT_EQ(std::get<DiffuseTransmitterDesc>(scene.bsdfs.at(1).kind).transmittance.value,
            Rgb(0.1f, 0.2f, 0.3f));
  EXPECT_THROW(
      parse(kCamera + "<bsdf type=\"principledthin\"><float name=\"diff_trans\" value=\"2.5\"/></bsdf>"),
      InputError);
  EXPECT_THROW(parse(kCamera + "<bsdf type=\"principledthin\"><float name=\"sheen\" value=\"1.5\"/></bsdf>"),
               InputError);
}

TEST(MitsubaMixture, WeightsAndComplement) {
  const SceneDesc scene = parse(kCamera +
                                "<bsdf type=\"blendbsdf\"><float name=\"weight\" value=\"0.25\"/><bsdf "
                                "type=\"null\"/><bsdf type=\"diffuse\"/></bsdf>");
  const auto& parts = std::get<MixtureDesc>(scene.bsdfs.back().kind).parts;
  ASSERT_EQ(parts.size(), 2u);
  EXPECT_TRUE(parts[0].complement);
  EXPECT_FALSE(parts[1].complement);
  EXPECT_TRUE(
      std::holds_alternative<NullBsdfDesc>(scene.bsdfs.at(static_cast<std::size_t>(parts[0].bsdf)).kind));
}

TEST(MitsubaCoating, AbsorptionIsTimesThickness) {
  const std::string inner = "<bsdf type=\"diffuse\"/></bsdf>";
  const SceneDesc scene =
      parse(kCamera + "<bsdf type=\"coating\"><float name=\"intIOR\" value=\"1.7\"/>" +
                "<float name=\"extIOR\" value=\"1\"/><float name=\"thickness\" value=\"2\"/>" +
                "<rgb name=\"sigmaA\" value=\"0.1, 0.25, 3\"/>" + inner +
                "<bsdf type=\"roughcoating\"><float name=\"alpha\" value=\"0.3\"/>"
                "<string name=\"distribution\" value=\"ggx\"/>" +
                inner,
            "0.6.0");
  EXPECT_TRUE(scene.warnings.empty());
  const auto& smooth = std::get<CoatingDesc>(scene.bsdfs.at(1).kind);
  EXPECT_EQ(smooth.eta, 1.7f);
  EXPECT_EQ(smooth.absorption.value, Rgb(0.2f, 0.5f, 6));
  EXPECT_EQ(smooth.alpha_u.value, 0);
  EXPECT_EQ(smooth.nested, 0);
  const auto& rough = std::get<CoatingDesc>(scene.bsdfs.at(3).kind);
  EXPECT_EQ(rough.alpha_u.value, 0.3f);
  EXPECT_EQ(rough.distribution, Distribution::ggx);
  EXPECT_THROW(parse(kCamera + "<bsdf type=\"coating\"/>", "0.6.0"), InputError);
  EXPECT_THROW(
      parse(kCamera + "<bsdf type=\"coating\"><rgb name=\"sigmaA\" value=\"-1 0 0\"/>" + inner, "0.6.0"),
      InputError);
}

TEST(MitsubaMeasured, NamesItsFile) {
  const std::string file = testing::TempDir() + "skin.binary";
  std::ofstream(file) << "a table";
  const SceneDesc scene = parse(
      kCamera + "<bsdf type=\"merl\"><string name=\"filename\" value=\"skin.binary\"/></bsdf>", "0.6.0");
  EXPECT_TRUE(scene.warnings.empty());
  const auto& table = std::get<MeasuredDesc>(scene.bsdfs.at(0).kind);
  EXPECT_EQ(table.file.name, file);
  EXPECT_FALSE(table.file.missing);
  EXPECT_NE(describe(scene).find("merl filename " + file), std::string::npos);
  const auto files = files_of(scene);
  EXPECT_NE(std::find(files.begin(), files.end(), file), files.end());
  const WrittenScene written = write_mitsuba(scene, testing::TempDir() + "out.xml");
  ASSERT_EQ(written.warnings.size(), 1u);
  EXPECT_NE(written.warnings[0].what.find("MERL"), std::string::npos);
  EXPECT_NE(written.xml.find("\"diffuse\""), std::string::npos);
  EXPECT_THROW(parse(kCamera + "<bsdf type=\"merl\"/>"), InputError);
}

// Fresnel reflectance at normal incidence: silver above 0.9 in every channel, gold and copper red before
// green before blue, as these metals look.
TEST(MitsubaMetals, LookAsTheyShould) {
  const auto reflectance = [](const char* name) {
    const auto m = *metal_index(name);
    Rgb r;
    for (int i = 0; i < 3; ++i)
      r[i] = ((m.eta[i] - 1) * (m.eta[i] - 1) + m.k[i] * m.k[i]) /
             ((m.eta[i] + 1) * (m.eta[i] + 1) + m.k[i] * m.k[i]);
    return r;
  };
  for (int i = 0; i < 3; ++i) EXPECT_GT(reflectance("Ag")[i], 0.9f);
  // Titanium nitride and brass are the golden ones among compounds and alloys.
  for (const char* name : {"TiN", "CuZn"}) {
    const Rgb r = reflectance(name);
    EXPECT_GT(r.r, r.g);
    EXPECT_GT(r.g, r.b);
  }
  // Nearly colorless.
  for (const char* name : {"Al", "Cr", "Mo", "Rh", "V", "W", "Hg", "a-C", "d-C", "MgO", "TiO2"}) {
    const Rgb r = reflectance(name);
    EXPECT_LT(max_component(r), 2.5f * std::min({r.r, r.g, r.b})) << name;
  }
  // Transparent ones: ((n - 1)/(n + 1))² with n near 1.74 and 2.42 in the middle of the spectrum.
  EXPECT_NEAR(luminance(reflectance("MgO")), 0.073f, 0.01f);
  EXPECT_NEAR(luminance(reflectance("d-C")), 0.172f, 0.01f);
  for (const char* name : {"Au", "Cu"}) {
    const Rgb r = reflectance(name);
    EXPECT_GT(r.r, r.g);
    EXPECT_GT(r.g, r.b);
    EXPECT_GT(r.r, 0.9f);
    EXPECT_LT(r.b, 0.6f);
  }
  EXPECT_FALSE(metal_index("Unobtainium").has_value());
}

// What Mitsuba 3.9.1 says of its own, and a metal that it does not have.
TEST(MitsubaMetals, AreMitsubas) {
  const auto gold = *mitsuba_metal("Au");
  EXPECT_NEAR(gold.eta.g, 0.3753f, 1e-3f);
  EXPECT_NEAR(gold.k.b, 1.6034f, 1e-3f);
  EXPECT_NEAR(mitsuba_metal("Na_palik")->k.r, 3.1793f, 1e-3f);
  EXPECT_NE(mitsuba_metal("Cu")->eta, mitsuba_metal("Cu_palik")->eta);
  EXPECT_EQ(mitsuba_metal("CuZn")->k, metal_index("CuZn")->k);
  EXPECT_EQ(mitsuba_metal("none")->k, Rgb(1));
  EXPECT_FALSE(mitsuba_metal("Unobtainium").has_value());
}

TEST(MitsubaSpectrum, FilesAndPairsAreTheSame) {
  std::ofstream(testing::TempDir() + "s.spd") << "# wavelength value\n400 0.1\n500 0.5\n\n700 0.9\n";
  const SceneDesc scene = parse(
      kCamera +
      "<bsdf type=\"diffuse\"><spectrum name=\"reflectance\" filename=\"s.spd\"/></bsdf>"
      "<bsdf type=\"diffuse\"><spectrum name=\"reflectance\" value=\"400:0.1, 500:0.5 700:0.9\"/></bsdf>"
      "<bsdf type=\"diffuse\"><rgb name=\"reflectance\" value=\"#ff8000\"/></bsdf>"
      "<bsdf type=\"diffuse\"><srgb name=\"reflectance\" value=\"#ff8000\"/></bsdf>");
  const auto color = [&](std::size_t i) {
    return std::get<DiffuseDesc>(scene.bsdfs.at(i).kind).reflectance.value;
  };
  EXPECT_EQ(color(0), color(1));
  EXPECT_EQ(color(2), color(3));
  EXPECT_NEAR(color(2).g, 0.215861, 1e-5);  // ((128/255 + 0.055)/1.055)^2.4
}

// As Mitsuba 3.9 renders them: a number for all wavelengths is equal energy there, the color of a flat
// spectrum, and the same in all channels in 0.6.
TEST(MitsubaSpectrum, OneNumberIsEqualEnergyInThree) {
  const auto radiance = [](const char* version, const std::string& value) {
    const SceneDesc scene =
        parse(kCamera + "<emitter type=\"constant\"><spectrum name=\"radiance\" value=\"" + value +
                  "\"/></emitter>",
              version);
    return std::get<ConstantEnvironmentDesc>(scene.emitters.at(0).kind).radiance;
  };
  const Rgb modern = radiance("3.0.0", "2"), older = radiance("0.6.0", "2");
  EXPECT_EQ(older, Rgb(2));
  EXPECT_NEAR(modern.r, 2.4096, 1e-3);
  EXPECT_NEAR(modern.g, 1.8966, 1e-3);
  EXPECT_NEAR(modern.b, 1.8178, 1e-3);
  const Rgb flat = radiance("3.0.0", "400:2, 700:2");
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(flat[c], modern[c], 0.02) << c;
}

TEST(MitsubaFilter, MitchellParametersByDialect) {
  const auto filter = [](const char* version, const char* first, const char* second) {
    return parse(std::string("<sensor type=\"perspective\"><film type=\"hdrfilm\"><rfilter "
                             "type=\"mitchell\"><float name=\"") +
                     first + "\" value=\"0.2\"/><float name=\"" + second +
                     "\" value=\"0.4\"/></rfilter></film></sensor>",
                 version)
        .sensors[0]
        .film.filter;
  };
  for (const FilterDesc& f : {filter("0.6.0", "B", "C"), filter("3.0.0", "A", "B")}) {
    EXPECT_EQ(f.b, 0.2f);
    EXPECT_EQ(f.c, 0.4f);
  }
}

// The example of Reda and Andreas, "Solar position algorithm for solar radiation applications"
// (NREL/TP-560-34302, table A5.1): elevation 39.872° without refraction, azimuth 194.340°. The formulas here
// are stated to be good to 0.01°.
TEST(SolarPosition, AgreesWithThePublishedExample) {
  mitsuba::PlaceAndTime t;
  t.latitude = 39.742476, t.longitude = -105.1786, t.timezone = -7;
  t.year = 2003, t.month = 10, t.day = 17, t.hour = 12, t.minute = 30, t.second = 30;
  const auto sun = mitsuba::sun_position(t);
  EXPECT_NEAR(sun.elevation * 180 / M_PI, 39.872, 0.02);
  EXPECT_NEAR(std::fmod(sun.azimuth * 180 / M_PI + 360, 360), 194.340, 0.02);
}

// 0.6 has +x east and +y up, 3.x +x south, +y west and +z up: the same sky once the frames are the same.
TEST(SolarPosition, TheDialectsAgreeOnEastAndUp) {
  const std::string text = kCamera + "<emitter type=\"sun\"><float name=\"hour\" value=\"8\"/></emitter>";
  const auto world = [&](const char* version) {
    const SceneDesc scene = parse(text, version);
    const auto& sun = std::get<SunSkyDesc>(scene.emitters.at(0).kind);
    return std::pair(sun.to_world.vector(sun.sun_direction), sun.to_world.vector({0, 1, 0}));
  };
  const auto [old_sun, old_up] = world("0.6.0");
  const auto [new_sun, new_up] = world("3.0.0");
  EXPECT_EQ(old_up, (Vec3f{0, 1, 0}));
  EXPECT_NEAR(new_up.z, 1, 1e-6);
  EXPECT_GT(old_sun.x, 0.3f);  // in the east in the morning
  EXPECT_NEAR(new_sun.x, old_sun.z, 1e-6);
  EXPECT_NEAR(new_sun.y, -old_sun.x, 1e-6);
  EXPECT_NEAR(new_sun.z, old_sun.y, 1e-6);
}

// A stated sun direction is one of the world, whatever to_world turns the sky by.
TEST(SolarPosition, AStatedDirectionIsInTheWorld) {
  for (const char* version : {"0.6.0", "3.0.0"}) {
    const std::string name = version[0] == '0' ? "toWorld" : "to_world",
                      sun = version[0] == '0' ? "sunDirection" : "sun_direction";
    const SceneDesc scene = parse(kCamera + "<emitter type=\"sunsky\"><vector name=\"" + sun +
                                      "\" value=\"0, 3, 4\"/><transform name=\"" + name +
                                      "\"><rotate y=\"1\" angle=\"30\"/></transform></emitter>",
                                  version);
    const auto& desc = std::get<SunSkyDesc>(scene.emitters.at(0).kind);
    const Vec3f world = desc.to_world.vector(desc.sun_direction);
    EXPECT_NEAR(world.x, 0, 1e-6);
    EXPECT_NEAR(world.y, 0.6, 1e-6);
    EXPECT_NEAR(world.z, 0.8, 1e-6);
  }
}

}  // namespace
}  // namespace lumirank::scenedesc
