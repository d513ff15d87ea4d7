// State of one reading: names, warnings, and what has been built so far. Each build_* is in a file of its
// own.
#pragma once

#include <map>
#include <set>
#include <string>
#include <unordered_map>

#include "scenedesc/mitsuba/element.h"
#include "scenedesc/mitsuba/values.h"
#include "scenedesc/schema/scene_reader.h"

namespace lumirank::scenedesc::mitsuba {

class Plugin;

class Reader : public SceneReader {
 public:
  Reader(const Document& document, const std::string& filename, const ReadOptions& options);

  SceneDesc read();

  const Dialect& dialect() const { return document_.dialect; }

  // What an <animation> of `title` is at the time that is read, or its first key.
  Transform animated(const Element& animation, const std::string& title);

  // The element itself, or what a <ref> names.
  const Element& resolve(const Element& element) const;

  // Each returns an index into the scene's list; an element that is named twice is built once.
  int build_texture(const Element& element);
  int build_bsdf(const Element& element);
  int build_shape(const Element& element, bool in_group);
  int build_medium(const Element& element);  // kNone: it was left out
  void build_emitter(const Element& element);
  void build_sensor(const Element& element);
  void build_integrator(const Element& element);

  // <texture type="uniform|srgb|blackbody|d65|…"> and <spectrum type="…"> hold one color.
  bool constant_texture(const Element& element, Intent intent, Rgb& value);
  AreaEmitterDesc area_emitter(const Element& element);
  VolumeInput volume_input(const Element& element);
  std::vector<PhaseLobeDesc> phase_function(const Element& element);

  // Names are relative to the folder of the file that says them.
  NamedFile file(const std::string& name, const SourceLocation& where, const std::string& kind,
                 const std::string& stand_in);

 private:
  void index_ids(const Element& element);
  void build_top_level(const Element& element);
  void check_area_emitters_used();

  // shapes.cpp
  ShapeGroupDesc shape_group(Plugin& p);
  std::vector<const Element*> merged(Plugin& p);  // the shapes of a "merge"
  InstanceDesc shape_instance(Plugin& p);
  void add_surface(Plugin& p, ShapeDesc& shape);  // its BSDF and its light
  void add_media(Plugin& p, ShapeDesc& shape);    // media.cpp

  const Document& document_;
  std::map<std::string, const Element*> ids_;
  std::unordered_map<const Element*, int> textures_, bsdfs_, groups_, volumes_, media_;
  std::set<const Element*> open_;  // being built: a reference to one of them is a loop
  std::set<const Element*> used_area_emitters_;
  std::size_t merged_ = 0;  // shapes of all merges

  friend class OpenGuard;
};

// Holds an element open while it is built; finds loops of references and chains that are too long.
class OpenGuard {
 public:
  OpenGuard(Reader& reader, const Element& element);
  ~OpenGuard() { reader_.open_.erase(&element_); }
  OpenGuard(const OpenGuard&) = delete;
  OpenGuard& operator=(const OpenGuard&) = delete;

 private:
  Reader& reader_;
  const Element& element_;
};

}  // namespace lumirank::scenedesc::mitsuba
