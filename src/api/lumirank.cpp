// The public façade: loading, rendering, the reference, and files.
#include "lumirank/lumirank.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "api/scene.h"
#include "base/error.h"
#include "base/parallel.h"
#include "base/timer.h"
#include "base/version.h"
#include "image/atomic_file.h"
#include "image/file_identity.h"
#include "image/image_io.h"
#include "image/metrics.h"
#include "image/scale_bar.h"
#include "pathtrace/reference.h"
#include "pipeline/aovs.h"
#include "pipeline/error_advice.h"
#include "pipeline/memory.h"
#include "pipeline/pipeline.h"
#include "pipeline/preview_throttle.h"
#include "pipeline/render_run.h"
#include "pipeline/report.h"
#include "pipeline/view_check.h"
#include "scenedesc/readers.h"
#include "scenedesc/schema/files.h"
#include "scenedesc/writer/mitsuba_writer.h"

namespace lumirank {
namespace {

using pipeline::Setup;

std::string warning_text(const scenedesc::Warning& warning) {
  std::string text = to_string(warning.where);
  if (!text.empty()) text += ": ";
  text += warning.what;
  if (!warning.used_instead.empty()) text += "; used instead: " + warning.used_instead;
  return text;
}

void tell(const Sinks& sinks, const std::vector<scenedesc::Warning>& warnings) {
  for (const auto& w : warnings)
    if (w.harmless)
      sinks.say(warning_text(w));
    else
      sinks.warn(warning_text(w));
}

world::World build_world(const Scene& scene, const Sinks& sinks,
                         std::vector<scenedesc::Warning>* keep = nullptr) {
  std::vector<scenedesc::Warning> warnings;
  world::BuildOptions options;
  options.strict = scene.impl().options.strict;
  std::optional<world::World> world;
  pipeline::within_memory("the scene is too large for this machine", [&] {
    world.emplace(world::World::build(scene.impl().desc, options, warnings, sinks));
  });
  tell(sinks, warnings);
  if (keep) *keep = std::move(warnings);
  return std::move(*world);
}

image::LayeredImage to_layers(const Picture& picture) {
  image::LayeredImage layers;
  for (const Plane& plane : picture.planes) {
    image::Image image(picture.width, picture.height);
    for (std::size_t p = 0; p < image.pixels.size(); ++p)
      image.pixels[p] = {plane.rgb[3 * p], plane.rgb[3 * p + 1], plane.rgb[3 * p + 2]};
    if (plane.name.empty())
      layers.color = std::move(image);
    else
      layers.layers.emplace_back(plane.name, std::move(image));
  }
  return layers;
}

image::DisplayOptions to_display_options(const DisplaySettings& display) {
  image::DisplayOptions options;
  options.exposure = static_cast<float>(display.exposure);
  if (display.tonemap == "reinhard")
    options.tonemap = image::ToneMap::reinhard;
  else if (display.tonemap == "agx")
    options.tonemap = image::ToneMap::agx;
  else if (display.tonemap != "none")
    throw InputError("'" + display.tonemap + "' is not a tone map", "choose one of none|reinhard|agx");
  return options;
}

double pixels_of(const pipeline::View& view) {
  return static_cast<double>(view.width) * static_cast<double>(view.height);
}

double memory_of(const pipeline::View& view, const RenderSettings& settings, std::size_t lights) {
  return pipeline::memory_of_picture(pixels_of(view) * settings.spp, static_cast<double>(lights),
                                     !settings.aovs.empty());
}

void within_memory_and_threads(const RenderSettings& settings, const std::function<void()>& work) {
  pipeline::within_memory(pipeline::kSmallerPicture, [&] { with_threads(settings.threads, work); });
}

nlohmann::ordered_json info_object(const Scene& scene, const Sinks& sinks) {
  const auto& desc = scene.impl().desc;
  std::vector<scenedesc::Warning> warnings;
  const world::World world = build_world(scene, sinks, &warnings);
  nlohmann::ordered_json json;
  json["file"] = desc.source_file;
  json["format"] = desc.format;
  const auto& info = world.info();
  json["triangles"] = info.triangles;
  json["triangles.unique"] = info.unique_triangles;
  json["fibre_segments"] = info.segments;
  json["meshes"] = info.meshes;
  json["meshes.left_out"] = info.meshes_left_out;
  json["instances"] = info.instances;
  json["textures"] = info.textures;
  json["materials"] = info.materials;
  json["emitters"] = nlohmann::json::array();
  for (const auto& e : world.emitters()) {
    const Rgb p = world.units().power_in_file(emitters::power(e, world.bounds().radius()));
    json["emitters"].push_back({{"name", e.name}, {"group", e.group}, {"power", {p.r, p.g, p.b}}});
  }
  const auto corner = [&](Vec3f own) -> nlohmann::ordered_json {
    if (world.units().are_the_files()) return {own.x, own.y, own.z};
    const Vec3d p = world.units().place_in_file(own);
    return {p.x, p.y, p.z};
  };
  json["bounds"] = {corner(world.bounds().lo), corner(world.bounds().hi)};
  json["cameras"] = nlohmann::json::array();
  for (const auto& s : desc.sensors)
    json["cameras"].push_back(
        {{"id", s.id}, {"width", s.film.width}, {"height", s.film.height}, {"fov_x", s.fov_x}});
  json["max_depth"] = desc.max_depth;
  json["memory.scene_bytes"] = info.memory_bytes;
  json["warnings"] = nlohmann::json::array();
  json["notes"] = nlohmann::json::array();
  for (const auto& w : desc.warnings) json[w.harmless ? "notes" : "warnings"].push_back(warning_text(w));
  for (const auto& w : warnings) json[w.harmless ? "notes" : "warnings"].push_back(warning_text(w));
  return json;
}

}  // namespace

std::string version() { return program_version(); }

Scene Scene::load(const std::string& filename, const LoadOptions& options, const Sinks& sinks) {
  auto impl = std::make_shared<Impl>();
  impl->options = options;
  scenedesc::ReadOptions read;
  read.defines = options.defines;
  read.strict = options.strict;
  read.environment = options.environment;
  read.allow_missing = options.allow_missing;
  const scenedesc::FilesRead files;
  pipeline::within_memory("the scene is too large for this machine",
                          [&] { impl->desc = scenedesc::read_scene(filename, read); });
  impl->files_read = files.names();
  tell(sinks, impl->desc.warnings);
  Scene scene;
  scene.impl_ = std::move(impl);
  return scene;
}

std::vector<std::string> Scene::files() const {
  std::vector<std::string> files = impl_->files_read;
  const auto later = scenedesc::files_of(impl_->desc);
  files.insert(files.end(), later.begin(), later.end());
  return files;
}

std::string Scene::info_json(const Sinks& sinks) const { return info_object(*this, sinks).dump(1) + "\n"; }

std::string Scene::info_text(const Sinks& sinks) const {
  const auto json = info_object(*this, sinks);
  std::string text = scenedesc::describe(impl_->desc);
  text += "\nbuilt: " + json["triangles"].dump() + " triangles (" + json["triangles.unique"].dump() +
          " unique) in " + json["meshes"].dump() + " meshes and " + json["instances"].dump() +
          " instances, " + json["textures"].dump() + " textures, " + json["materials"].dump() +
          " materials\n";
  if (json["meshes.left_out"] > 0)
    text += "left out: " + json["meshes.left_out"].dump() + " meshes without a triangle, or without a file\n";
  text +=
      "bounds: " + json["bounds"].dump() + "\nemitters: " + std::to_string(json["emitters"].size()) + "\n";
  std::size_t shown = 0;
  for (const auto& e : json["emitters"]) {
    if (++shown > 32) {
      text += "  … and " + std::to_string(json["emitters"].size() - 32) + " more (see --json)\n";
      break;
    }
    text += "  " + e["name"].get<std::string>() + "  " + e["power"].dump() + " W\n";
  }
  // The description above has listed the reader's own.
  const auto& told = impl_->desc.warnings;
  const auto read = static_cast<std::size_t>(
      std::count_if(told.begin(), told.end(), [](const scenedesc::Warning& w) { return !w.harmless; }));
  const std::size_t all = json["warnings"].size();
  text += "warnings while building: " + std::to_string(all - read) + "\n";
  for (std::size_t w = read; w < all; ++w) text += "  " + json["warnings"][w].get<std::string>() + "\n";
  if (!json["notes"].empty()) text += "notes (nothing that a picture shows):\n";
  for (const auto& note : json["notes"]) text += "  " + note.get<std::string>() + "\n";
  return text;
}

RenderResult render(const Scene& scene, const RenderSettings& settings, const Sinks& sinks,
                    const PreviewCallback& on_preview) {
  validate(settings);
  RenderResult result;
  within_memory_and_threads(settings, [&] {
    const Timer timer;
    pipeline::RenderTask task;
    task.timer = timer;
    task.view = pipeline::make_view(scene.impl().desc, settings);
    task.info = &pipeline::chosen_method(settings, &task.why);
    task.by_default = settings.method == "auto" && settings.method_settings.empty() && settings.error <= 0 &&
                      !task.info->contract.combination;
    pipeline::check_layers(*task.info, settings);
    methods::require_capabilities(*task.info, transport::SceneMatrix::kCapabilities);
    task.method = task.info->make(settings.method_settings);
    if (const std::string text = pipeline::error_not_aimed_at(*task.info, settings.error); !text.empty())
      sinks.warn(text);
    pipeline::require_countable(pixels_of(task.view) * settings.spp);
    const double memory = memory_of(task.view, settings, pipeline::lights_for(*task.info, settings));
    pipeline::require_memory(memory, pipeline::kSmallerPicture);
    const world::World world = build_world(scene, sinks);
    task.build_seconds = timer.seconds();
    if (const std::string text = pipeline::empty_view(world, task.view); !text.empty()) sinks.warn(text);
    pipeline::require_memory(memory, pipeline::kSmallerPicture);  // the scene has taken its part
    if (sinks.cancelled()) throw Cancelled();
    pipeline::check_aovs(world, settings);
    task.world = &world;
    task.lumens_per_unit = scene.impl().desc.lumens_per_unit;
    result = pipeline::run_render(std::move(task), settings, sinks, on_preview);
  });
  return result;
}

RenderResult reference(const Scene& scene, const RenderSettings& settings, const ReferenceSettings& how,
                       const Sinks& sinks, const PreviewCallback& on_preview) {
  validate(settings);
  for (const auto& aov : settings.aovs)
    if (aov != "direct" && aov != "indirect" && aov != "emission")
      throw InputError("the reference has no AOV '" + aov + "'", "it has direct, indirect and emission");
  RenderResult result;
  within_memory_and_threads(settings, [&] {
    const Timer timer;
    const pipeline::View view = pipeline::make_view(scene.impl().desc, settings);
    const pathtrace::ReferenceOptions options = pipeline::reference_options(settings, how.paths);
    pipeline::require_memory(pipeline::memory_of_reference(pixels_of(view)), pipeline::kSmallerPicture);
    const world::World world = build_world(scene, sinks);
    const double build_seconds = timer.seconds();
    if (const std::string text = pipeline::empty_view(world, view); !text.empty()) sinks.warn(text);
    pipeline::PreviewThrottle throttle(on_preview);
    const auto traced = pathtrace::path_trace(world, view, options, {how.spp, how.time, how.error}, sinks,
                                              [&](const image::Image& image) {
                                                if (throttle.due())
                                                  throttle.show(pipeline::to_picture(image));
                                              });
    result.interrupted = traced.interrupted;
    result.picture = pipeline::to_picture(traced.image);
    for (const auto& aov : settings.aovs) {
      const image::Image& plane = aov == "direct"     ? traced.direct
                                  : aov == "indirect" ? traced.indirect
                                                      : traced.emission;
      result.picture.planes.push_back({aov, pipeline::to_picture(plane).planes[0].rgb});
    }
    nlohmann::ordered_json json;
    json["method"] = "reference";
    json["version"] = version();
    json["seed"] = settings.seed;
    json["paths"] = how.paths;
    json["spp"] = traced.spp;
    json["error.relative_l1"] = traced.error;
    json["seconds.total"] = timer.seconds();
    json["seconds.build"] = build_seconds;
    json["memory.peak_bytes"] = pipeline::peak_memory_bytes();
    json["parameters"] = nlohmann::ordered_json::parse(to_json(settings));
    result.report_json = json.dump(1) + "\n";
    result.summary = std::to_string(traced.spp) + " paths per pixel; stated relative L1 error " +
                     nlohmann::json(traced.error).dump();
  });
  return result;
}

void write_picture(const std::string& filename, const Picture& picture, const DisplaySettings& display) {
  image::write_image(filename, to_layers(picture), to_display_options(display));
}

void write_illuminance(const std::string& filename, const Picture& picture, const DisplaySettings& display) {
  for (const auto& [name, image] : to_layers(picture).layers) {
    if (name != "illuminance") continue;
    image::Range range = image::round_range(image);
    if (display.lux_high > display.lux_low)
      range = {static_cast<float>(display.lux_low), static_cast<float>(display.lux_high)};
    return image::write_image(filename, {image::with_scale(image, range, "lux"), {}});
  }
  throw InputError({filename, 0}, "the picture has no illuminance", "render it with --aov illuminance");
}

void check_writable(const std::string& filename) { image::check_writable(filename); }

void write_text(const std::string& filename, const std::string& text) {
  image::write_whole_file(filename, text);
}

void check_text_writable(const std::string& filename) { const image::AtomicFile probe(filename); }

void check_distinct(const std::vector<std::string>& outputs, const std::vector<std::string>& inputs) {
  image::require_distinct(outputs, inputs);
}

struct FilesTogether::Impl {
  image::FilesTogether files;
};
FilesTogether::FilesTogether() : impl_(std::make_unique<Impl>()) {}
FilesTogether::~FilesTogether() = default;
void FilesTogether::commit() { impl_->files.commit(); }

void remove_temporary_files() noexcept { image::remove_temporary_files(); }

std::string error_json(const std::string& image_file, const std::string& reference_file) {
  const auto image = image::read_image(image_file), reference_image = image::read_image(reference_file);
  const image::ErrorMetrics m = image::compare(image.color, reference_image.color);
  nlohmann::ordered_json json = {{"relative_l1", m.relative_l1},
                                 {"relative_l2", m.relative_l2},
                                 {"rmse", m.rmse},
                                 {"relmse", m.relmse},
                                 {"bias", m.bias}};
  return json.dump() + "\n";
}

std::string methods_json() {
  nlohmann::ordered_json json = nlohmann::json::array();
  for (const auto& m : methods::all_methods()) {
    nlohmann::ordered_json parameters = nlohmann::json::array();
    for (const auto& p : m.parameters)
      parameters.push_back({{"key", p.key},
                            {"type", p.type},
                            {"default", p.default_text},
                            {"range", p.range},
                            {"unit", p.unit},
                            {"help", p.help}});
    json.push_back(
        {{"name", m.name}, {"summary", m.summary}, {"paper", m.paper}, {"parameters", parameters}});
  }
  return json.dump(1) + "\n";
}

std::string methods_text() {
  std::string text;
  for (const auto& m : methods::all_methods()) {
    text += m.name + "\n  " + m.summary + "\n";
    if (!m.paper.empty()) text += "  " + m.paper + "\n";
    for (const auto& p : m.parameters) {
      text += "    --set " + p.key + "=" + (p.default_text.empty() ? "…" : p.default_text) + "  (" + p.type;
      if (!p.range.empty()) text += ", " + p.range;
      if (!p.unit.empty()) text += ", " + p.unit;
      text += ")  " + p.help + "\n";
    }
    text += "\n";
  }
  return text;
}

}  // namespace lumirank
