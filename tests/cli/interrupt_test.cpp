// Ctrl-C: what was finished is written and said; before that, nothing is.
#include <gtest/gtest.h>

#include <csignal>
#include <filesystem>

#include "image/atomic_file.h"
#include "process.h"
#include "program.h"

namespace lumirank::test {
namespace {

namespace fs = std::filesystem;

// Far more work than a test waits for.
const Arguments kLong = {"--size", "200x200", "--lights", "400000", "--method", "brute-force"};

TEST(Interrupt, KeepsThePictureSoFar) {
  const TemporaryFolder folder;
  const std::string file = folder / "a.exr", preview = folder / "p.png", report = folder / "r.json";
  const Outcome outcome = interrupted(
      Arguments{"render", example("box"), "-o", file, "--preview", preview, "--report", report} + kLong,
      [&](pid_t) { return fs::exists(preview); });
  EXPECT_EQ(outcome.code, 130) << outcome.err;
  EXPECT_EQ(outcome.out, "");
  EXPECT_NE(outcome.err.find("interrupted"), std::string::npos);
  EXPECT_NE(outcome.err.find(file), std::string::npos) << "says where it is";
  const Pixels picture = read_pixels(file);
  EXPECT_EQ(picture.width, 200);
  EXPECT_TRUE(all_finite(picture));
  EXPECT_GT(mean(picture), 0);
  EXPECT_EQ(read_pixels(preview).width, 200);
  EXPECT_EQ(read_json(report)["stopped"], "cancelled");
  EXPECT_LT(read_json(report)["sampling_rate"], 1);
  EXPECT_EQ(files_in(folder / "").size(), 3u) << "no temporary file is left";
}

TEST(Interrupt, LeavesOutLayersThatWereNotComputed) {
  const TemporaryFolder folder;
  const std::string file = folder / "a.exr", preview = folder / "p.png";
  const Outcome outcome = interrupted(
      Arguments{"render", example("box"), "-o", file, "--preview", preview, "--aov", "albedo,light:*"} +
          kLong,
      [&](pid_t) { return fs::exists(preview); });
  EXPECT_EQ(outcome.code, 130) << outcome.err;
  EXPECT_NE(outcome.err.find("light:*"), std::string::npos) << outcome.err;
  const Pixels picture = read_pixels(file);
  EXPECT_GT(mean(picture), 0);
  EXPECT_TRUE(picture.channels.contains("albedo.R"));
  EXPECT_FALSE(picture.channels.contains("light:lamp.R"));
}

TEST(Interrupt, BeforeAnythingIsFinishedWritesNothing) {
  const TemporaryFolder folder;
  for (const char* command : {"render", "reference"}) {
    const Outcome outcome = interrupted({command, example("lamps"), "-o", folder / "a.exr", "--report",
                                         folder / "r.json", "--size", "1500x1500"},
                                        catches_interrupts);
    EXPECT_EQ(outcome.code, 130) << outcome.err;
    EXPECT_NE(outcome.err.find("nothing was written"), std::string::npos) << outcome.err;
    EXPECT_TRUE(files_in(folder / "").empty()) << command;
  }
}

TEST(Interrupt, TheReferenceKeepsItsPasses) {
  const TemporaryFolder folder;
  const std::string file = folder / "a.exr", preview = folder / "p.png";
  const Outcome outcome = interrupted(
      {"reference", example("box"), "-o", file, "--preview", preview, "--size", "60x60", "--spp", "1000000"},
      [&](pid_t) { return fs::exists(preview); });
  EXPECT_EQ(outcome.code, 130) << outcome.err;
  EXPECT_NE(outcome.err.find("interrupted"), std::string::npos);
  EXPECT_NE(outcome.out.find("paths per pixel; stated relative L1 error"), std::string::npos);
  const Pixels picture = read_pixels(file);
  EXPECT_TRUE(all_finite(picture));
  EXPECT_GT(mean(picture), 0);
}

TEST(Interrupt, AComparisonKeepsItsRuns) {
  const TemporaryFolder folder;
  const std::string out = folder / "out", results = out + "/results.json";
  const Outcome outcome = interrupted(
      {"compare", example("box"), "-o", out, "--methods", "instant-radiosity,brute-force", "--set",
       "lights=40", "--reference", "brute-force:64", "--size", "200x200", "--lights", "200000"},
      [&](pid_t) { return fs::exists(results); });
  EXPECT_EQ(outcome.code, 130) << outcome.err;
  EXPECT_NE(outcome.err.find(out), std::string::npos) << "says where they are";
  const auto json = read_json(results);
  ASSERT_EQ(json["runs"].size(), 1u);
  EXPECT_EQ(json["runs"][0]["method"], "instant-radiosity");
  EXPECT_TRUE(fs::exists(out + "/" + json["runs"][0]["image"].get<std::string>()));
  EXPECT_NE(read_text(out + "/index.html").find("Interrupted: 1 of 2 runs"), std::string::npos);
  EXPECT_TRUE(fs::exists(out + "/results.csv"));
}

// In the middle of writing: the process ends at once, and takes its temporary files along.
TEST(Interrupt, ASecondOneLeavesNoTemporaryFile) {
  const TemporaryFolder folder;
  const auto twice = [&] {
    cli::prepare_process();
    const image::AtomicFile first(folder / "a.exr"), second(folder / "b.exr");
    if (files_in(folder / "").size() == 2) raise(SIGINT);
    raise(SIGTERM);
  };
  EXPECT_EXIT(twice(), testing::ExitedWithCode(130), "");
  EXPECT_TRUE(files_in(folder / "").empty());
}

}  // namespace
}  // namespace lumirank::test
