// Photometric files: what the editions, symmetries and types mean, and what is refused.
#include "scenedesc/ies/ies.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>

#include "base/error.h"
#include "base/random.h"
#include "scenedesc/bad_files.h"

namespace lumirank::scenedesc {
namespace {

std::string file(const std::string& name) { return std::string(LUMIRANK_TEST_DATA) + "/ies/" + name; }

struct Table {
  IesData data;
  PolarTable polar;
  explicit Table(const std::string& name) : data(read_ies(file(name))), polar(to_polar(data, name)) {}
  // At a corner of the table; degrees.
  float at(double theta, double phi) const {
    for (std::size_t r = 0; r < polar.theta.size(); ++r)
      for (std::size_t c = 0; c < polar.phi.size(); ++c)
        if (std::abs(polar.theta[r] * 180 / kPi - theta) < 1e-3 &&
            std::abs(polar.phi[c] * 180 / kPi - phi) < 1e-3)
          return polar.values[r * polar.phi.size() + c];
    ADD_FAILURE() << "no entry at " << theta << ", " << phi;
    return -1;
  }
  float phi(std::size_t k) const { return polar.phi[k] * 180 / kPi; }
};

TEST(Ies, FactorsUnitsAndQuadrants) {
  const Table t("downlight.ies");
  EXPECT_EQ(t.data.year, 1991);
  EXPECT_EQ(t.data.lamps, 2);
  EXPECT_FLOAT_EQ(t.data.opening.x, 0.5f * 0.3048f);
  // Multiplier 2, ballast factor 0.5, ballast-lamp factor 0.9 (up to 1991): 0.9 in all.
  EXPECT_FLOAT_EQ(t.at(0, 0), 1800);
  // 0, 45 and 90 and what their mirroring makes.
  ASSERT_EQ(t.polar.phi.size(), 9u);
  for (std::size_t k = 0; k < 9; ++k) EXPECT_NEAR(t.phi(k), 45.0 * static_cast<double>(k), 1e-3);
  for (const double phi : {0.0, 180.0, 360.0}) EXPECT_FLOAT_EQ(t.at(30, phi), 0.9f * 1600);
  for (const double phi : {45.0, 135.0, 225.0, 315.0}) EXPECT_FLOAT_EQ(t.at(30, phi), 0.9f * 1400);
  for (const double phi : {90.0, 270.0}) EXPECT_FLOAT_EQ(t.at(30, phi), 0.9f * 1200);
  EXPECT_TRUE(t.data.warnings.empty());
}

TEST(Ies, OneHorizontalAngleTurnsAllRound) {
  const Table t("even.ies");
  EXPECT_EQ(t.data.year, 2002);
  EXPECT_EQ(t.data.lumens_per_lamp, -1);
  ASSERT_EQ(t.polar.phi.size(), 2u);
  EXPECT_EQ(t.polar.phi.back(), 2 * kPi);
  for (const float v : t.polar.values) EXPECT_EQ(v, 1000);
}

TEST(Ies, HorizontalAnglesTurnCounterClockwiseSeenFromAbove) {
  // Local +z is down, so that phi = 360° - horizontal angle.
  const Table t("tilted.ies");
  EXPECT_EQ(t.data.year, 1986);
  EXPECT_FLOAT_EQ(t.at(45, 270), 85);  // stated at 90
  EXPECT_FLOAT_EQ(t.at(45, 90), 95);   // stated at 270
  EXPECT_FLOAT_EQ(t.at(90, 180), 70);
  EXPECT_FLOAT_EQ(t.at(180, 0), 20);
  EXPECT_FLOAT_EQ(t.at(180, 360), 20);
}

TEST(Ies, TiltFactors) {
  const IesData within = read_ies(file("tilted.ies"));
  EXPECT_FLOAT_EQ(within.tilt_factor(0), 1);
  EXPECT_FLOAT_EQ(within.tilt_factor(45), 0.8f);
  EXPECT_FLOAT_EQ(within.tilt_factor(22.5), 0.9f);
  EXPECT_FLOAT_EQ(within.tilt_factor(120), 0.5f);
  EXPECT_FLOAT_EQ(within.tilt_factor(-10), 1);
  const IesData beside = read_ies(file("tilt_file.ies"));
  EXPECT_FLOAT_EQ(beside.tilt_factor(45), 0.8f);
  EXPECT_FLOAT_EQ(read_ies(file("even.ies")).tilt_factor(45), 1);
}

TEST(Ies, TheOtherSymmetries) {
  const Table half("half.ies");  // 0 to 180, light upwards only; a code in place of the old factor
  EXPECT_EQ(half.data.year, 2019);
  EXPECT_FLOAT_EQ(half.at(135, 90), 40);
  EXPECT_FLOAT_EQ(half.at(135, 270), 40);
  EXPECT_FLOAT_EQ(half.at(135, 180), 60);
  EXPECT_NEAR(half.polar.theta.front(), kPi / 2, 1e-6);
  const Table across("across.ies");  // 90 to 270: 0 is like 180
  EXPECT_FLOAT_EQ(across.at(90, 180), 30);
  EXPECT_FLOAT_EQ(across.at(90, 0), 30);
  EXPECT_FLOAT_EQ(across.at(90, 270), 20);
  EXPECT_FLOAT_EQ(across.at(90, 90), 40);
}

TEST(Ies, ACircleThatStopsOneStepShortIsClosedWithAWarning) {
  IesData data =
      parse_ies("IESNA91\nTILT=NONE\n1 1000 1 2 4 1 2 0 0 0 1 1 9\n0 90\n0 90 180 270\n1 2\n1 3\n1 4\n1 5\n",
                "short.ies");
  const PolarTable t = to_polar(data, "short.ies");
  EXPECT_EQ(data.warnings.size(), 1u);
  ASSERT_EQ(t.phi.size(), 5u);
  EXPECT_EQ(t.values[5], 2);  // at the horizon, 0
  EXPECT_EQ(t.values[6], 5);  // 270 turned round
  EXPECT_EQ(t.values[9], 2);
}

// Bilinear in the local angles at any direction given in degrees of type B or A.
float looked_up(const PolarTable& t, Vec3f d) {
  const double step = kPi / 360.0;
  double theta = std::acos(std::clamp(d.z, -1.0f, 1.0f)), phi = std::atan2(d.y, d.x);
  if (phi < 0) phi += 2 * 3.14159265358979;
  const auto r = std::min<std::size_t>(static_cast<std::size_t>(theta / step), 359),
             c = std::min<std::size_t>(static_cast<std::size_t>(phi / step), 719);
  const double fr = theta / step - static_cast<double>(r), fc = phi / step - static_cast<double>(c);
  const auto v = [&](std::size_t i, std::size_t k) { return double{t.values[i * t.phi.size() + k]}; };
  return static_cast<float>((v(r, c) * (1 - fc) + v(r, c + 1) * fc) * (1 - fr) +
                            (v(r + 1, c) * (1 - fc) + v(r + 1, c + 1) * fc) * fr);
}

TEST(Ies, TypeBTurnsAboutAHorizontalAxis) {
  const Table t("flood.ies");
  const auto at = [&](double v, double h) {
    const double V = v * kPi / 180, H = h * kPi / 180;
    return looked_up(t.polar, {static_cast<float>(std::cos(H) * std::sin(V)), static_cast<float>(std::sin(H)),
                               static_cast<float>(std::cos(H) * std::cos(V))});
  };
  // Within half a step of 0.5° times the slope of 14 cd per degree.
  EXPECT_NEAR(at(0, 0), 500, 4);
  EXPECT_NEAR(at(30, 0), 300, 4);
  EXPECT_NEAR(at(-30, 0), 100, 4);
  EXPECT_NEAR(at(0, 30), 400, 4);
  EXPECT_NEAR(at(0, -30), 400, 4);  // symmetric: horizontal angles begin at 0
  EXPECT_NEAR(at(30, 30), 200, 4);
  EXPECT_NEAR(at(15, 15), 0.25 * (500 + 300 + 400 + 200), 4);
  EXPECT_EQ(at(70, 0), 0);
  EXPECT_EQ(at(180, 0), 0);
}

TEST(Ies, TypeATurnsAboutTheVerticalAndIsAimedAtTheHorizon) {
  const Table t("headlamp.ies");
  const auto at = [&](double v, double h) {
    const double V = v * kPi / 180, H = h * kPi / 180;
    return looked_up(t.polar,
                     {static_cast<float>(std::cos(V) * std::cos(H)),
                      static_cast<float>(std::cos(V) * std::sin(H)), static_cast<float>(-std::sin(V))});
  };
  // Slopes of up to 90 cd per degree, half a step of 0.5°.
  EXPECT_NEAR(at(0, 0), 900, 23);
  EXPECT_NEAR(at(0, 20), 200, 23);
  EXPECT_NEAR(at(0, -20), 100, 23);
  EXPECT_NEAR(at(10, 0), 50, 23);
  EXPECT_NEAR(at(-10, 0), 10, 23);
  EXPECT_NEAR(at(5, 10), 0.25 * (900 + 200 + 50 + 0), 23);
  EXPECT_EQ(at(12, 0), 0);
  EXPECT_EQ(at(0, 25), 0);
  EXPECT_EQ(at(0, 180), 0);
}

const BadFile kBadIesFiles[] = {
    {"empty.ies", 1, "TILT="},
    {"no_tilt.ies", 3, "TILT="},
    {"picture.ies", 2, "TILT="},
    {"tilt_of_nothing.ies", 2, "TILT="},
    {"tilt_missing_file.ies", 0, "does not exist"},
    {"tilt_geometry.ies", 3, "geometry"},
    {"tilt_negative.ies", 6, "tilt factor"},
    {"truncated.ies", 8, "candela value 3 of 3"},
    {"truncated_angles.ies", 5, "vertical angle 3"},
    {"truncated_head.ies", 3, "vertical angles"},
    {"too_many.ies", 7, "more candela values"},
    {"count_lies.ies", 4, "room"},
    {"one_vertical.ies", 3, "vertical angles"},
    {"fraction.ies", 3, "whole number"},
    {"negative_count.ies", 3, "whole number"},
    {"word.ies", 7, "\"eight\""},
    {"nan.ies", 7, "not finite"},
    {"infinite.ies", 7, "not finite"},
    {"huge.ies", 7, "not finite"},
    {"negative.ies", 7, "negative"},
    {"falling.ies", 5, "not above"},
    {"equal.ies", 5, "not above"},
    {"beyond.ies", 5, "between 0 and 180"},
    {"type.ies", 3, "photometric type"},
    {"units.ies", 3, "units"},
    {"multiplier.ies", 3, "multiplier"},
    {"ballast.ies", 4, "ballast factor"},
    {"no_symmetry.ies", 0, "120°"},
    {"gap.ies", 0, "gap"},
    {"type_b_from_10.ies", 0, "begin at 10°"},
    {"overflow.ies", 7, "not finite"},
};

TEST(IesBadFiles, EveryFileIsRefusedWithItsNameLineAndReason) {
  for (const BadFile& bad : kBadIesFiles) {
    const std::string name = std::string(LUMIRANK_TEST_DATA) + "/bad_ies/" + bad.name;
    try {
      IesData data = read_ies(name);
      to_polar(data, name);
      ADD_FAILURE() << bad.name << " was accepted";
    } catch (const InputError& e) {
      if (std::string(bad.name) != "tilt_missing_file.ies") {
        EXPECT_EQ(e.where().file, name);
      }
      EXPECT_EQ(e.where().line, bad.line) << bad.name << ": " << e.what();
      EXPECT_NE(std::string(e.what()).find(bad.phrase), std::string::npos) << bad.name << ": " << e.what();
    }
  }
}

TEST(IesBadFiles, TheCorpusIsCompletelyListed) {
  std::set<std::string> listed, there;
  for (const BadFile& bad : kBadIesFiles) listed.insert(bad.name);
  for (const auto& entry : std::filesystem::directory_iterator(std::string(LUMIRANK_TEST_DATA) + "/bad_ies"))
    there.insert(entry.path().filename().string());
  EXPECT_EQ(listed, there);
}

TEST(IesBadFiles, DamagedFilesAreReadOrRefused) {
  for (const char* name : {"downlight.ies", "tilted.ies", "flood.ies"}) {
    std::ifstream in(file(name), std::ios::binary);
    const std::string whole((std::istreambuf_iterator<char>(in)), {});
    for (std::uint64_t i = 0; i < 600; ++i) {
      Rng rng(11, Stage::test, i);
      std::string text = whole;
      for (int k = 0; k < 3; ++k)
        text[rng.next_below(static_cast<std::uint32_t>(text.size()))] = "0-9. e,\n\r"[rng.next_below(9)];
      if (i % 3 == 0) text.resize(rng.next_below(static_cast<std::uint32_t>(text.size())));
      try {
        IesData data = parse_ies(text, name);
        const PolarTable t = data.type == IesData::Type::C ? to_polar(data, name) : PolarTable{};
        for (const float v : t.values) ASSERT_TRUE(std::isfinite(v) && v >= 0);
        ASSERT_EQ(t.values.size(), t.theta.size() * t.phi.size());
      } catch (const InputError&) {
      }
    }
  }
}

}  // namespace
}  // namespace lumirank::scenedesc
