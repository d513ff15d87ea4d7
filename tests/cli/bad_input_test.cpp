// Bad files through the whole program: exit code 2, the file's name (and line), nothing printed, nothing
// written.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <regex>

#include "image/image_io.h"
#include "program.h"

namespace lumirank::test {
namespace {

namespace fs = std::filesystem;

std::vector<std::string> corpus(const std::string& folder) {
  std::vector<std::string> files;
  for (const auto& entry : fs::directory_iterator(data_file(folder))) files.push_back(entry.path().string());
  std::sort(files.begin(), files.end());
  return files;
}

TEST(BadInput, EveryBadSceneIsRefused) {
  const TemporaryFolder folder;
  std::vector<std::string> files;
  std::vector<Arguments> runs;
  int pbrt = 0;
  for (const std::string& file : corpus("bad"))
    // Of the pbrt files every fifth: starting the program is most of this test's time, and that of the reader
    // has them all.
    if (file.ends_with(".xml") || (file.ends_with(".pbrt") && pbrt++ % 5 == 0)) {
      files.push_back(file);
      runs.push_back(render_small(file, folder / "a.exr"));
    }
  EXPECT_GT(files.size(), 95u);
  const auto outcomes = lumirank_each(runs);
  for (std::size_t k = 0; k < files.size(); ++k) {
    // A loop of includes is found in the file that closes it.
    const std::string name = fs::path(files[k]).filename().string();
    expect_refused(outcomes[k], name.find("include_loop") != name.npos ? "include_loop" : name);
    EXPECT_TRUE(std::regex_search(outcomes[k].err, std::regex("^lumirank: [^\n]*\\.(xml|pbrt):[0-9]+: ")))
        << "no line: " << outcomes[k].err;
  }
  EXPECT_TRUE(files_in(folder / "").empty());
}

TEST(BadInput, EveryBadGltfSceneIsRefused) {
  const TemporaryFolder folder;
  std::vector<std::string> files;
  std::vector<Arguments> runs;
  for (const std::string& file : corpus("bad"))
    if (file.ends_with(".gltf") || file.ends_with(".glb")) {
      files.push_back(file);
      runs.push_back(render_small(file, folder / "a.exr"));
    }
  EXPECT_GT(files.size(), 90u);
  const auto outcomes = lumirank_each(runs);
  for (std::size_t k = 0; k < files.size(); ++k)
    expect_refused(outcomes[k], fs::path(files[k]).filename().string());
  EXPECT_TRUE(files_in(folder / "").empty());
}

TEST(BadInput, EveryBadMeshIsRefused) {
  const TemporaryFolder folder, out;
  const auto files = corpus("bad_meshes");
  EXPECT_GT(files.size(), 60u);
  std::vector<Arguments> runs;
  for (const std::string& file : files) {
    const std::string type = fs::path(file).extension().string().substr(1);
    const std::string scene = write_scene(folder,
                                          point_camera("0,0,3", "0,0,0", 8, 40) + "<shape type=\"" + type +
                                              "\"><string name=\"filename\" value=\"" + file +
                                              "\"/></shape><emitter type=\"constant\"/>",
                                          std::to_string(runs.size()) + ".xml");
    runs.push_back(render_small(scene, out / "a.exr"));
  }
  const auto outcomes = lumirank_each(runs);
  for (std::size_t k = 0; k < files.size(); ++k)
    expect_refused(outcomes[k], fs::path(files[k]).filename().string());
  EXPECT_TRUE(files_in(out / "").empty());
}

std::string textured(const std::string& file) {
  return point_camera("0,0,3", "0,0,0", 8, 40) +
         "<shape type=\"rectangle\"><bsdf type=\"diffuse\"><texture type=\"bitmap\" name=\"reflectance\">"
         "<string name=\"filename\" value=\"" +
         file + "\"/></texture></bsdf></shape><emitter type=\"constant\"/>";
}

TEST(BadInput, Textures) {
  const TemporaryFolder folder, out;
  image::LayeredImage image;
  image.color = image::Image(64, 64);
  for (std::size_t p = 0; p < image.color.pixels.size(); ++p)
    image.color.pixels[p] = Rgb(static_cast<float>(p % 61) / 61);
  for (const char* extension : {"exr", "png", "pfm"}) {
    const std::string whole = folder / (std::string("whole.") + extension),
                      half = folder / (std::string("half.") + extension);
    image::write_image(whole, image);
    const std::string bytes = read_text(whole);
    EXPECT_SUCCESS(lumirank(render_small(write_scene(folder, textured(whole)), folder / "good.exr")));
    for (const std::size_t length : {bytes.size() / 2, std::size_t{10}, std::size_t{0}}) {
      { std::ofstream(half, std::ios::binary) << bytes.substr(0, length); }
      expect_refused(lumirank(render_small(write_scene(folder, textured(half)), out / "a.exr")),
                     std::string("half.") + extension, std::to_string(length) + " bytes: ");
    }
  }
  expect_refused(lumirank(render_small(write_scene(folder, textured("none.png")), out / "a.exr")),
                 "none.png");
  // A header that promises 65,535 × 65,535 pixels of 48 bits.
  std::string huge = read_text(folder / "whole.png");
  for (const std::size_t at : {16u, 20u}) huge.replace(at, 4, std::string("\x00\x00\xff\xff", 4));
  { std::ofstream(folder / "huge.png", std::ios::binary) << huge; }
  expect_refused(lumirank(render_small(write_scene(folder, textured("huge.png")), out / "a.exr")),
                 "huge.png");
  // A picture in name only.
  { std::ofstream(folder / "text.jpg") << "not an image"; }
  expect_refused(lumirank(render_small(write_scene(folder, textured("text.jpg")), out / "a.exr")),
                 "text.jpg");
  EXPECT_TRUE(files_in(out / "").empty());
}

TEST(BadInput, NumbersThatAreNone) {
  const TemporaryFolder folder, out;
  for (const char* wrong : {"nan", "inf", "1e999", "-nan"}) {
    const std::string scene =
        write_scene(folder, point_camera("0,0,3", "0,0,0", 8, 40) +
                                "\n<shape type=\"sphere\"><transform name=\"to_world\">\n<translate x=\"" +
                                wrong + "\"/></transform></shape>");
    expect_refused(lumirank(render_small(scene, out / "a.exr")), "scene.xml:4");
  }
  for (const char* shape :
       {"<shape type=\"sphere\"><float name=\"radius\" value=\"-1\"/></shape>",
        "<shape type=\"cylinder\"><float name=\"radius\" value=\"-2\"/></shape>",
        "<shape type=\"cube\"><transform name=\"to_world\"><scale value=\"0\"/></transform></shape>"})
    expect_refused(
        lumirank(render_small(write_scene(folder, point_camera("0,0,3", "0,0,0", 8, 40) + "\n" + shape),
                              out / "a.exr")),
        "scene.xml:3", shape);
  EXPECT_TRUE(files_in(out / "").empty());
}

TEST(BadInput, AnEmptySceneIsRefused) {
  const TemporaryFolder folder, out;
  expect_refused(lumirank(render_small(write_scene(folder, ""), out / "a.exr")), "scene.xml");
  expect_refused(
      lumirank(render_small(write_scene(folder, point_camera("0,0,3", "0,0,0", 8, 40)), out / "a.exr")),
      "scene.xml");
  EXPECT_TRUE(files_in(out / "").empty());
}

// What a scene may well be, though hardly meant: it renders, with a warning.
TEST(OddInput, NoLightIsBlackWithAWarning) {
  const TemporaryFolder folder;
  const std::string file = folder / "a.exr";
  for (const char* method : {"auto", "brute-force", "instant-radiosity", "power-sampling"}) {
    const Outcome outcome = lumirank(
        render_small(write_scene(folder, point_camera("0,0,3", "0,0,0", 8, 40) + "<shape type=\"sphere\"/>"),
                     file) +
        Arguments{"--method", method});
    EXPECT_SUCCESS(outcome) << method;
    EXPECT_NE(outcome.err.find("warning: "), std::string::npos) << method;
    EXPECT_EQ(mean(read_pixels(file)), 0) << method;
  }
}

TEST(OddInput, TrianglesWithoutAreaAreANote) {
  const TemporaryFolder folder;
  const std::string file = folder / "a.exr", mesh = folder / "flat.obj";
  // A good triangle, and one whose corners lie on a line.
  { std::ofstream(mesh) << "v 0 0 0\nv 1 0 0\nv 2 0 0\nv 0 1 0\nf 1 2 3\nf 1 2 4\n"; }
  const std::string shape =
      "<shape type=\"obj\"><string name=\"filename\" value=\"flat.obj\"/></shape><emitter "
      "type=\"constant\"/>";
  const std::string scene = write_scene(folder, point_camera("0,0,3", "0,0,0", 8, 40) + shape);
  const Outcome outcome = lumirank(render_small(scene, file) + Arguments{"--strict"});
  EXPECT_SUCCESS(outcome);
  EXPECT_EQ(outcome.err.find("warning: "), std::string::npos) << outcome.err;
  EXPECT_TRUE(all_finite(read_pixels(file)));
  const Outcome verbose = lumirank(render_small(scene, file) + Arguments{"--verbose"});
  EXPECT_NE(verbose.err.find("1 degenerate triangle left out"), std::string::npos) << verbose.err;
  const Outcome text = lumirank({"info", scene}), json = lumirank({"info", scene, "--json"});
  EXPECT_NE(text.out.find("1 degenerate triangle left out"), std::string::npos) << text.out;
  const auto info = nlohmann::json::parse(json.out);
  EXPECT_TRUE(info.at("warnings").empty()) << json.out;
  ASSERT_EQ(info.at("notes").size(), 1u) << json.out;
}

TEST(OddInput, AMeshOfNothingIsLeftOutAndThatIsSaidOnce) {
  const TemporaryFolder folder;
  { std::ofstream(folder / "point.obj") << "v 0 0 0\nv 0 0 0\nv 0 0 0\nf 1 2 3\n"; }
  const std::string shape = "<shape type=\"obj\"><string name=\"filename\" value=\"point.obj\"/></shape>";
  const std::string rest = "<shape type=\"sphere\"/><emitter type=\"constant\"/>";
  const Outcome outcome = lumirank(render_small(
      write_scene(folder, point_camera("0,0,3", "0,0,0", 8, 40) + shape + rest), folder / "a.exr"));
  EXPECT_SUCCESS(outcome);
  const std::size_t at = outcome.err.find("left out");
  ASSERT_NE(at, std::string::npos) << outcome.err;
  EXPECT_EQ(outcome.err.find("left out", at + 1), std::string::npos) << outcome.err;
}

TEST(OddInput, AViewOfNothingShowsTheBackground) {
  const TemporaryFolder folder;
  const std::string file = folder / "a.exr";
  const std::string away = point_camera("0,0,3", "0,0,9", 8, 40) +
                           "<shape type=\"sphere\"/><emitter type=\"constant\"><rgb name=\"radiance\" "
                           "value=\"0.25, 0.5, 1\"/></emitter>";
  for (const char* method : {"auto", "brute-force", "instant-radiosity", "power-sampling"}) {
    const Outcome outcome =
        lumirank(render_small(write_scene(folder, away), file) + Arguments{"--method", method});
    EXPECT_SUCCESS(outcome) << method;
    const Pixels p = read_pixels(file);
    for (std::size_t k = 0; k < 120; ++k) {
      EXPECT_NEAR(p.channels.at("R")[k], 0.25, 1e-5);
      EXPECT_NEAR(p.channels.at("B")[k], 1, 1e-5);
    }
  }
}

}  // namespace
}  // namespace lumirank::test
