#include "program.h"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <thread>

#include "base/rgb.h"
#include "image/image_io.h"
#include "run.h"

namespace lumirank::test {
namespace {

namespace fs = std::filesystem;

// A running program with its two streams in files: no pipe can fill up and stall it.
class Process {
 public:
  Process(const Arguments& arguments, const std::string& folder, const std::string& limits = {}) {
    std::vector<std::string> words = {LUMIRANK_PROGRAM};
    if (!limits.empty()) words = {"/bin/sh", "-c", limits + "; exec \"$0\" \"$@\"", LUMIRANK_PROGRAM};
    words.insert(words.end(), arguments.begin(), arguments.end());
    std::vector<char*> argv;
    for (auto& word : words) argv.push_back(word.data());
    argv.push_back(nullptr);
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    const std::string out = files_ / "out", err = files_ / "err";
    posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, out.c_str(), O_WRONLY | O_CREAT, 0600);
    posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, err.c_str(), O_WRONLY | O_CREAT, 0600);
    if (!folder.empty()) posix_spawn_file_actions_addchdir_np(&actions, folder.c_str());
    const int failed = posix_spawn(&pid_, argv[0], &actions, nullptr, argv.data(), environ);
    posix_spawn_file_actions_destroy(&actions);
    if (failed != 0) throw std::runtime_error("the program could not be started");
  }
  ~Process() {
    if (!ended_) {
      kill(pid_, SIGKILL);
      waitpid(pid_, &status_, 0);
    }
  }
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;

  bool running() {
    if (!ended_) ended_ = waitpid(pid_, &status_, WNOHANG) == pid_;
    return !ended_;
  }
  pid_t pid() const { return pid_; }
  void interrupt() const { kill(pid_, SIGINT); }
  Outcome wait() {
    if (!ended_) waitpid(pid_, &status_, 0);
    ended_ = true;
    Outcome outcome;
    outcome.code = WIFEXITED(status_) ? WEXITSTATUS(status_) : -WTERMSIG(status_);
    outcome.out = read_text(files_ / "out");
    outcome.err = read_text(files_ / "err");
    return outcome;
  }

 private:
  TemporaryFolder files_;
  pid_t pid_ = -1;
  int status_ = 0;
  bool ended_ = false;
};

// A stream whose text is kept.
class MemoryStream {
 public:
  MemoryStream() : stream_(open_memstream(&data_, &size_)) {}
  ~MemoryStream() {
    std::fclose(stream_);
    std::free(data_);
  }
  MemoryStream(const MemoryStream&) = delete;
  MemoryStream& operator=(const MemoryStream&) = delete;
  std::FILE* stream() { return stream_; }
  std::string text() {
    std::fflush(stream_);
    return {data_, size_};
  }

 private:
  char* data_ = nullptr;
  std::size_t size_ = 0;
  std::FILE* stream_;
};

}  // namespace

Outcome lumirank(const Arguments& arguments) {
  MemoryStream out, err;
  Outcome outcome;
  outcome.code = cli::run(arguments, {out.stream(), err.stream()});
  outcome.out = out.text(), outcome.err = err.text();
  return outcome;
}

Outcome lumirank_into(std::FILE* out, const Arguments& arguments) {
  MemoryStream err;
  Outcome outcome;
  outcome.code = cli::run(arguments, {out, err.stream()});
  outcome.err = err.text();
  return outcome;
}

Outcome start_lumirank(const Arguments& arguments, const std::string& folder, const std::string& limits) {
  return Process(arguments, folder, limits).wait();
}

