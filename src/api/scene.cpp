// Loading scenes.
#include "api/scene.h"

#include "api/build_world.h"
#include "base/error.h"
#include "pipeline/memory.h"
#include "scenedesc/readers.h"
#include "scenedesc/schema/files.h"
#include "scenedesc/writer/mitsuba_writer.h"
#include "settings/rows.h"

namespace lumirank {

namespace {

void require_within_motion(const scenedesc::SceneDesc& desc, double seconds) {
  const scenedesc::Motion& motion = desc.motion;
  constexpr double kRounding = 1e-6;  // of key times and frame rates
  if (!(motion.end > motion.begin) ||
      (seconds >= motion.begin - kRounding && seconds <= motion.end + kRounding))
    return;
  using settings::format_number;
  throw InputError({desc.source_file, 0},
                   "second " + format_number(seconds) + " is not within the motion, which goes from " +
                       format_number(motion.begin) + " to " + format_number(motion.end) + " s",
                   "give another --at or --frame, or another --clip");
}

Scene read(const std::string& filename, const LoadOptions& options,
           const std::shared_ptr<scenedesc::MeshCache>& meshes, const Sinks& sinks) {
  auto impl = std::make_shared<Scene::Impl>();
  impl->options = options;
  impl->meshes = meshes;
  scenedesc::ReadOptions read;
  read.defines = options.defines;
  read.strict = options.strict;
  read.environment = options.environment;
  read.allow_missing = options.allow_missing;
  read.time = options.time, read.clip = options.clip;
  read.frames_per_second = options.frames_per_second;
  read.meshes = meshes;
  const scenedesc::FilesRead files;
  pipeline::within_memory("the scene is too large for this machine",
                          [&] { impl->desc = scenedesc::read_scene(filename, read); });
  impl->files_read = files.names();
  api::report_warnings(sinks, impl->desc.warnings);
  return Scene(std::move(impl));
}

}  // namespace

Scene Scene::load(const std::string& filename, const LoadOptions& options, const Sinks& sinks) {
  Scene scene = read(filename, options, std::make_shared<scenedesc::MeshCache>(), sinks);
  if (options.time) require_within_motion(scene.impl().desc, *options.time);
  return scene;
}

Scene Scene::at(double seconds, const Sinks& sinks) const {
  if (!impl_->meshes) return *this;
  LoadOptions options = impl_->options;
  options.time = seconds;
  return read(impl_->desc.source_file, options, impl_->meshes, sinks);
}

std::vector<std::string> Scene::files() const {
  std::vector<std::string> files = impl_->files_read;
  const auto later = scenedesc::files_of(impl_->desc);
  files.insert(files.end(), later.begin(), later.end());
  return files;
}

}  // namespace lumirank
