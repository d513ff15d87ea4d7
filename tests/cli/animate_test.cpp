// animate: what the command line adds to the library's shots (tests/api/animate_test.cpp).
#include <gtest/gtest.h>

#include "program.h"

namespace lumirank::test {
namespace {

class AnimateCommand : public testing::Test {
 protected:
  // A ball that moves for three frames.
  Arguments shot_of(const std::string& name, const Arguments& more = {}) const {
    return Arguments{"animate", scene_, "-o", folder_ / name, "--format", "pfm", "--film-samples", "0"} +
           Arguments{"--size", "12x10", "--spp", "1", "--lights", "300", "--rest", "skip"} + more;
  }

  const TemporaryFolder folder_;
  const std::string scene_ = write_scene(
      folder_,
      small_room("<shape type=\"sphere\"><float name=\"radius\" value=\"0.2\"/><animation name=\"to_world\">"
                 "<transform time=\"0\"><translate x=\"-0.1\"/></transform>"
                 "<transform time=\"0.1\"><translate x=\"0.1\"/></transform></animation></shape>"));
};

TEST_F(AnimateCommand, ByDefaultTensorClusteringAndItsReportsAreReplayed) {
  EXPECT_SUCCESS(lumirank(shot_of("a")));
  const auto report = read_json(folder_ / "a/frame_0001.json");
  EXPECT_EQ(report["method"], "tensor-clustering");
  EXPECT_EQ(report["parameters"]["method"], "tensor-clustering");
  EXPECT_EQ(report["parameters"]["set"]["columns"], "500");

  // --set beside a report wins, and its other parameters stay.
  const std::string few = folder_ / "few", again = folder_ / "again";
  EXPECT_SUCCESS(lumirank(
      shot_of("few", {"--replay", folder_ / "a/frame_0001.json", "--set", "columns=3", "--set", "rows=5"})));
  const auto set = read_json(few + "/frame_0001.json")["parameters"]["set"];
  EXPECT_EQ(set["columns"], "3");
  EXPECT_EQ(set["memory"], "6000");
  EXPECT_SUCCESS(lumirank(shot_of("again", {"--replay", few + "/frame_0001.json"})));
  EXPECT_EQ(read_text(again + "/frame_0001.pfm"), read_text(few + "/frame_0001.pfm"));
  EXPECT_NE(read_text(again + "/frame_0001.pfm"), read_text(folder_ / "a/frame_0001.pfm"));
}

TEST_F(AnimateCommand, OneByOneWhereAMethodIsNamed) {
  EXPECT_SUCCESS(lumirank(shot_of("a", {"--method", "slice-cuts"})));
  EXPECT_EQ(read_json(folder_ / "a/frame_0001.json")["method"], "slice-cuts");
}

TEST_F(AnimateCommand, RefusesWhatTensorClusteringDoesNotHave) {
  const auto refused = [&](const Arguments& more, const std::string& phrase) {
    expect_refused(lumirank(shot_of("no", more)), phrase);
    EXPECT_EQ(files_in(folder_ / "").size(), 1u) << "the scene's file";
  };
  refused({"--method", "tensor-clustering", "--set", "colums=3"},
          "tensor-clustering has no parameter 'colums'");
  refused({"--method", "tensor-clustering", "--set", "columns=-3"}, "--set columns");
  refused({"--method", "tensor-clustering", "--time", "3"}, "it keeps no time budget");
  expect_refused(lumirank({"render", scene_, "-o", folder_ / "a.png", "--method", "tensor-clustering"}),
                 "makes the frames of a shot together");
}

}  // namespace
}  // namespace lumirank::test
