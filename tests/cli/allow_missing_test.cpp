// --allow-missing through the whole program: what the scene lacks is an error that names the option, and with
// it a warning, a picture and a count.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "program.h"

namespace lumirank::test {
namespace {

TEST(AllowMissing, TurnsTheErrorIntoAWarningAndACount) {
  const TemporaryFolder folder;
  const std::string scene = write_scene(
      folder,
      point_camera("0,0,3", "0,0,0", 8, 40) +
          "<shape type=\"rectangle\"><bsdf type=\"diffuse\"><texture type=\"bitmap\" name=\"reflectance\">"
          "<string name=\"filename\" value=\"absent.png\"/></texture></bsdf></shape>"
          "<shape type=\"obj\"><string name=\"filename\" value=\"absent.obj\"/></shape>"
          "<emitter type=\"constant\"/>");
  const std::string file = folder / "a.exr", report = folder / "a.json";
  const Outcome refused = lumirank(render_small(scene, file));
  EXPECT_EQ(refused.code, 2);
  EXPECT_NE(refused.err.find("--allow-missing"), std::string::npos) << refused.err;
  const Outcome outcome =
      lumirank(render_small(scene, file) + Arguments{"--allow-missing", "--report", report});
  EXPECT_SUCCESS(outcome);
  EXPECT_NE(outcome.err.find("warning: "), std::string::npos) << outcome.err;
  EXPECT_NE(outcome.err.find("absent.png"), std::string::npos) << outcome.err;
  EXPECT_NE(outcome.err.find("absent.obj"), std::string::npos) << outcome.err;
  EXPECT_EQ(nlohmann::json::parse(read_text(report)).at("meshes.left_out"), 1);
  EXPECT_GT(mean(read_pixels(file)), 0);
  const Outcome info = lumirank({"info", scene, "--json", "--allow-missing"});
  EXPECT_EQ(nlohmann::json::parse(info.out).at("meshes.left_out"), 1) << info.out;
}

}  // namespace
}  // namespace lumirank::test
