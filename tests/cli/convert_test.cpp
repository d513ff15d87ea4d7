// convert: what it writes, says and refuses.
#include <gtest/gtest.h>

#include "program.h"

namespace lumirank::test {
namespace {

TEST(ConvertCommand, WritesASceneThatRendersToTheSamePicture) {
  const TemporaryFolder folder;
  const std::string out = folder / "out.xml";
  const Outcome outcome = lumirank({"convert", example("box"), out});
  EXPECT_SUCCESS(outcome);
  EXPECT_NE(outcome.out.find("out.xml and 0 files beside it"), std::string::npos) << outcome.out;
  EXPECT_EQ(outcome.err, "");
  EXPECT_EQ(files_in(folder / ""), (std::vector<std::string>{"out.xml"}));
  EXPECT_SUCCESS(lumirank(render_small(example("box"), folder / "a.exr")));
  EXPECT_SUCCESS(lumirank(render_small(out, folder / "b.exr") + Arguments{"--strict"}));
  EXPECT_EQ(read_pixels(folder / "a.exr"), read_pixels(folder / "b.exr"));
}

// Meshes that the scene file itself holds are written beside the XML, and named relative to it: the folder
// may move.
TEST(ConvertCommand, WritesMeshesBesideIt) {
  const TemporaryFolder folder;
  std::ofstream(folder / "scene.pbrt")
      << "Camera \"perspective\"\nFilm \"rgb\" \"integer xresolution\" 8 \"integer yresolution\" "
         "8\nWorldBegin\n"
         "AreaLightSource \"diffuse\"\nShape \"trianglemesh\" \"point3 P\" [ -1 -1 3  1 -1 3  0 1 3 ]\n";
  const Outcome outcome = start_lumirank({"convert", "scene.pbrt", "new.xml"}, folder / "");
  EXPECT_SUCCESS(outcome);
  EXPECT_NE(outcome.out.find("new.xml and 1 files"), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.err.find("photometric"), std::string::npos) << outcome.err;
  const auto files = files_in(folder / "");
  ASSERT_EQ(files.size(), 3u);
  const std::string mesh = files[0];
  EXPECT_TRUE(mesh.starts_with("new.") && mesh.ends_with(".ply")) << mesh;
  EXPECT_NE(read_text(folder / "new.xml").find("\"" + mesh + "\""), std::string::npos);
  EXPECT_SUCCESS(start_lumirank({"info", "new.xml", "--strict"}, folder / ""));
  EXPECT_EQ(start_lumirank({"convert", "scene.pbrt", "new.xml", "--quiet"}, folder / "").out, "");
}

TEST(ConvertCommand, Refuses) {
  const TemporaryFolder folder;
  const std::string scene = write_scene(folder, small_room());
  expect_refused(lumirank({"convert", scene}), "output");
  expect_refused(lumirank({"convert", scene, folder / "a.glb"}), ".xml");
  expect_refused(lumirank({"convert", scene, scene}), "is an input");
  expect_refused(lumirank({"convert", scene, folder / "nowhere/a.xml"}), "nowhere");
  expect_refused(lumirank({"convert", folder / "none.xml", folder / "a.xml"}), "none.xml");
  const std::string phong =
      write_scene(folder, small_room() + "<shape type=\"cube\"><bsdf type=\"phong\"/></shape>", "phong.xml");
  expect_refused(lumirank({"convert", phong, folder / "a.xml", "--strict"}), "Phong");
  EXPECT_EQ(files_in(folder / ""), (std::vector<std::string>{"phong.xml", "scene.xml"}));
}

}  // namespace
}  // namespace lumirank::test
