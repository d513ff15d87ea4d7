// Lumirank: global illumination by sampling the many-light matrix. The whole library behind a few plain
// values.
//
//   auto scene = lumirank::Scene::load("room.xml");
//   auto result = lumirank::render(scene, {.lights = {.count = 50000}});
//   lumirank::write_picture("room.exr", result.picture);
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "lumirank/error.h"
#include "lumirank/export.h"
#include "lumirank/info.h"
#include "lumirank/report.h"
#include "lumirank/settings.h"
#include "lumirank/sinks.h"

namespace lumirank {

LUMIRANK_API std::string version();
// What the library that runs was compiled for: "AVX-512", "AVX2" or "no wide vectors". A package for any
// machine (docs/library.md) holds one for each, and the widest that the processor has is loaded.
LUMIRANK_API std::string instruction_set();

// A scene file after parsing; nothing is built yet. Cheap to copy.
class LUMIRANK_API Scene {
 public:
  // Throws InputError (file, line, remedy). Warnings go to `sinks.warning` and stay in the listing.
  static Scene load(const std::string& filename, const LoadOptions& options = {}, const Sinks& sinks = {});

  // The same scene at another moment (LoadOptions::time), read anew; before the first key as at it, after the
  // last one as at that. What does not move is shared. A scene from memory has one moment.
  Scene at(double seconds, const Sinks& sinks = {}) const;

  // What it consists of; builds the world once to count triangles and emitters.
  SceneInfo info(const Sinks& sinks = {}) const;

  // The files that it was read from and those that it will be built from.
  std::vector<std::string> files() const;

  struct Impl;
  Scene() = default;
  explicit Scene(std::shared_ptr<const Impl> impl) : impl_(std::move(impl)) {}
  const Impl& impl() const { return *impl_; }
  std::shared_ptr<const Impl> share() const { return impl_; }

 private:
  std::shared_ptr<const Impl> impl_;
};

// Linear RGB, three floats per pixel, row 0 at the top.
struct Plane {
  std::string name;  // "" for the picture's colors, else the AOV
  std::vector<float> rgb;
};
struct Picture {
  int width = 0, height = 0;
  std::vector<Plane> planes;  // planes[0] is the color
};

struct RenderResult {
  Picture picture;
  Report report;
  std::string summary;       // one line for a person
  bool interrupted = false;  // cancelled: the picture is the best finished estimate
};

// `on_preview` is called, not more often than about twice a second, with complete pictures while the estimate
// improves.
using PreviewCallback = std::function<void(const Picture&)>;

LUMIRANK_API RenderResult render(const Scene& scene, const RenderSettings& settings, const Sinks& sinks = {},
                                 const PreviewCallback& on_preview = {});

// Ground truth by path tracing. Of `settings` it reads view, seed, threads and layers.
LUMIRANK_API RenderResult reference(const Scene& scene, const RenderSettings& settings,
                                    const ReferenceSettings& how, const Sinks& sinks = {},
                                    const PreviewCallback& on_preview = {});

// Stops by which a PNG of the picture is developed if none are given: 0, but for a picture that would be all
// but white or black what shows it. Frames of a shot are developed by 0.
LUMIRANK_API double exposure_for(const Picture& picture);
// By extension: .exr (all planes), .png, .pfm. Whole or absent.
LUMIRANK_API void write_picture(const std::string& filename, const Picture& picture,
                                const DisplaySettings& display = {});
LUMIRANK_API void check_writable(const std::string& filename);
// The plane "illuminance" in false colors with a scale in lux, as PNG. Throws InputError if there is none.
LUMIRANK_API void write_illuminance(const std::string& filename, const Picture& picture,
                                    const DisplaySettings& display = {});
// A small text file (report, settings), written to a temporary name and renamed.
LUMIRANK_API void write_text(const std::string& filename, const std::string& text);
// Throws InputError if write_text could not write there; leaves nothing behind.
LUMIRANK_API void check_text_writable(const std::string& filename);

// Throws InputError if two of the outputs are one file (through whatever links), or one of them is an input:
// Scene::files(), say.
LUMIRANK_API void check_distinct(const std::vector<std::string>& outputs,
                                 const std::vector<std::string>& inputs);

// What this thread writes by the functions above while it lives appears in commit(), all of it or nothing.
class LUMIRANK_API FilesTogether {
 public:
  FilesTogether();
  ~FilesTogether();
  FilesTogether(const FilesTogether&) = delete;
  FilesTogether& operator=(const FilesTogether&) = delete;
  void commit();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

// For the signal handler of a host that ends the process in the middle of a write; it may be called there.
LUMIRANK_API void remove_temporary_files() noexcept;

}  // namespace lumirank
