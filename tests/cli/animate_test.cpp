// animate: what the command line adds to the library's shots (tests/api/animate_test.cpp).
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

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

TEST_F(AnimateCommand, ReportsOfTensorClusteringAreReplayed) {
  EXPECT_SUCCESS(lumirank(shot_of("a", {"--method", "tensor-clustering", "--set", "columns=500"})));
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
  EXPECT_EQ(set["chunk"], "40");
  EXPECT_SUCCESS(lumirank(shot_of("again", {"--replay", few + "/frame_0001.json"})));
  EXPECT_EQ(read_text(again + "/frame_0001.pfm"), read_text(few + "/frame_0001.pfm"));
  EXPECT_NE(read_text(again + "/frame_0001.pfm"), read_text(folder_ / "a/frame_0001.pfm"));
}

TEST_F(AnimateCommand, ByDefaultFramesAreAveragedWithTheirNeighbors) {
  const Arguments quick{"--denoise", "off", "--passes", "2"};
  EXPECT_SUCCESS(lumirank(shot_of("a", quick)));
  EXPECT_EQ(read_json(folder_ / "a/frame_0001.json")["shot.averaged"], 3);
  EXPECT_SUCCESS(lumirank(shot_of("b", quick + Arguments{"--temporal-filter", "0"})));
  EXPECT_FALSE(read_json(folder_ / "b/frame_0001.json").contains("shot.averaged"));
  expect_refused(lumirank(shot_of("no", {"--temporal-filter", "1", "--method", "tensor-clustering"})),
                 "tensor clustering has a filter of its own");
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
  refused({"--method", "tensor-clustering", "--set", "columns=-3"}, "'-3' is not a value of 'columns'");
  refused({"--method", "tensor-clustering", "--time", "3"}, "it keeps no time budget");
  expect_refused(lumirank({"render", scene_, "-o", folder_ / "a.png", "--method", "tensor-clustering"}),
                 "makes the frames of a shot together");
}

// Frames are counted from second 0, and the whole motion is that from its first key on.
TEST_F(AnimateCommand, TheWholeMotionBeginsAtItsFirstKey) {
  const std::string late = write_scene(
      folder_,
      small_room("<shape type=\"sphere\"><animation name=\"to_world\"><transform time=\"0.125\"><translate "
                 "x=\"-0.1\"/></transform><transform time=\"0.25\"><translate x=\"0.1\"/></transform>"
                 "</animation></shape>"),
      "late.xml");
  const Arguments small{"--format", "pfm", "--film-samples", "0", "--size", "8x6", "--spp", "1"};
  const Arguments fast{"--lights", "100", "--rest", "skip"};
  EXPECT_SUCCESS(lumirank(Arguments{"animate", late, "-o", folder_ / "late", "--fps", "8"} + small + fast));
  EXPECT_EQ(files_in(folder_ / "late"),
            (std::vector<std::string>{"frame_0001.json", "frame_0001.pfm", "frame_0002.json",
                                      "frame_0002.pfm", "shot.json"}));
  // One picture of a moment that there is not.
  for (const Arguments& when : {Arguments{"--frame", "7", "--fps", "8"}, {"--at", "0.1"}, {"--at", "0.3"}})
    expect_refused(lumirank(Arguments{"render", late, "-o", folder_ / "no.pfm"} + when + fast),
                   "is not within the motion, which goes from 0.125 to 0.25 s");
  EXPECT_SUCCESS(lumirank(Arguments{"render", late, "-o", folder_ / "one.pfm", "--at", "0.25"} + fast));
  expect_refused(lumirank(Arguments{"render", late, "-o", folder_ / "no.pfm", "--clip", "Walk"}),
                 "the file has no clip 'Walk': only glTF has clips");
}

// All files of the scene count, not only the one that is named: else frames of the old mesh would be kept.
TEST_F(AnimateCommand, RefusesFramesOfAnotherMesh) {
  const auto write_mesh = [&](const char* height) {
    std::ofstream(folder_ / "tile.obj") << "v 0 0 0\nv 1 0 0\nv 0 " << height << " 0\nf 1 2 3\n";
  };
  write_mesh("0.5");
  const std::string scene = write_scene(
      folder_,
      small_room("<shape type=\"obj\"><string name=\"filename\" value=\"tile.obj\"/></shape><shape "
                 "type=\"sphere\"><animation name=\"to_world\"><transform time=\"0\"/><transform "
                 "time=\"0.1\"><translate x=\"0.1\"/></transform></animation></shape>"),
      "tiled.xml");
  const Arguments shot = Arguments{"animate", scene, "-o", folder_ / "tiled", "--format", "pfm", "--size"} +
                         Arguments{"8x6", "--spp", "1", "--lights", "100", "--rest"} +
                         Arguments{"skip", "--film-samples", "0"};
  EXPECT_SUCCESS(lumirank(shot));
  const auto before = files_in(folder_ / "tiled");
  EXPECT_SUCCESS(lumirank(shot));  // the same: kept
  write_mesh("0.6");
  expect_refused(lumirank(shot), "scene_fingerprint");
  EXPECT_EQ(files_in(folder_ / "tiled"), before);
}

TEST_F(AnimateCommand, ChunkIsAParameterOfTensorClustering) {
  EXPECT_SUCCESS(lumirank(shot_of("a", {"--chunk", "2", "--method", "tensor-clustering"})));
  EXPECT_EQ(read_json(folder_ / "a/frame_0001.json")["parameters"]["set"]["chunk"], "2");
  expect_refused(lumirank(shot_of("b", {"--chunk", "2", "--method", "slice-cuts"})),
                 "--chunk is of tensor clustering alone");
  EXPECT_FALSE(std::filesystem::exists(folder_ / "b"));
}

// The same lights in all frames, whatever the method, so that methods can be compared.
TEST_F(AnimateCommand, LightsAreTheSameInEveryFrameWhateverTheMethod) {
  EXPECT_SUCCESS(lumirank(shot_of("a", {"--method", "slice-cuts"})));
  EXPECT_EQ(read_json(folder_ / "a/frame_0001.json")["parameters"]["light-placement"], "gather");
  EXPECT_SUCCESS(lumirank(shot_of("b", {"--method", "slice-cuts", "--light-placement", "particles"})));
  EXPECT_EQ(read_json(folder_ / "b/frame_0001.json")["parameters"]["light-placement"], "particles");
}

// A film that cannot be written is refused before any frame is rendered.
TEST_F(AnimateCommand, RefusesAFilmThatCannotBe) {
  const auto refused = [&](const std::string& format, const std::string& film, const std::string& phrase) {
    expect_refused(lumirank({"animate", scene_, "-o", folder_ / "no", "--format", format, "--video", film}),
                   phrase);
    EXPECT_FALSE(std::filesystem::exists(folder_ / "no")) << phrase;
  };
  refused("exr", folder_ / "film.mp4", "add png to --format");
  refused("png", folder_ / "none/film.mp4", "its folder does not exist");
  refused("png", folder_ / "film", "has no ending");
}

}  // namespace
}  // namespace lumirank::test
