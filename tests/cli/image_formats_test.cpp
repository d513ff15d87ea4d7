// Image formats that the program does not read by itself, and what reading them needs.
#include <sys/wait.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "cli/program.h"

namespace lumirank::test {
namespace {
namespace fs = std::filesystem;

// A shell command's exit code and what it prints.
Outcome shell(const std::string& command) {
  Outcome outcome;
  std::FILE* pipe = popen((command + " 2>&1").c_str(), "r");
  std::array<char, 4096> buffer{};
  for (std::size_t n = 0; (n = std::fread(buffer.data(), 1, buffer.size(), pipe)) > 0;)
    outcome.out.append(buffer.data(), n);
  const int status = pclose(pipe);
  outcome.code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  return outcome;
}

// The dynamic linker lists what it would load, and starts nothing.
TEST(ImageFormats, TheProgramStartsWithoutOpenImageIo) {
  const Outcome outcome = shell(std::string("LD_TRACE_LOADED_OBJECTS=1 '") + LUMIRANK_PROGRAM + "'");
  EXPECT_NE(outcome.out.find("libembree"), std::string::npos) << outcome.out;
  EXPECT_EQ(outcome.out.find("libOpenImageIO"), std::string::npos) << outcome.out;
}

TEST(ImageFormats, OthersNeedTheModule) {
  const TemporaryFolder folder;
  // A Targa file of 2 x 1 pixels, 24 bits each.
  const std::string tga("\0\0\2\0\0\0\0\0\0\0\0\0\2\0\1\0\30\0\377\0\0\0\0\377", 24);
  { std::ofstream(folder / "a.tga", std::ios::binary) << tga; }
  const std::string scene = write_scene(
      folder, small_room("<shape type=\"rectangle\"><bsdf type=\"diffuse\"><texture type=\"bitmap\" "
                         "name=\"reflectance\"><string name=\"filename\" value=\"a.tga\"/></texture></bsdf>"
                         "</shape>"));
  const auto run = [&](const fs::path& program) {
    return shell("'" + program.string() + "' info '" + scene + "'");
  };
  EXPECT_EQ(run(LUMIRANK_PROGRAM).code, 0);

  // Alone, and then as it is installed.
  const fs::path bin = fs::path(folder / "bin"), lib = fs::path(folder / "lib") / "lumirank";
  const char* module = "lumirank_other_images.so";
  fs::create_directory(bin);
  fs::copy_file(LUMIRANK_PROGRAM, bin / "lumirank");
  const Outcome alone = run(bin / "lumirank");
  EXPECT_EQ(alone.code, 2);
  for (const char* part : {"a.tga", "OpenImageIO, which cannot be loaded", "PNG"})
    EXPECT_NE(alone.out.find(part), std::string::npos) << alone.out;
  fs::create_directories(lib);
  fs::copy_file(fs::path(LUMIRANK_PROGRAM).parent_path() / "lib" / "lumirank" / module, lib / module);
  EXPECT_EQ(run(bin / "lumirank").code, 0);
  { std::ofstream(lib / module) << "not a library"; }
  const Outcome broken = run(bin / "lumirank");
  EXPECT_EQ(broken.code, 2);
  EXPECT_NE(broken.out.find(module), std::string::npos) << broken.out;
}

}  // namespace
}  // namespace lumirank::test
