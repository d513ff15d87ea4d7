// What every command promises: help with an example, and a refusal that says what would be right.
#include <gtest/gtest.h>

#include <filesystem>
#include <map>

#include "lumirank/lumirank.h"
#include "program.h"

namespace lumirank::test {
namespace {

TEST(Commands, HelpOfEachShowsAnExample) {
  for (const char* command : {"render", "reference", "compare", "convert", "error", "info", "methods"}) {
    const Outcome help = lumirank({command, "--help"});
    EXPECT_SUCCESS(help) << command;
    const auto at = help.out.find("Example");
    ASSERT_NE(at, std::string::npos) << command;
    EXPECT_NE(help.out.find(std::string("lumirank ") + command, at), std::string::npos) << command;
    EXPECT_EQ(help.err, "");
  }
  const Outcome all = lumirank({"--help"});
  EXPECT_SUCCESS(all);
  for (const char* command : {"render", "reference", "compare", "convert", "error", "info", "methods"})
    EXPECT_NE(all.out.find(command), std::string::npos);
}

TEST(Commands, Version) {
  const Outcome version = lumirank({"--version"});
  EXPECT_SUCCESS(version);
  EXPECT_NE(version.out.find('.'), std::string::npos);
  EXPECT_NE(version.out.find(instruction_set()), std::string::npos) << version.out;
}

TEST(Commands, NoArgumentsShowTheUsage) { expect_refused(lumirank({}), "Usage: lumirank"); }

TEST(Commands, UnknownOnesAreRefused) {
  expect_refused(lumirank({"paint"}), "there is no command 'paint'; the commands are render, reference");
  expect_refused(lumirank({"render", "a.xml", "-o", "a.exr", "--loghts", "3"}), "--loghts");
  expect_refused(lumirank({"render", "a.xml"}), "--output");
  expect_refused(lumirank({"render", "-o", "a.exr"}), "scene");
  expect_refused(lumirank({"info", "a.xml", "b.xml"}), "b.xml");
}

TEST(Commands, MethodsAsTextAndJson) {
  const Outcome text = lumirank({"methods"}), json = lumirank({"methods", "--json"});
  EXPECT_SUCCESS(text);
  EXPECT_SUCCESS(json);
  const auto methods = nlohmann::json::parse(json.out);
  ASSERT_GE(methods.size(), 4u);
  for (const auto& method : methods) {
    EXPECT_NE(text.out.find(method.at("name").get<std::string>()), std::string::npos);
    EXPECT_FALSE(method.at("summary").get<std::string>().empty());
    for (const auto& parameter : method.at("parameters")) {
      EXPECT_NE(text.out.find("--set " + parameter.at("key").get<std::string>()), std::string::npos);
      for (const char* key : {"type", "default", "range", "help"})
        EXPECT_TRUE(parameter.contains(key)) << key;
    }
  }
}

// Switches for experiments are listed on request only.
TEST(Commands, MethodsListExperimentsOnRequest) {
  const auto keys = [](const Arguments& arguments) {
    const Outcome outcome = lumirank(arguments);
    EXPECT_SUCCESS(outcome);
    std::map<std::string, bool> found;
    for (const auto& method : nlohmann::json::parse(outcome.out))
      if (method.at("name") == "sampling-recovery")
        for (const auto& p : method.at("parameters"))
          found[p.at("key").get<std::string>()] = p.at("experiment").get<bool>();
    return found;
  };
  const auto some = keys({"methods", "--json"}), all = keys({"methods", "--json", "--all"});
  EXPECT_TRUE(some.contains("alpha"));
  EXPECT_FALSE(some.contains("separation"));
  for (const auto& [key, experiment] : some) EXPECT_FALSE(experiment) << key;
  EXPECT_FALSE(all.at("alpha"));
  EXPECT_TRUE(all.at("separation"));
  EXPECT_EQ(lumirank({"methods"}).out.find("--set separation="), std::string::npos);
  EXPECT_NE(lumirank({"methods"}).out.find("for experiments, which --all lists"), std::string::npos);
  EXPECT_NE(lumirank({"methods", "--all"}).out.find("--set separation="), std::string::npos);
}

// Each is refused before anything is written, with a message that helps.
TEST(Commands, WrongOptionsOfRender) {
  const TemporaryFolder folder;
  const std::string scene = write_scene(folder, small_room());
  struct Case {
    Arguments more;
    const char* phrase;
  };
  const Case cases[] = {
      {{"--method", "magic"}, "brute-force, instant-radiosity"},
      {{"--set", "lamps=3"}, "valid parameters: slice-rows, initial-columns"},
      {{"--set", "rows"}, "KEY=VALUE"},
      {{"--set", "rows=many"}, "rows"},
      {{"--lights", "0"}, "1 …"},
      {{"--lights", "1e3"}, "not a valid number"},
      {{"--light-type", "cube"}, "choose one of"},
      {{"--size", "640"}, "800x600"},
      {{"--size", "0x10"}, "out of range"},
      {{"--size", "-4x10"}, "out of range"},
      {{"--spp", "0"}, "spp"},
      {{"--max-depth", "-2"}, "max-depth"},
      {{"--clamp", "-1"}, "clamp"},
      {{"--clamp", "nan"}, "clamp"},
      {{"--only", "half"}, "all|direct|indirect"},
      {{"--seed", "-1"}, "seed"},
      {{"--threads", "-1"}, "threads"},
      {{"--time", "-1"}, "time"},
      {{"--error", "x"}, "error"},
      {{"--crop", "1,2,3"}, "X,Y,W,H"},
      {{"--crop", "8,0,8,8"}, "beyond the film of 12x10"},
      {{"--camera", "left"}, "there is no camera 'left'"},
      {{"--aov", "beauty"}, "choose from direct, indirect"},
      {{"--illuminance-range", "5"}, "LOW:HIGH"},
      {{"--illuminance-range", "5:5"}, "LOW:HIGH"},
      {{"--aov", "light:moon"}, "there is no light 'moon'; the lights are lamp"},
      {{"--aov", "light:lamp", "--direct", "traced"}, "--direct traced"},
      {{"--define", "x"}, "KEY=VALUE"},
      {{"--exposure", "nan"}, "exposure"},
      {{"--tonemap", "film"}, "reinhard"},
      {{"--quiet", "--verbose"}, "--quiet excludes --verbose"},
      {{"--replay", "no_such.json"}, "no_such.json"},
      {{"--preview", "no_such_folder/p.png"}, "no_such_folder"},
      {{"--report", "no_such_folder/r.json"}, "no_such_folder"},
      {{"-o", "picture.gif"}, ".gif"},
      {{"-o", "picture"}, "extension"},
      {{"-o", "no_such_folder/a.png"}, "the folder no_such_folder does not exist"},
  };
  std::vector<Arguments> runs;
  for (const Case& c : cases) {
    Arguments small = {"render", scene, "-o", folder / "a.exr"};
    if (c.more[0] != "--size") small = small + Arguments{"--size", "12x10"};
    if (c.more[0] != "--lights") small = small + Arguments{"--lights", "300"};
    runs.push_back(small + c.more);
  }
  const auto outcomes = lumirank_each(runs);
  for (std::size_t k = 0; k < runs.size(); ++k)
    expect_refused(outcomes[k], cases[k].phrase, cases[k].more[0] + " ");
  EXPECT_EQ(files_in(folder / ""), (std::vector<std::string>{"scene.xml"}));
}

TEST(Commands, WrongOptionsOfReference) {
  const TemporaryFolder folder;
  const std::string scene = write_scene(folder, small_room());
  struct Case {
    Arguments more;
    const char* phrase;
  };
  const Case cases[] = {
      {{"--spp", "0"}, "spp"},
      {{"--time", "0"}, "time"},
      {{"--error", "-1"}, "error"},
      {{"--paths", "some"}, "columns"},
      {{"--aov", "albedo"}, "direct, indirect and emission"},
      {{"--camera", "left"}, "left"},
  };
  for (const Case& c : cases)
    expect_refused(lumirank(Arguments{"reference", scene, "-o", folder / "a.exr", "--size", "4x4"} + c.more),
                   c.phrase, c.more[0] + " ");
  EXPECT_EQ(files_in(folder / ""), (std::vector<std::string>{"scene.xml"}));
}

TEST(Commands, AFolderThatCannotBeWritten) {
  const TemporaryFolder folder;
  const std::string scene = write_scene(folder, small_room());
  std::filesystem::create_directory(folder / "locked");
  std::filesystem::permissions(folder / "locked",
                               std::filesystem::perms::owner_read | std::filesystem::perms::owner_exec);
  if (std::ofstream(folder / "locked/probe")) GTEST_SKIP() << "permissions do not bind this user";
  expect_refused(lumirank(render_small(scene, folder / "locked/a.exr")), "cannot write");
}

TEST(Commands, AFolderInTheFilesPlace) {
  const TemporaryFolder folder;
  const std::string scene = write_scene(folder, small_room());
  std::filesystem::create_directory(folder / "a.exr");
  expect_refused(lumirank(render_small(scene, folder / "a.exr")), "a folder has this name");
}

}  // namespace
}  // namespace lumirank::test
