// Attempts to break the program by its command line, all in one process. Each has its exit code, its words,
// and leaves just what it says: what was there before has not changed by a byte.
#include "attempts.h"

#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>
#include <sys/un.h>

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <map>
#include <set>
#include <sstream>
#include <thread>

#include "image/image_io.h"
#include "pipeline/memory.h"
#include "program.h"

namespace lumirank::test {
namespace {

namespace fs = std::filesystem;

// A device of our own, which a mistake may destroy; where that is not allowed, a link to the system's, which
// then cannot be destroyed either.
void make_full_device(const std::string& file) {
  if (mknod(file.c_str(), S_IFCHR | 0666, makedev(1, 7)) == 0) {
    if (std::FILE* opened = std::fopen(file.c_str(), "w")) return void(std::fclose(opened));
    fs::remove(file);
  }
  fs::create_symlink("/dev/full", file);
}

void make_socket(const std::string& file) {
  const int fd = socket(AF_UNIX, SOCK_STREAM, 0);
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  std::strncpy(address.sun_path, file.c_str(), sizeof address.sun_path - 1);
  EXPECT_EQ(bind(fd, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
  close(fd);
}

void write_picture_file(const std::string& file, int width, int height) {
  image::LayeredImage image;
  image.color = image::Image(width, height, Rgb(0.5f));
  image::write_image(file, image);
}

class Attempts : public testing::Test {
 protected:
  Attempts() {
    const auto text = [&](const char* name, const std::string& content) {
      std::ofstream(folder_ / name) << content;
    };
    write_picture_file(folder_ / "tex.png", 2, 2), write_picture_file(folder_ / "env.exr", 4, 2);
    write_picture_file(folder_ / "old.pfm", 2, 2);
    text("mesh.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    text("steel.spd", "400 0.5\n700 0.6\n");
    text("part.xml",
         "<scene version=\"3.0.0\"><shape type=\"obj\"><string name=\"filename\" value=\"mesh.obj\"/>"
         "<bsdf type=\"diffuse\"><spectrum name=\"reflectance\" "
         "filename=\"steel.spd\"/></bsdf></shape></scene>");
    write_scene(folder_, small_room("<include filename=\"part.xml\"/><shape type=\"rectangle\"><bsdf "
                                    "type=\"diffuse\"><texture type=\"bitmap\" name=\"reflectance\"><string "
                                    "name=\"filename\" value=\"tex.png\"/></texture></bsdf></shape>"));
    text("embedded.pbrt",
         "Camera \"perspective\"\nFilm \"rgb\" \"integer xresolution\" 4 \"integer yresolution\" "
         "3\nWorldBegin\n"
         "AreaLightSource \"diffuse\"\nShape \"trianglemesh\" \"point3 P\" [ -1 -1 3  1 -1 3  0 1 3 ]\n");
    for (const char* name : {"dir", "dir.exr", "dir.png", "dir.xml", "kept", "blocked/results.csv",
                             "blocked_late/run_0.png", "blocked_reference/reference.png"})
      fs::create_directories(folder_ / name);
    fs::create_symlink("tex.png", folder_ / "linked.png");
    fs::create_symlink("scene.xml", folder_ / "linked.xml");
    fs::create_symlink("old.pfm", folder_ / "oldlink.pfm");
    fs::create_symlink("dir", folder_ / "dirlink");
    fs::create_symlink("loop.exr", folder_ / "loop.exr");
    fs::create_hard_link(folder_ / "tex.png", folder_ / "hard.png");
    for (const char* name : {"full.pfm", "full.json", "full.png", "full.xml"})
      make_full_device(folder_ / name);
    make_socket(folder_ / "socket");
    for (const char* name : {"kept/run_0.png", "kept/reference.png", "kept/reference.exr"})
      write_picture_file(folder_ / name, 4, 3);
    EXPECT_SUCCESS(lumirank({"render", folder_ / "scene.xml", "-o", folder_ / "first.exr", "--report",
                             folder_ / "replay.json", "--size", "4x3", "--lights", "30", "--quiet"}));
  }

  // Everything in the folder: its kind, and the bytes of files.
  std::map<std::string, std::string> contents() const {
    std::map<std::string, std::string> seen;
    for (const auto& entry : fs::recursive_directory_iterator(folder_ / "")) {
      const auto status = entry.symlink_status();
      std::string& what = seen[entry.path().lexically_relative(folder_ / "").string()];
      what = std::to_string(static_cast<int>(status.type()));
      if (fs::is_regular_file(status)) what += read_text(entry.path().string());
    }
    return seen;
  }

  Arguments words(const std::string& line) const {
    Arguments words;
    std::istringstream in(line);
    for (std::string word; in >> word;) {
      if (word == "''") word.clear();
      std::replace(word.begin(), word.end(), '~', ' ');
      for (auto at = word.find("@/"); at != word.npos; at = word.find("@/", at + 1))
        word.replace(at, 2, folder_ / "");
      words.push_back(word);
    }
    return words;
  }

  void expect(const Attempt& attempt) {
    const auto before = contents();
    const Outcome outcome = lumirank(words(attempt.line));
    SCOPED_TRACE(attempt.line);
    EXPECT_EQ(outcome.code, attempt.code) << outcome.err;
    const std::string& said = attempt.code == 0 ? outcome.out : outcome.err;
    EXPECT_NE(said.find(attempt.says), std::string::npos) << "it says: " << said;
    if (attempt.code != 0) {
      EXPECT_EQ(outcome.out, "");
      // One line in the program's name (but for the usage, which is many).
      EXPECT_TRUE(outcome.err.starts_with("lumirank: ") || attempt.line.empty()) << outcome.err;
      EXPECT_TRUE(std::count(outcome.err.begin(), outcome.err.end(), '\n') == 1 || attempt.line.empty())
          << outcome.err;
    }
    std::set<std::string> expected, left;
    std::istringstream in(attempt.leaves);
    for (std::string name; in >> name;) expected.insert(name);
    const auto after = contents();
    for (const auto& [name, what] : before) {
      ASSERT_TRUE(after.contains(name)) << name << " is gone";
      if (after.at(name) != what) left.insert("*" + name);
    }
    for (const auto& [name, what] : after)
      if (const std::string parent = fs::path(name).parent_path().string();
          !before.contains(name) && (parent.empty() || before.contains(parent)))
        left.insert(name);
    EXPECT_EQ(left, expected);
    for (const std::string& name : left) {
      if (name.starts_with('*'))
        std::ofstream(folder_ / name.substr(1), std::ios::binary) << before.at(name.substr(1)).substr(1);
      else
        fs::remove_all(folder_ / name);
    }
  }

  TemporaryFolder folder_;
};

TEST_F(Attempts, OnOutputs) {
  const auto attempts = attempts_on_outputs();
  for (const Attempt& attempt : attempts) expect(attempt);
  EXPECT_GE(attempts.size() + attempts_on_options().size(), 200u);
}

TEST_F(Attempts, OnOptions) {
  for (const Attempt& attempt : attempts_on_options()) expect(attempt);
}

// What is asked for goes to standard output: if that is full, it is lost.
TEST_F(Attempts, OnAFullStandardOutput) {
  const auto into_full = [&](const Arguments& arguments) {
    std::FILE* full = std::fopen("/dev/full", "w");
    const Outcome outcome = lumirank_into(full, arguments);
    std::fclose(full);
    return outcome;
  };
  const std::string lost = "standard output cannot be written: No space left on device";
  const Arguments results[] = {{"error", folder_ / "old.pfm", folder_ / "old.pfm"},
                               {"info", folder_ / "scene.xml"},
                               {"info", folder_ / "scene.xml", "--json"},
                               {"methods"},
                               {"methods", "--json"},
                               {"--version"},
                               {"render", "--help"}};
  for (const Arguments& arguments : results) {
    const Outcome outcome = into_full(arguments);
    EXPECT_EQ(outcome.code, 2) << arguments[0];
    EXPECT_EQ(outcome.err, "lumirank: " + lost + "\n") << arguments[0];
  }
  // Of a picture only the words about it are lost.
  const Arguments small = render_small(folder_ / "scene.xml", folder_ / "a.pfm");
  const Outcome outcome = into_full(small);
  EXPECT_EQ(outcome.code, 0);
  EXPECT_EQ(outcome.err, "warning: " + lost + "\n");
  const std::string picture = read_text(folder_ / "a.pfm");

  // A closed one: nothing is printed into the file that would take its number.
  EXPECT_EQ(start_lumirank({"--version"}, {}, "exec >&-").code, 2);
  EXPECT_EQ(start_lumirank(small, {}, "exec >&- 2>&-").code, 0);
  EXPECT_EQ(read_text(folder_ / "a.pfm"), picture);
}

// What is written into a pipe comes out of it, and the pipe stays.
TEST_F(Attempts, OnAPipe) {
  const std::string pipe = folder_ / "pipe.pfm";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  std::string bytes;
  std::jthread reader([&] { bytes = read_text(pipe); });
  EXPECT_SUCCESS(lumirank(render_small(folder_ / "scene.xml", pipe) + Arguments{"-o", folder_ / "a.pfm"}));
  reader.join();
  EXPECT_TRUE(fs::is_fifo(pipe));
  EXPECT_EQ(bytes, read_text(folder_ / "a.pfm"));
}

// --report to the file that standard output goes to: it is written there, not put in its place.
TEST_F(Attempts, OnStandardOutputByName) {
  const Outcome outcome = start_lumirank(render_small(folder_ / "scene.xml", folder_ / "a.pfm") +
                                         Arguments{"--quiet", "--report", "/dev/stdout"});
  EXPECT_SUCCESS(outcome);
  EXPECT_EQ(nlohmann::json::parse(outcome.out).at("virtual_lights.asked"), 300);
}

TEST_F(Attempts, OnAWriteProtectedFile) {
  fs::permissions(folder_ / "old.pfm", fs::perms::owner_read);
  if (std::ofstream(folder_ / "old.pfm", std::ios::app)) GTEST_SKIP() << "permissions do not bind this user";
  expect({"render @/scene.xml --size 4x3 --lights 30 -o @/old.pfm", 2, "old.pfm: cannot write", ""});
}

// The shell's limits: on the size of a file, and on memory.
TEST_F(Attempts, OnLimits) {
  const Arguments render = {"render", folder_ / "scene.xml", "--size", "64x64", "--spp", "1", "--lights",
                            "50"};
  for (const char* name : {"b.exr", "b.pfm"}) {
    const auto before = contents();
    const Outcome outcome = start_lumirank(render + Arguments{"-o", folder_ / name}, {}, "ulimit -f 1");
    EXPECT_EQ(outcome.code, 2) << outcome.err;
    EXPECT_NE(outcome.err.find(std::string(name) + ": cannot write"), std::string::npos) << outcome.err;
    EXPECT_EQ(contents(), before) << "no temporary file is left";
  }
  const Arguments many = {
      "render", folder_ / "scene.xml", "-o", folder_ / "b.pfm", "--size", "4x3", "--lights", "50000000"};
  const Outcome outcome = start_lumirank(many, {}, "ulimit -v 4000000");
  expect_refused(outcome, "there is not enough memory: this takes about 11 GB");
  EXPECT_NE(outcome.err.find("fewer --lights"), std::string::npos) << outcome.err;
  EXPECT_NE(outcome.err.find("ulimit"), std::string::npos) << outcome.err;
  // Where not even the libraries' own buffers fit: refused, instead of waiting for them.
  const Outcome little =
      start_lumirank(render + Arguments{"-o", folder_ / "b.pfm", "--threads", "4"}, {}, "ulimit -v 800000");
  EXPECT_TRUE(little.code == 2 || little.code == 0) << little.code << " " << little.err;
}

// The estimate holds what the report says of lights, receivers and the matrix of them, and is not much more.
TEST_F(Attempts, OnMemoryAreWarnedInTime) {
  const auto report_of = [&](const Arguments& more) {
    EXPECT_SUCCESS(lumirank(Arguments{"render", folder_ / "scene.xml", "-o", folder_ / "a.pfm", "--report",
                                      folder_ / "r.json", "--spp", "1", "--method", "brute-force"} +
                            more));
    const auto json = read_json(folder_ / "r.json");
    return json["memory.lights_bytes"].get<double>() + json["memory.receivers_bytes"].get<double>() +
           json["memory.matrix_bytes"].get<double>();
  };
  const double lights = pipeline::memory_of_picture(12, 20000, false),
               samples = pipeline::memory_of_picture(200 * 100, 50, false);
  const double of_lights = report_of({"--size", "4x3", "--lights", "20000"}),
               of_samples = report_of({"--size", "200x100", "--lights", "50"});
  EXPECT_LT(of_lights, lights);
  EXPECT_GT(of_lights, 0.5 * lights);
  EXPECT_LT(of_samples, samples);
  EXPECT_GT(of_samples, 0.5 * samples);
}

}  // namespace
}  // namespace lumirank::test
