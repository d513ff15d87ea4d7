// `lumirank compare` from outside.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <set>

#include "program.h"

namespace lumirank::test {
namespace {

namespace fs = std::filesystem;

class Compare : public testing::Test {
 protected:
  TemporaryFolder folder_;
  std::string scene_ = write_scene(folder_, small_room());
  std::string out_ = folder_ / "out";
  Arguments base_ = {"compare", scene_, "-o", out_, "--size", "12x10", "--lights", "400"};
};

TEST_F(Compare, SweepsAndSeedsAgainstAllColumns) {
  const Outcome outcome =
      lumirank(base_ + Arguments{"--methods", "power-sampling,row-column-sampling,brute-force", "--reference",
                                 "brute-force", "--sweep", "power-sampling.columns=8,64", "--sweep",
                                 "row-column-sampling.rows:columns=20:10,40:40", "--seeds", "2",
                                 "--singular-values", "--equal", "rays"});
  EXPECT_SUCCESS(outcome);
  EXPECT_NE(outcome.out.find(out_ + "/index.html"), std::string::npos);
  const auto json = read_json(out_ + "/results.json");
  ASSERT_EQ(json["runs"].size(), (2u + 2u + 1u) * 2u);
  EXPECT_EQ(json["width"], 12);
  std::map<std::string, double> rays;
  std::set<std::string> images;
  for (const auto& run : json["runs"]) {
    for (const char* key : {"relative_l1", "relative_l2", "rmse", "relmse", "bias", "flip"})
      ASSERT_TRUE(run["error"][key].is_number()) << key;
    const double rate = run["sampling_rate"], l2 = run["error"]["relative_l2"];
    EXPECT_GE(rate, 0);
    EXPECT_LE(run["rays"], run["entries"]);
    EXPECT_GE(run["seconds"], 0);
    EXPECT_TRUE(run["seed"] == 1 || run["seed"] == 2);
    rays[run["label"].get<std::string>()] += run["rays"].get<double>();
    for (const char* key : {"image", "error_image"}) {
      images.insert(run[key].get<std::string>());
      EXPECT_EQ(read_pixels(out_ + "/" + run[key].get<std::string>()).width, 12);
    }
    // The same columns in the same order as the reference's: no error but rounding in another order.
    if (run["method"] == "brute-force") {
      EXPECT_LT(l2, 400 * std::ldexp(1.0, -23));
      EXPECT_EQ(rate, 1);
    } else {
      EXPECT_GT(l2, 0);
    }
  }
  EXPECT_EQ(images.size(), 2 * json["runs"].size()) << "no run's image is another's";
  EXPECT_LT(rays.at("power-sampling columns=8"), rays.at("power-sampling columns=64"));
  EXPECT_LT(rays.at("row-column-sampling rows=20 columns=10"),
            rays.at("row-column-sampling rows=40 columns=40"));
  const auto values = json["singular_values"].get<std::vector<double>>();
  EXPECT_GT(values.size(), 100u);
  EXPECT_TRUE(std::is_sorted(values.rbegin(), values.rend()));
  EXPECT_GT(values[0], 0);

  const std::string csv = read_text(out_ + "/results.csv"), page = read_text(out_ + "/index.html");
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 1 + 10);
  for (const char* method : {"power-sampling", "row-column-sampling", "brute-force"}) {
    EXPECT_NE(csv.find(method), std::string::npos);
    EXPECT_NE(page.find(method), std::string::npos);
  }
  EXPECT_NE(page.find("At equal rays"), std::string::npos);
  for (const char* network : {"src=\"http", "href=\"http", "url(http", "@import"})
    EXPECT_EQ(page.find(network), std::string::npos) << network;
}

TEST_F(Compare, TimesAndLightsAgainstASample) {
  const Outcome outcome = lumirank(base_ + Arguments{"--methods", "row-column-sampling,instant-radiosity",
                                                     "--reference", "brute-force:64", "--times", "0.05,0.1"});
  EXPECT_SUCCESS(outcome);
  const auto json = read_json(out_ + "/results.json");
  ASSERT_EQ(json["runs"].size(), 4u);
  EXPECT_NE(json["reference"]["kind"].get<std::string>().find("stratified pixels"), std::string::npos);
  EXPECT_EQ(json["runs"][0]["label"], "row-column-sampling 0.05 s");
  EXPECT_TRUE(json["runs"][0]["error"]["relmse"].is_number());
  EXPECT_TRUE(json["runs"][0]["error"]["flip"].is_null()) << "of single pixels";
  EXPECT_EQ(read_text(out_ + "/index.html").find("value=\"flip\""), std::string::npos);

  EXPECT_SUCCESS(lumirank(base_ + Arguments{"--methods", "brute-force", "--reference", "brute-force:64",
                                            "--sweep", "lights=100,200"}));
  const auto again = read_json(out_ + "/results.json");
  ASSERT_EQ(again["runs"].size(), 2u) << "run again into the same folder";
  EXPECT_LT(again["runs"][0]["entries"], again["runs"][1]["entries"]);
}

TEST_F(Compare, AgainstAPathTracerAndAFile) {
  EXPECT_SUCCESS(lumirank(base_ + Arguments{"--methods", "instant-radiosity", "--reference", "path",
                                            "--reference-time", "0.2", "--set", "lights=50"}));
  const auto traced = read_json(out_ + "/results.json");
  EXPECT_GT(traced["reference"]["relative_l1"], 0);
  const std::string truth = out_ + "/reference.exr";
  EXPECT_EQ(read_pixels(truth).width, 12);
  const std::string other = folder_ / "other";
  EXPECT_SUCCESS(lumirank({"compare", scene_, "-o", other, "--size", "12x10", "--methods",
                           "instant-radiosity", "--reference", truth, "--set", "lights=50"}));
  const auto from_file = read_json(other + "/results.json");
  EXPECT_EQ(from_file["runs"][0]["error"]["relative_l2"], traced["runs"][0]["error"]["relative_l2"])
      << "the same image, lights and reference";
}

TEST_F(Compare, WhatIsRefusedLeavesNoFolder) {
  EXPECT_SUCCESS(lumirank({"reference", scene_, "-o", folder_ / "small.pfm", "--size", "4x4", "--spp", "2"}));
  struct Case {
    Arguments more;
    const char* phrase;
  };
  const Case cases[] = {
      {{"--methods", "magic"}, "there is no method 'magic'; methods: brute-force"},
      {{"--methods", ","}, "empty part"},
      {{"--sweep", "row-column-sampling.lamps=1,2"}, "valid parameters: rows, columns"},
      {{"--sweep", "brute-force.x=1"}, "--methods"},
      {{"--sweep", "lamps=1"}, "METHOD.KEY, lights or spp"},
      {{"--sweep", "lights"}, "KEY=VALUE"},
      {{"--sweep", "lights="}, "no values"},
      {{"--sweep", "spp=0"}, "spp"},
      {{"--sweep", "row-column-sampling.rows:columns=1:2:3"}, "3 parts for 2"},
      {{"--seeds", "0"}, "seeds"},
      {{"--times", "x"}, "times"},
      {{"--times", "-1"}, "times"},
      {{"--equal", "luck"}, "equal"},
      {{"--method", "brute-force"}, "--method"},
      {{"--reference", "none.exr"}, "none.exr"},
      {{"--reference", "brute-force:3"}, "at least 64"},
      {{"--reference", folder_ / "small.pfm"}, "4x4 pixels, the render 12x10"},
  };
  std::vector<Arguments> runs;
  for (const Case& c : cases) runs.push_back(base_ + c.more);
  const auto outcomes = lumirank_each(runs);
  for (std::size_t k = 0; k < runs.size(); ++k)
    expect_refused(outcomes[k], cases[k].phrase, cases[k].more[0] + " " + cases[k].more[1] + " ");
  EXPECT_FALSE(fs::exists(out_));
}

}  // namespace
}  // namespace lumirank::test
