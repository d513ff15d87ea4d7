// The typed comparison, scene listing and list of methods.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "api/whole_renders.h"
#include "base/error.h"
#include "lumirank/compare.h"
#include "support/scene_file.h"

namespace lumirank {
namespace {

using test::box;
using test::TemporaryFolder;

CompareSettings small_comparison() {
  CompareSettings settings;
  settings.base.view.width = 16, settings.base.view.height = 12, settings.base.view.spp = 1;
  settings.base.lights.count = 300;
  settings.methods = {"power-sampling", "brute-force"};
  settings.reference.kind = ComparisonReference::Kind::brute_force;
  return settings;
}

TEST(TypedComparison, SaysWhatTheFilesSay) {
  const TemporaryFolder folder;
  CompareSettings settings = small_comparison();
  settings.sweeps.push_back({"power-sampling", {"columns"}, {{"20"}, {"200"}}});
  settings.seeds = 2, settings.equal = EqualCost::rays;
  const Comparison c = compare(box(), settings, folder / "out");
  EXPECT_FALSE(c.interrupted);
  ASSERT_EQ(c.runs.size(), 6u);
  const auto said = nlohmann::json::parse(std::ifstream(folder / "out/results.json"));
  for (std::size_t k = 0; k < 6; ++k) {
    EXPECT_EQ(c.runs[k].label, said["runs"][k]["label"]);
    EXPECT_EQ(c.runs[k].error.relative_l1, said["runs"][k]["error"]["relative_l1"].get<double>());
    EXPECT_TRUE(std::filesystem::exists(folder / ("out/" + c.runs[k].image_file)));
  }
  EXPECT_LT(c.runs[2].error.relative_l2, c.runs[0].error.relative_l2);
  EXPECT_LT(c.runs[4].error.relative_l1, 1e-6);  // the reference's own columns in its order
  ASSERT_EQ(c.notes.size(), 3u);
  EXPECT_EQ(c.notes[0].substr(0, 13), "At equal rays");
}

// In passes a run is the picture that a render has of the same settings: against that one it errs by nothing,
// and another seed does not.
TEST(TypedComparison, PassesAreThoseOfARender) {
  const TemporaryFolder folder;
  CompareSettings settings = small_comparison();
  settings.base.passes = 3;
  settings.base.view.spp.reset();
  settings.methods = {"slice-cuts", "row-guided-sampling"};
  settings.seeds = 2;
  settings.reference.kind = ComparisonReference::Kind::file;
  settings.reference.file = folder / "rendered.pfm";
  for (const char* method : {"slice-cuts", "row-guided-sampling"}) {
    RenderSettings alone = settings.base;
    alone.method.name = method;
    alone.traced.rest = RestOfPaths::skip;
    alone.traced.panes = Panes::exact;
    alone.denoise = Denoise::off;
    const RenderResult rendered = render(box(), alone);
    write_picture(settings.reference.file, rendered.picture);
    const Comparison c = compare(box(), settings, folder / method);
    ASSERT_EQ(c.runs.size(), 4u);
    for (const ComparisonRun& run : c.runs) {
      EXPECT_EQ(run.error.relative_l1 == 0, run.method == method && run.seed == settings.base.seed)
          << method << " against " << run.label << ", seed " << run.seed;
      EXPECT_GT(run.rays, 0);
      if (run.method == method && run.seed == settings.base.seed) {
        EXPECT_EQ(run.settings.at("lights"), std::to_string(rendered.report.sizes->lights));
      }
    }
  }
}

TEST(TypedComparison, RefusesWhatCannotBe) {
  const TemporaryFolder folder;
  const auto refused = [&](const auto& change, const std::string& part) {
    CompareSettings settings = small_comparison();
    change(settings);
    try {
      compare(box(), settings, folder / "out");
      ADD_FAILURE() << part;
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
    }
    EXPECT_FALSE(std::filesystem::exists(folder / "out"));
  };
  using Kind = ComparisonReference::Kind;
  refused([](auto& s) { s.reference = {Kind::receivers, 60, 63, ""}; }, "at least 64");
  refused([](auto& s) { s.base.passes = 2; }, "passes have lights of their own");
  refused([](auto& s) { s.base.denoise = Denoise::on; }, "passes have lights of their own");
  refused([](auto& s) { s.base.passes = 2, s.reference = {Kind::path, 1, 0, ""}; }, "one receiver per pixel");
  refused([](auto& s) { s.reference = {Kind::receivers, 60, 193, ""}; }, "more receivers than the 192");
  refused([](auto& s) { s.reference = {Kind::file, 60, 0, "none.exr"}; }, "none.exr");
  refused([](auto& s) { s.sweeps = {{"", {"seed"}, {{"1"}}}}; }, "cannot be swept");
  refused([](auto& s) { s.sweeps = {{"lightcuts", {"max-nodes"}, {{"1"}}}}; }, "not compared");
  refused([](auto& s) { s.sweeps = {{"power-sampling", {"columns"}, {}}}; }, "has no values");
  refused([](auto& s) { s.sweeps = {{"power-sampling", {"columns"}, {{"1", "2"}}}}; }, "2 parts for 1");
}

TEST(TypedInfo, IsWhatTheJsonSays) {
  const SceneInfo info = box().info();
  EXPECT_EQ(info.triangles, 36u);
  ASSERT_EQ(info.cameras.size(), 1u);
  const auto said = nlohmann::json::parse(info.json());
  EXPECT_EQ(said["triangles"], info.triangles);
  EXPECT_EQ(said["cameras"][0]["fov_x"].get<double>(), info.cameras[0].fov_x);
  EXPECT_NE(info.text().find("36 triangles"), std::string::npos);
  EXPECT_EQ(info.text().find(info.listing), 0u);
}

TEST(TypedMethods, AllOfThemWithTheirParameters) {
  const auto said = nlohmann::json::parse(methods_json(true));
  const std::vector<MethodDescription> methods = list_methods();
  ASSERT_EQ(methods.size(), said.size());
  for (std::size_t k = 0; k < methods.size(); ++k) {
    EXPECT_EQ(methods[k].name, said[k]["name"]);
    EXPECT_EQ(methods[k].parameters.size(), said[k]["parameters"].size());
  }
}

}  // namespace
}  // namespace lumirank
