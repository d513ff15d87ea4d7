// A converted scene renders to the same bits.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "lumirank/convert.h"
#include "support/scene_file.h"

namespace lumirank {
namespace {

TEST(Convert, TheConvertedSceneHasTheSamePicture) {
  for (const char* name : {"box", "interior", "lamps"}) {
    const test::TemporaryFolder folder;
    const Scene scene = Scene::load(std::string(LUMIRANK_EXAMPLES) + "/" + name + ".xml");
    convert(scene, folder / "out.xml");
    const Scene again = Scene::load(folder / "out.xml", {.defines = {}, .strict = true});
    RenderSettings settings;
    settings.width = 24, settings.height = 16, settings.spp = 1;
    settings.lights = 300;
    settings.method = "brute-force";
    EXPECT_EQ(render(scene, settings).picture.planes[0].rgb, render(again, settings).picture.planes[0].rgb)
        << name;
  }
}

TEST(Convert, DoesNotOverwriteWhatItReads) {
  const test::TemporaryFolder folder;
  const std::string file = folder / "room.xml";
  std::filesystem::copy_file(std::string(LUMIRANK_EXAMPLES) + "/box.xml", file);
  const Scene scene = Scene::load(file);
  EXPECT_THROW(convert(scene, file), InputError);
  EXPECT_THROW(convert(scene, folder / "room.obj"), InputError);
  EXPECT_THROW(convert(scene, folder / "nowhere/room.xml"), InputError);
  EXPECT_EQ(convert(scene, folder / "other.xml").size(), 1u);
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder / ""), {}), 2);
}

}  // namespace
}  // namespace lumirank
