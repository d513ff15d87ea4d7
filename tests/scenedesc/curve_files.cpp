// Files of curves, good and bad, and the scenes that name them.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <fstream>

#include "base/error.h"
#include "scenedesc/readers.h"
#include "scenedesc/schema/hair.h"

namespace lumirank::scenedesc {
namespace {

using Basis = CurvesDesc::Basis;

CurvesDesc parsed(const std::string& bytes, Basis basis = Basis::linear, float file_radius = 0) {
  CurvesDesc curves;
  curves.filename = "curves.txt";
  curves.basis = basis, curves.file_radius = file_radius;
  return parse_curves(bytes, curves);
}

TEST(CurveFiles, EmptyLinesPartTheCurves) {
  const CurvesDesc c = parsed("\n0 0 0 0.5\n 1 0 0\t0.25\r\n\n \n2 0 0 1e-1\n3 0 0 .1\n4 0 0 +0.1");
  EXPECT_EQ(c.first, (std::vector<std::uint32_t>{0, 2, 5}));
  EXPECT_EQ(c.points[4], (Vec3f{4, 0, 0}));
  EXPECT_EQ(c.radii, (std::vector<float>{0.5f, 0.25f, 0.1f, 0.1f, 0.1f}));
}

TEST(CurveFiles, OneRadiusForAllFromOutside) {
  const CurvesDesc c = parsed("0 0 0\n1 0 0\n\n2 0 0\n3 0 0\n", Basis::linear, 0.025f);
  EXPECT_EQ(c.first, (std::vector<std::uint32_t>{0, 2, 4}));
  EXPECT_EQ(c.radii, std::vector<float>(4, 0.025f));
}

std::string binary(std::uint32_t count, const std::vector<float>& values) {
  std::string bytes = "BINARY_HAIR";
  bytes.append(reinterpret_cast<const char*>(&count), 4);
  bytes.append(reinterpret_cast<const char*>(values.data()), 4 * values.size());
  return bytes;
}

TEST(CurveFiles, BinaryHairOfMitsuba06) {
  const CurvesDesc c =
      parsed(binary(4, {kInfinity, 0, 0, 0, 1, 0, 0, kInfinity, 0, 1, 0, 0, 2, 0}), Basis::linear, 1);
  EXPECT_EQ(c.first, (std::vector<std::uint32_t>{0, 2, 4}));
  EXPECT_EQ(c.points[3], (Vec3f{0, 2, 0}));
}

TEST(CurveFiles, AFileMayHoldNoCurve) {
  for (const char* bytes : {"", " \n\n"}) {
    const CurvesDesc c = parsed(bytes, Basis::bspline, 0);
    EXPECT_TRUE(c.points.empty());
    EXPECT_EQ(c.first, std::vector<std::uint32_t>{0});
  }
}

TEST(CurveFiles, BadOnesAreRefusedWithLineAndReason) {
  const struct {
    std::string bytes;
    Basis basis;
    float file_radius;
    int line;
    const char* says;
  } cases[] = {
      {"0 0 0 1\n1 0 0\n", Basis::linear, 0, 2, "too few numbers; a point is \"x y z radius\""},
      {"0 0 0\n1 0\n", Basis::linear, 1, 2, "too few numbers; a point is \"x y z\""},
      {"0 0 0 1\n1 0 zero 1\n", Basis::linear, 0, 2, "'zero' is not a number"},
      {"0 0 0 1\n1 0 0x 1\n", Basis::linear, 0, 2, "'0x' is not a number"},
      {"0 0 0 1 7\n1 0 0 1\n", Basis::linear, 0, 1, "more in the line than a point: '7'"},
      {"0 0 0 1\n1 nan 0 1\n", Basis::linear, 0, 2, "not finite"},
      {"0 0 0 1\n1 1e99 0 1\n", Basis::linear, 0, 2, "not finite"},
      {"0 0 0 1\n1 0 0 -1\n", Basis::linear, 0, 2, "radius is negative"},
      {"0 0 0 1\n\n", Basis::linear, 0, 2, "has 1 point; it needs 2"},
      {"0 0 0 1\n1 0 0 1\n2 0 0 1\n\n", Basis::bspline, 0, 4, "has 3 points; it needs 4"},
      {"0 0 0 1\n1 0 0 1\n2 0 0 1\n3 0 0 1\n4 0 0 1", Basis::bezier, 0, 5, "has 5 points; 4, 7, 10"},
      {"BINARY_HAIR\1", Basis::linear, 1, 0, "within its header"},
      {binary(3, {0, 0, 0, 1, 0, 0}), Basis::linear, 1, 0, "ends at point 2 of 3"},
      {binary(2, {0, 0, 0, kInfinity}), Basis::linear, 1, 0, "has 1 point"},
      {binary(2, {0, 0, 0, 1, NAN, 0}), Basis::linear, 1, 0, "not finite"},
  };
  for (const auto& bad : cases) {
    try {
      parsed(bad.bytes, bad.basis, bad.file_radius);
      ADD_FAILURE() << bad.says;
    } catch (const InputError& e) {
      EXPECT_EQ(e.where().file, "curves.txt");
      EXPECT_EQ(e.where().line, bad.line) << bad.says;
      EXPECT_NE(std::string(e.what()).find(bad.says), std::string::npos) << e.what();
    }
  }
}

SceneDesc scene(const std::string& body, const char* version) {
  std::ofstream(testing::TempDir() + "fur.txt") << "0 0 0 1\n1 0 0 1\n2 0 0 1\n3 0 0 1\n";
  return parse_mitsuba(
      "<scene version=\"" + std::string(version) + "\"><sensor type=\"perspective\"/>\n" + body + "</scene>",
      testing::TempDir() + "hair.xml");
}

TEST(MitsubaCurves, ShapesOfBothDialects) {
  const std::string file = "<string name=\"filename\" value=\"fur.txt\"/>";
  const SceneDesc three = scene(
      "<shape type=\"bsplinecurve\">" + file + "</shape><shape type=\"linearcurve\">" + file + "</shape>",
      "3.0.0");
  EXPECT_EQ(std::get<CurvesDesc>(three.shapes.at(0).kind).basis, Basis::bspline);
  EXPECT_EQ(std::get<CurvesDesc>(three.shapes.at(1).kind).basis, Basis::linear);
  EXPECT_EQ(std::get<CurvesDesc>(three.shapes[0].kind).filename, testing::TempDir() + "fur.txt");
  EXPECT_EQ(std::get<CurvesDesc>(three.shapes[0].kind).file_radius, 0);
  EXPECT_TRUE(three.warnings.empty());
  // The radius is in world units, though the points are scaled by 2.
  const SceneDesc old =
      scene("<shape type=\"hair\">" + file +
                "<float name=\"radius\" value=\"0.5\"/><float name=\"reduction\" value=\"0.3\"/><float "
                "name=\"angleThreshold\" value=\"2\"/><transform name=\"toWorld\"><scale "
                "value=\"2\"/></transform></shape>",
            "0.6.0");
  EXPECT_NEAR(std::get<CurvesDesc>(old.shapes.at(0).kind).file_radius, 0.25f, 1e-6f);
  ASSERT_EQ(old.warnings.size(), 1u);
  EXPECT_NE(old.warnings[0].what.find("\"reduction\""), std::string::npos);
}

TEST(MitsubaCurves, Hair) {
  const SceneDesc s = scene("<bsdf type=\"hair\"/>", "3.0.0");
  EXPECT_TRUE(s.warnings.empty());
  const auto& brown = std::get<HairFiberDesc>(s.bsdfs.at(0).kind);
  EXPECT_EQ(brown.sigma_a, hair_absorption(1.3f, 0.2f));
  EXPECT_NEAR(brown.eta, 1.55f, 0.01f);
  EXPECT_EQ(brown.tilt, 2);
  const SceneDesc given = scene(
      "<bsdf type=\"hair\"><rgb name=\"sigma_a\" value=\"0.1,0.2,0.3\"/><float name=\"scale\" value=\"2\"/>"
      "<float name=\"longitudinal_roughness\" value=\"0.1\"/><float name=\"azimuthal_roughness\" "
      "value=\"0.2\"/><float name=\"scale_tilt\" value=\"-3\"/></bsdf>",
      "3.0.0");
  const auto& own_values = std::get<HairFiberDesc>(given.bsdfs.at(0).kind);
  EXPECT_NEAR(own_values.sigma_a.g, 0.4f, 1e-6f);
  EXPECT_EQ(own_values.beta_m, 0.1f);
  EXPECT_EQ(own_values.beta_n, 0.2f);
  EXPECT_EQ(own_values.tilt, -3);
  for (const char* bad :
       {"<float name=\"eumelanin\" value=\"-1\"/>", "<float name=\"longitudinal_roughness\" value=\"2\"/>",
        "<float name=\"eumelanin\" value=\"1\"/><rgb name=\"sigma_a\" value=\"1,1,1\"/>",
        "<rgb name=\"sigma_a\" value=\"1,-1,1\"/>", "<float name=\"azimuthal_roughness\" value=\"-1\"/>",
        "<float name=\"scale_tilt\" value=\"30\"/>"})
    EXPECT_THROW(scene("<bsdf type=\"hair\">" + std::string(bad) + "</bsdf>", "3.0.0"), InputError) << bad;
  const SceneDesc own = scene(
      "<bsdf type=\"kajiyakay\"><rgb name=\"diffuse_reflectance\" value=\"0.1,0.2,0.3\"/><float "
      "name=\"exponent\" value=\"9\"/></bsdf>",
      "3.0.0");
  EXPECT_TRUE(own.warnings.empty());
  EXPECT_EQ(std::get<HairDesc>(own.bsdfs.at(0).kind).exponent.value, 9);
  EXPECT_THROW(scene("<bsdf type=\"kajiyakay\"><float name=\"exponent\" value=\"-9\"/></bsdf>", "3.0.0"),
               InputError);
}

// Without absorption nothing is lost: Σ over reflections and passages is 1 for every ray through the fiber.
TEST(HairFromAbsorption, KeepsTheEnergyOfTheFiber) {
  const HairDesc white = hair_from_absorption(Rgb(0), 1.55f, 0.3f);
  EXPECT_NEAR(white.diffuse_reflectance.value.g + white.specular_reflectance.value.g, 1, 1e-5f);
  // β = 0.3: v = (0.726·0.3 + 0.812·0.09)² = 0.0846, and cosⁿ has a variance of 1/n.
  EXPECT_NEAR(white.exponent.value, 1 / 0.0846f, 0.05f);
  // Opaque: what the surface reflects. The mean of Fresnel's reflectance over the width of a cylinder of
  // index 1 is 0, and there is no reflection at all.
  EXPECT_NEAR(hair_from_absorption(Rgb(1e6f), 1.55f, 0.3f).diffuse_reflectance.value.r, 0, 1e-6f);
  EXPECT_NEAR(hair_from_absorption(Rgb(0), 1, 0.3f).specular_reflectance.value.r, 0, 1e-9f);
  // Index 1 and absorption σ: ∫ exp(-2σ√(1 - h²)) dh over 0 to 1; for small σ 1 - 2σ·π/4 + 4σ²/2·2/3.
  EXPECT_NEAR(hair_from_absorption(Rgb(0.01f), 1, 0.3f).diffuse_reflectance.value.r,
              1 - 0.02 * 3.14159265 / 4 + 0.0002 * 2 / 3, 3e-6);
}

}  // namespace
}  // namespace lumirank::scenedesc