Outcome interrupted(const Arguments& arguments, const std::function<bool(pid_t)>& when) {
  Process process(arguments, {});
  while (!when(process.pid())) {
    if (!process.running()) {
      ADD_FAILURE() << "the program ended before it was interrupted";
      return process.wait();
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  process.interrupt();
  return process.wait();
}

bool catches_interrupts(pid_t program) {
  std::ifstream status("/proc/" + std::to_string(program) + "/status");
  for (std::string line; std::getline(status, line);)
    if (line.starts_with("SigCgt:")) return (std::stoull(line.substr(7), nullptr, 16) >> (SIGINT - 1)) & 1;
  return false;
}

std::vector<Outcome> lumirank_each(const std::vector<Arguments>& runs) {
  std::vector<Outcome> outcomes(runs.size());
  std::atomic<std::size_t> next{0};
  std::vector<std::jthread> workers;
  for (unsigned k = 0; k < std::clamp(std::thread::hardware_concurrency(), 1u, 4u); ++k)
    workers.emplace_back([&] {
      for (std::size_t i = next++; i < runs.size(); i = next++) outcomes[i] = lumirank(runs[i]);
    });
  workers.clear();
  return outcomes;
}

std::string example(const std::string& name) { return std::string(LUMIRANK_EXAMPLES) + "/" + name + ".xml"; }

std::string data_file(const std::string& name) { return std::string(LUMIRANK_TEST_DATA) + "/" + name; }

std::string read_text(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

std::string write_scene(const TemporaryFolder& folder, const std::string& body, const std::string& name) {
  const std::string file = folder / name;
  std::ofstream(file) << "<scene version=\"3.0.0\">\n" << body << "</scene>\n";
  return file;
}

nlohmann::json read_json(const std::string& file) {
  auto json = nlohmann::json::parse(read_text(file), nullptr, false);
  EXPECT_FALSE(json.is_discarded()) << file << " is not JSON";
  return json;
}

std::vector<std::string> files_in(const std::string& folder) {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder)) names.push_back(entry.path().filename().string());
  std::sort(names.begin(), names.end());
  return names;
}

namespace {

// By hand, so that the program's own reader is not asked about its writer.
Pixels read_pfm_pixels(const std::string& file) {
  Pixels pixels;
  std::ifstream in(file, std::ios::binary);
  std::string magic, scale;
  in >> magic >> pixels.width >> pixels.height >> scale;
  in.get();
  EXPECT_EQ(magic + " " + scale, "PF -1.0") << file << ": not a little-endian color PFM";
  const auto width = static_cast<std::size_t>(pixels.width), height = static_cast<std::size_t>(pixels.height);
  std::vector<float> data(3 * width * height);
  in.read(reinterpret_cast<char*>(data.data()), static_cast<std::streamsize>(data.size() * sizeof(float)));
  EXPECT_TRUE(in && in.peek() == EOF) << file << ": its length is wrong";
  for (std::size_t c = 0; c < 3; ++c) {
    auto& plane = pixels.channels[std::string(1, "RGB"[c])];
    for (std::size_t y = height; y-- > 0;)
      for (std::size_t x = 0; x < width; ++x) plane.push_back(data[3 * (y * width + x) + c]);
  }
  return pixels;
}

Pixels read_png_pixels(const std::string& file) {
  Pixels pixels;
  const image::Image image = image::read_image(file, true).color;
  pixels.width = image.width, pixels.height = image.height;
  for (int c = 0; c < 3; ++c)
    for (const Rgb& p : image.pixels) pixels.channels[std::string(1, "RGB"[c])].push_back(p[c]);
  return pixels;
}

}  // namespace

Pixels read_pixels(const std::string& file) {
  if (file.ends_with(".pfm")) return read_pfm_pixels(file);
  if (file.ends_with(".png")) return read_png_pixels(file);
  Pixels pixels;
  try {
    Imf::InputFile input(file.c_str());
    const Imath::Box2i window = input.header().dataWindow();
    pixels.width = window.max.x - window.min.x + 1, pixels.height = window.max.y - window.min.y + 1;
    const auto width = static_cast<std::size_t>(pixels.width),
               height = static_cast<std::size_t>(pixels.height);
    Imf::FrameBuffer frame;
    const Imf::ChannelList& channels = input.header().channels();
    for (auto c = channels.begin(); c != channels.end(); ++c) {
      auto& plane = pixels.channels[c.name()];
      plane.resize(width * height);
      frame.insert(c.name(),
                   Imf::Slice::Make(Imf::FLOAT, plane.data(), window, sizeof(float), width * sizeof(float)));
    }
    input.setFrameBuffer(frame);
    input.readPixels(window.min.y, window.max.y);
  } catch (const std::exception& failure) {
    ADD_FAILURE() << file << " cannot be read: " << failure.what();
  }
  return pixels;
}

double mean(const Pixels& pixels) {
  double sum = 0;
  std::size_t count = 0;
  for (const char* name : {"R", "G", "B"})
    for (const float v : pixels.channels.at(name)) sum += static_cast<double>(v), ++count;
  return sum / static_cast<double>(count);
}

bool all_finite(const Pixels& pixels) {
  for (const auto& [name, values] : pixels.channels)
    for (const float v : values)
      if (!std::isfinite(v)) return false;
  return true;
}

std::string small_room(const std::string& more) {
  return "<integrator type=\"path\"><integer name=\"max_depth\" value=\"6\"/></integrator>\n" +
         point_camera("0,0,3.5", "0,0,0", 16, 50) +
         "<shape type=\"cube\"><boolean name=\"flip_normals\" value=\"true\"/><transform name=\"to_world\">"
         "<scale value=\"2,2,4\"/></transform><bsdf type=\"diffuse\"><rgb name=\"reflectance\" value=\"0.6, "
         "0.5, 0.4\"/></bsdf></shape>\n"
         "<shape type=\"sphere\" id=\"lamp\"><point name=\"center\" x=\"0.8\" y=\"1.2\" z=\"0\"/><float "
         "name=\"radius\" value=\"0.2\"/><emitter type=\"area\"><rgb name=\"radiance\" value=\"9, 8, "
         "7\"/></emitter></shape>\n" +
         more;
}

void expect_refused(const Outcome& outcome, const std::string& phrase, const std::string& what) {
  EXPECT_EQ(outcome.code, 2) << what << outcome.err;
  EXPECT_EQ(outcome.out, "") << what;
  EXPECT_NE(outcome.err.find(phrase), std::string::npos) << what << " says: " << outcome.err;
}

}  // namespace lumirank::test
