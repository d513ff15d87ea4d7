// reference, error and info.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <limits>

#include "image/image_io.h"
#include "program.h"

namespace lumirank::test {
namespace {

Arguments reference_of(const std::string& scene, const std::string& out) {
  return {"reference", scene, "-o", out, "--size", "8x8"};
}

TEST(ReferenceCommand, CountsItsPathsAndStatesItsError) {
  const TemporaryFolder folder;
  const std::string scene = write_scene(folder, small_room()), file = folder / "a.exr";
  const Arguments base = reference_of(scene, file) + Arguments{"--report", folder / "r.json"};
  const Outcome outcome = lumirank(base + Arguments{"--spp", "24", "--aov", "direct,indirect,emission"});
  EXPECT_SUCCESS(outcome);
  EXPECT_NE(outcome.out.find("24 paths per pixel; stated relative L1 error 0."), std::string::npos)
      << outcome.out;
  const auto report = read_json(folder / "r.json");
  EXPECT_EQ(report["method"], "reference");
  EXPECT_EQ(report["spp"], 24);
  EXPECT_GT(report["error.relative_l1"], 0);
  EXPECT_LT(report["error.relative_l1"], 1);
  for (const char* key :
       {"seconds.total", "seconds.build", "memory.peak_bytes", "seed", "version", "parameters"})
    EXPECT_TRUE(report.contains(key)) << key;
  const Pixels first = read_pixels(file);
  EXPECT_TRUE(all_finite(first));
  for (std::size_t p = 0; p < 64; ++p) {
    const double whole = first.channels.at("G")[p];
    EXPECT_NEAR(first.channels.at("direct.G")[p] + first.channels.at("indirect.G")[p] +
                    first.channels.at("emission.G")[p],
                whole, 8 * std::ldexp(1.0, -24) * whole);
  }

  EXPECT_SUCCESS(
      lumirank(base + Arguments{"--spp", "24", "--aov", "direct,indirect,emission", "--threads", "1"}));
  EXPECT_EQ(read_pixels(file), first) << "the same for any number of threads";
  EXPECT_SUCCESS(
      lumirank(base + Arguments{"--spp", "24", "--aov", "direct,indirect,emission", "--seed", "2"}));
  EXPECT_NE(read_pixels(file), first);
}

TEST(ReferenceCommand, StopsAtATimeOrAnError) {
  const TemporaryFolder folder;
  const std::string scene = write_scene(folder, small_room()), file = folder / "a.exr";
  const Arguments base = reference_of(scene, file) + Arguments{"--report", folder / "r.json"};
  EXPECT_SUCCESS(lumirank(base + Arguments{"--error", "0.2"}));
  EXPECT_LE(read_json(folder / "r.json")["error.relative_l1"], 0.2);
  EXPECT_SUCCESS(lumirank(base + Arguments{"--time", "0.2"}));
  EXPECT_GE(read_json(folder / "r.json")["spp"], 2);
}

TEST(ReferenceCommand, PathsOfColumnsAndTheRestMakeAll) {
  const TemporaryFolder folder;
  const std::string scene = write_scene(folder, small_room());
  std::map<std::string, Pixels> pixels;
  for (const char* paths : {"all", "columns", "rest"}) {
    const std::string file = folder / (std::string(paths) + ".exr");
    EXPECT_SUCCESS(lumirank(reference_of(scene, file) + Arguments{"--spp", "8", "--paths", paths}));
    pixels[paths] = read_pixels(file);
  }
  // A room of diffuse walls: columns carry everything, and the rest is black.
  EXPECT_EQ(pixels["all"], pixels["columns"]);
  EXPECT_EQ(mean(pixels["rest"]), 0);
}

// 2 × 1 pixels: I = (1, 2, 3), (4, 5, 6); R = (1, 1, 1), (5, 5, 5).
TEST(ErrorCommand, ByHand) {
  const TemporaryFolder folder;
  image::LayeredImage image, truth;
  image.color = image::Image(2, 1), truth.color = image::Image(2, 1);
  image.color.pixels = {{1, 2, 3}, {4, 5, 6}}, truth.color.pixels = {{1, 1, 1}, {5, 5, 5}};
  image::write_image(folder / "i.exr", image), image::write_image(folder / "r.pfm", truth);
  const Outcome outcome = lumirank({"error", folder / "i.exr", folder / "r.pfm"});
  EXPECT_SUCCESS(outcome);
  const auto json = nlohmann::json::parse(outcome.out);
  // Differences 0 1 2 -1 0 1: absolute sum 5, squares 7, sum 3; ΣR = 18, ΣR² = 78.
  EXPECT_NEAR(json.at("relative_l1").get<double>(), 5.0 / 18, 1e-12);
  EXPECT_NEAR(json.at("relative_l2").get<double>(), std::sqrt(7.0 / 78), 1e-12);
  EXPECT_NEAR(json.at("rmse").get<double>(), std::sqrt(7.0 / 6), 1e-12);
  EXPECT_NEAR(json.at("bias").get<double>(), 3.0 / 18, 1e-12);
  EXPECT_TRUE(json.at("relmse").is_number());
  EXPECT_GT(json.at("flip").get<double>(), 0);
  EXPECT_LT(json.at("flip").get<double>(), 1);
  const Outcome same = lumirank({"error", folder / "r.pfm", folder / "r.pfm"});
  EXPECT_EQ(nlohmann::json::parse(same.out).at("relative_l2"), 0);
  EXPECT_EQ(nlohmann::json::parse(same.out).at("flip"), 0);
}

TEST(ErrorCommand, RefusesWhatCannotBeCompared) {
  const TemporaryFolder folder;
  image::LayeredImage image, wide, broken;
  image.color = image::Image(2, 2, Rgb(1)), wide.color = image::Image(3, 2, Rgb(1)), broken = image;
  broken.color.pixels[0].r = std::numeric_limits<float>::quiet_NaN();
  broken.color.pixels[3].g = std::numeric_limits<float>::infinity();
  const std::string a = folder / "a.exr", w = folder / "wide.exr", b = folder / "broken.pfm";
  image::write_image(a, image), image::write_image(w, wide), image::write_image(b, broken);
  expect_refused(lumirank({"error", a, w}), "2 x 2 pixels and the reference 3 x 2");
  expect_refused(lumirank({"error", b, a}), "2 ");
  expect_refused(lumirank({"error", a, b}), "2 ");
  expect_refused(lumirank({"error", a, folder / "none.exr"}), "none.exr");
  { std::ofstream(folder / "text.exr") << "not an image"; }
  expect_refused(lumirank({"error", folder / "text.exr", a}), "text.exr");
}

TEST(Info, CountsTheBox) {
  const Outcome text = lumirank({"info", example("box")}),
                json = lumirank({"info", "--json", example("box")});
  EXPECT_SUCCESS(text);
  EXPECT_SUCCESS(json);
  const auto info = nlohmann::json::parse(json.out);
  // Six rectangles of two triangles and two cubes of twelve.
  EXPECT_EQ(info.at("triangles"), 6 * 2 + 2 * 12);
  EXPECT_NE(text.out.find("36 triangles"), std::string::npos);
  ASSERT_EQ(info.at("emitters").size(), 1u);
  EXPECT_EQ(info["emitters"][0]["name"], "lamp");
  // A diffuse lamp of area 0.5 × 0.5 and radiance (17, 12, 6) shines π·A·L.
  const double pi = 3.14159265358979;
  EXPECT_NEAR(info["emitters"][0]["power"][0].get<double>(), pi * 0.25 * 17, 1e-4);
  EXPECT_EQ(info.at("cameras").size(), 1u);
  EXPECT_TRUE(info.at("warnings").empty());
  // The walls span [-1, 1] × [0, 2] × [-1, 1].
  EXPECT_EQ(info.at("bounds"), nlohmann::json::parse("[[-1.0,0.0,-1.0],[1.0,2.0,1.0]]"));
}

TEST(Info, ListsWhatWasReplacedWithItsLine) {
  const TemporaryFolder folder;
  const std::string scene =
      write_scene(folder, point_camera("0,0,3", "0,0,0", 8, 40) +
                              "\n<shape type=\"sphere\">\n<bsdf type=\"velvet\"/>\n</shape>\n");
  const Outcome text = lumirank({"info", scene}), json = lumirank({"info", scene, "--json"});
  EXPECT_SUCCESS(text);
  // Line 1 is <scene>, 2 the camera, 3 the shape.
  EXPECT_NE(text.out.find("scene.xml:4"), std::string::npos) << text.out;
  EXPECT_NE(text.out.find("velvet"), std::string::npos);
  bool found = false;
  const auto info = nlohmann::json::parse(json.out);
  for (const auto& warning : info.at("warnings"))
    found = found || warning.get<std::string>().find("scene.xml:4") != std::string::npos;
  EXPECT_TRUE(found);
  expect_refused(lumirank({"info", scene, "--strict"}), "scene.xml:4");
}

TEST(Info, CountsMedia) {
  const TemporaryFolder folder;
  const std::string scene = write_scene(
      folder, point_camera("0,0,3", "0,0,0", 8, 40) +
                  "<shape type=\"sphere\"><bsdf type=\"null\"/><medium name=\"interior\" id=\"milk\" "
                  "type=\"homogeneous\"/></shape><emitter type=\"constant\"/>");
  const Outcome text = lumirank({"info", scene, "--strict"}), json = lumirank({"info", scene, "--json"});
  EXPECT_SUCCESS(text);
  EXPECT_EQ(nlohmann::json::parse(json.out).at("media"), 1);
  EXPECT_NE(text.out.find("1 materials, 1 media\n"), std::string::npos) << text.out;
  EXPECT_NE(text.out.find("\"milk\": extinction 1, albedo 0.75"), std::string::npos) << text.out;
  // Most scenes have none, and their listing says nothing of it.
  const Outcome box = lumirank({"info", example("box")});
  EXPECT_EQ(box.out.find("media"), std::string::npos) << box.out;
  EXPECT_EQ(nlohmann::json::parse(lumirank({"info", example("box"), "--json"}).out).at("media"), 0);
}

TEST(Info, EveryExample) {
  for (const char* name : {"interior", "lamps", "courtyard", "recesses"}) {
    const Outcome json = lumirank({"info", example(name), "--json", "--strict"});
    EXPECT_SUCCESS(json);
    const auto info = nlohmann::json::parse(json.out);
    EXPECT_GT(info.at("triangles"), 0) << name;
    EXPECT_FALSE(info.at("emitters").empty()) << name;
  }
}

}  // namespace
}  // namespace lumirank::test
