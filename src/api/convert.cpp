// `lumirank convert`: a scene of any format as Mitsuba 3 XML with the files that it needs.
#include <filesystem>

#include "api/paint.h"
#include "api/scene.h"
#include "base/error.h"
#include "image/atomic_file.h"
#include "image/file_identity.h"
#include "lumirank/convert.h"
#include "scenedesc/writer/mitsuba_writer.h"
#include "world/profile_builder.h"

namespace lumirank {

std::vector<std::string> convert(const Scene& scene, const std::string& filename, const Sinks& sinks) {
  namespace fs = std::filesystem;
  if (fs::path(filename).extension() != ".xml")
    throw InputError({filename, 0}, "a scene is written as Mitsuba XML only",
                     "give a name that ends in .xml");
  const auto& desc = scene.impl().desc;
  // What is wrong with pictures is said when the scene is built.
  std::vector<scenedesc::Warning> ignored;
  world::Notes notes(ignored, false);
  scenedesc::Painter painter;
  painter.texture = [&](int texture) { return api::paint_texture(desc, texture); };
  painter.environment = [&] { return api::paint_environment(desc, notes); };
  painter.mean = [&](const scenedesc::EmitterDesc& light) {
    const auto& profile = std::get<scenedesc::ProfileLightDesc>(light.kind);
    const auto made = world::make_profile_light(profile, light.where, desc.lumens_per_unit, notes);
    return mean(made.profile->total()) / (4 * kPi);
  };
  const scenedesc::WrittenScene written = scenedesc::write_mitsuba(desc, filename, painter);
  std::vector<std::string> names;
  for (const auto& file : written.files)
    names.push_back((fs::path(filename).parent_path() / file.name).string());
  names.push_back(filename);
  image::require_distinct(names, scene.files());
  for (const auto& w : written.warnings) {
    std::string text = to_string(w.where);
    text += (text.empty() ? "" : ": ") + w.what;
    text += w.used_instead.empty() ? "; left out" : "; written instead: " + w.used_instead;
    if (scene.impl().options.strict) throw InputError(w.where, w.what, "--strict is given");
    sinks.warn(text);
  }
  // The scene last: whoever finds it finds all its files.
  image::FilesTogether together;
  for (std::size_t k = 0; k < written.files.size(); ++k)
    image::write_whole_file(names[k], written.files[k].bytes);
  image::write_whole_file(filename, written.xml);
  together.commit();
  return names;
}

}  // namespace lumirank
