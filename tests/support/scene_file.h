// A scene given as text: written to a temporary file that is removed at the end of the test.
#pragma once

#include <unistd.h>

#include <atomic>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string>

#include "lumirank/lumirank.h"

namespace lumirank::test {

class TemporaryFolder {
 public:
  TemporaryFolder() {
    static std::atomic<int> counter{0};
    path_ = std::filesystem::temp_directory_path() /
            ("lumirank_test_" + std::to_string(getpid()) + "_" + std::to_string(counter++));
    std::filesystem::create_directories(path_);
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  std::string operator/(const std::string& name) const { return (path_ / name).string(); }

 private:
  std::filesystem::path path_;
};

// `body`: everything between <scene> and </scene>, Mitsuba 3.
inline Scene load_text(const std::string& body, const LoadOptions& options = {}) {
  const TemporaryFolder folder;
  const std::string file = folder / "scene.xml";
  std::ofstream(file) << "<scene version=\"3.0.0\">" << body << "</scene>";
  return Scene::load(file, options);
}

// A camera at `origin` that looks at `target` with a field of view so small that all pixels see nearly one
// point.
inline std::string point_camera(const std::string& origin, const std::string& target, int size, double fov) {
  return "<sensor type=\"perspective\"><float name=\"fov\" value=\"" + std::to_string(fov) +
         "\"/><transform name=\"to_world\"><lookat origin=\"" + origin + "\" target=\"" + target +
         "\" up=\"0,1,0\"/></transform><film type=\"hdrfilm\"><integer name=\"width\" value=\"" +
         std::to_string(size) + "\"/><integer name=\"height\" value=\"" + std::to_string(size) +
         "\"/><rfilter type=\"box\"/></film></sensor>";
}

}  // namespace lumirank::test
