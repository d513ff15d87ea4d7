// The program as a person meets it: given a command line, read by its exit code, output and files.
#pragma once

#include <gtest/gtest.h>
#include <sys/types.h>

#include <cstdio>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "support/scene_file.h"

namespace lumirank::test {

struct Outcome {
  int code = -1;    // of exit; negative: minus the signal that ended it
  std::string out;  // standard output
  std::string err;  // standard error
};

using Arguments = std::vector<std::string>;

// Runs one command line to its end, in this process: everything of the program but main().
Outcome lumirank(const Arguments& arguments);
// The same with its results on a stream that the caller has opened.
Outcome lumirank_into(std::FILE* out, const Arguments& arguments);

// Starts the program itself. `folder`: where it is started, "": here. `limits`: what its shell says before
// ("ulimit -f 1").
Outcome start_lumirank(const Arguments& arguments, const std::string& folder = {},
                       const std::string& limits = {});

// Runs the program and sends it SIGINT as soon as `when` holds; fails if it ends before that.
Outcome interrupted(const Arguments& arguments, const std::function<bool(pid_t)>& when);
// The program has come so far that it would not simply be killed.
bool catches_interrupts(pid_t program);

// lumirank() for every argument list, a few at a time.
std::vector<Outcome> lumirank_each(const std::vector<Arguments>& runs);

std::string example(const std::string& name);  // of examples/
std::string data_file(const std::string& name);
std::string read_text(const std::string& file);
std::string write_scene(const TemporaryFolder& folder, const std::string& body,
                        const std::string& name = "scene.xml");
nlohmann::json read_json(const std::string& file);
std::vector<std::string> files_in(const std::string& folder);  // names, sorted; hidden ones too

// An image file with all its channels, by name ("R", "direct.G", …).
struct Pixels {
  int width = 0, height = 0;
  std::map<std::string, std::vector<float>> channels;
  friend bool operator==(const Pixels&, const Pixels&) = default;
};
Pixels read_pixels(const std::string& file);
double mean(const Pixels& pixels);  // over R, G and B
bool all_finite(const Pixels& pixels);

// A room that is a box with one lamp: `head` may hold defaults and more.
std::string small_room(const std::string& more = {});

// Appends to a list of arguments.
inline Arguments operator+(Arguments a, const Arguments& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

// The most common of all: quiet, small, few lights.
inline Arguments render_small(const std::string& scene, const std::string& out) {
  return {"render", scene, "-o", out, "--size", "12x10", "--lights", "300"};
}

#define EXPECT_SUCCESS(outcome) EXPECT_EQ((outcome).code, 0) << (outcome).err
// Exit code 2, nothing on standard output, and a message with `phrase` in it.
void expect_refused(const Outcome& outcome, const std::string& phrase, const std::string& what = {});

}  // namespace lumirank::test
