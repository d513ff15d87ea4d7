// State of one reading: names, warnings, and what has been built so far. Each build_* is in a file of its
// own.
#pragma once

#include <map>
#include <set>
#include <string>
#include <unordered_map>

#include "scenedesc/mitsuba/element.h"
#include "scenedesc/mitsuba/values.h"
#include "scenedesc/schema/read_options.h"
#include "scenedesc/schema/scene_desc.h"

namespace lumirank::scenedesc::mitsuba {

class Plugin;

class Reader {
 public:
  Reader(const Document& document, const std::string& filename, const ReadOptions& options);

  SceneDesc read();

  const Dialect& dialect() const { return document_.dialect; }
  SceneDesc& scene() { return scene_; }

  // The format has `what` and Lumirank does not. With `strict`, an InputError.
  void warn(const SourceLocation& where, const std::string& what, const std::string& used_instead);

  // The element itself, or what a <ref> names.
  const Element& resolve(const Element& element) const;

  // Each returns an index into the scene's list; an element that is named twice is built once.
  int build_texture(const Element& element);
  int build_bsdf(const Element& element);
  int build_shape(const Element& element, bool in_group);
  void build_emitter(const Element& element);
  void build_sensor(const Element& element);
  void build_integrator(const Element& element);

  // <texture type="uniform|srgb|blackbody|d65|…"> and <spectrum type="…"> hold one color.
  bool constant_texture(const Element& element, Intent intent, Rgb& value);
  AreaEmitterDesc area_emitter(const Element& element);

  // Existence is checked here, so that the message has the line of the element that names the file. A file
  // that is missing is an error, or a warning that `stand_in` is in its place ("": nothing is).
  struct NamedFile {
    std::string name;
    bool missing = false;
  };
  NamedFile file(const std::string& name, const SourceLocation& where, const std::string& kind,
                 const std::string& stand_in);

  int add_bsdf(const std::string& id, const SourceLocation& where, decltype(BsdfDesc::kind) kind);
  int add_texture(const std::string& id, const SourceLocation& where, decltype(TextureDesc::kind) kind);

 private:
  void index_ids(const Element& element);
  void build_top_level(const Element& element);
  void check_area_emitters_used();

  const Document& document_;
  const ReadOptions& options_;
  SceneDesc scene_;
  std::map<std::string, const Element*> ids_;
  std::unordered_map<const Element*, int> textures_, bsdfs_, groups_;
  std::set<const Element*> open_;  // being built: a reference to one of them is a loop
  std::set<const Element*> used_area_emitters_;
  std::set<std::string> found_files_;

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
