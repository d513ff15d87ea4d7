#include "scenedesc/mitsuba/reader.h"

#include "scenedesc/mitsuba/plugin.h"
#include "scenedesc/mitsuba/read_mitsuba.h"
#include "scenedesc/schema/expansion.h"
#include "scenedesc/schema/files.h"

namespace lumirank::scenedesc::mitsuba {

Reader::Reader(const Document& document, const std::string& filename, const ReadOptions& options)
    : SceneReader(
          filename,
          "mitsuba " + std::to_string(document.dialect.major) + "." + std::to_string(document.dialect.minor),
          options),
      document_(document) {}

OpenGuard::OpenGuard(Reader& reader, const Element& element) : reader_(reader), element_(element) {
  const std::string* id = element.find("id");
  if (reader.open_.count(&element))
    throw InputError(element.where,
                     "<" + element.tag + (id ? " id=\"" + *id + "\"" : "") + "> refers to itself",
                     "break the loop of references");
  if (reader.open_.size() >= 100)
    throw InputError(element.where, "objects refer to each other more than 100 deep", "flatten them");
  reader.open_.insert(&element);
}

void Reader::index_ids(const Element& element) {
  for (const auto& child : element.children) {
    if (child->tag == "alias") {
      const auto found = ids_.find(child->require("id"));
      if (found == ids_.end())
        throw InputError(child->where,
                         "<alias> of \"" + child->require("id") + "\", which is not defined before it");
      const Element* target = found->second;
      const auto [other, fresh] = ids_.emplace(child->require("as"), target);
      if (!fresh)
        throw InputError(
            child->where,
            "the id \"" + other->first + "\" is used twice, first at " + to_string(other->second->where),
            "rename one");
      continue;
    }
    const std::string* id = child->find("id");
    if (id && child->tag != "ref" && child->find("type")) {
      const auto [other, fresh] = ids_.emplace(*id, child.get());
      if (!fresh)
        throw InputError(child->where,
                         "the id \"" + *id + "\" is used twice, first at " + to_string(other->second->where),
                         "rename one");
    } else if (id && child->tag != "ref") {
      ids_.emplace(
          *id, child.get());  // a property with an id: it may be referred to, Mitsuba does not mind doubles
    }
    index_ids(*child);
  }
}

const Element& Reader::resolve(const Element& element) const {
  if (element.tag != "ref") return element;
  const std::string& id = element.require("id");
  const auto found = ids_.find(id);
  if (found != ids_.end()) return *found->second;
  throw InputError(element.where, "<ref id=\"" + id + "\"> names nothing in the scene",
                   "define the id, or correct it");
}

Reader::NamedFile Reader::file(const std::string& name, const SourceLocation& where, const std::string& kind,
                               const std::string& stand_in) {
  return named_file(resolve_path(name, where.file), where, kind, stand_in);
}

void Reader::build_top_level(const Element& element) {
  const std::string& tag = element.tag;
  if (tag == "shape") {
    build_shape(element, false);
  } else if (tag == "bsdf") {
    build_bsdf(element);
  } else if (tag == "texture") {
    Rgb unused;
    if (!constant_texture(element, Intent::reflectance, unused)) build_texture(element);
  } else if (tag == "emitter") {
    build_emitter(element);
  } else if (tag == "sensor") {
    build_sensor(element);
  } else if (tag == "integrator") {
    build_integrator(element);
  } else if (tag == "medium") {
    build_medium(element);
  } else if ((tag == "phase" || tag == "volume") && element.find("id")) {
    // Built where it is referred to.
  } else if (tag == "sampler" || tag == "film" || tag == "rfilter" || tag == "phase" || tag == "volume" ||
             tag == "subsurface" || tag == "ref") {
    warn(element.where, "a <" + tag + "> directly in the scene", "");
  } else if (tag == "integer" || tag == "float" || tag == "boolean" || tag == "string" || tag == "rgb" ||
             tag == "spectrum" || tag == "transform" || tag == "point" || tag == "vector" || tag == "srgb") {
    if (!element.find("id")) warn(element.where, "a property <" + tag + "> of the scene itself", "");
  } else if (tag != "alias") {
    throw InputError(element.where, "<" + tag + "> is not an element of the Mitsuba format",
                     "check its spelling");
  }
}

void Reader::check_area_emitters_used() {
  for (const auto& child : document_.root->children) {
    const std::string* type = child->find("type");
    if (child->tag == "emitter" && type && *type == "area" && !used_area_emitters_.count(child.get()))
      throw InputError(child->where, "an area emitter that belongs to no shape", "put it into a <shape>");
  }
}

SceneDesc Reader::read() {
  for (const auto& [where, what] : document_.notes) warn(where, what, "");
  index_ids(*document_.root);
  for (const auto& child : document_.root->children) build_top_level(*child);
  check_area_emitters_used();
  if (scene_.sensors.empty())
    throw InputError(document_.root->where, "the scene has no sensor", "add a <sensor type=\"perspective\">");
  check_expansion(scene_);
  return std::move(scene_);
}

}  // namespace lumirank::scenedesc::mitsuba

namespace lumirank::scenedesc {

SceneDesc parse_mitsuba(const std::string& text, const std::string& filename, const ReadOptions& options) {
  const mitsuba::Document document = mitsuba::load_document(text, filename, options.defines);
  return mitsuba::Reader(document, filename, options).read();
}

SceneDesc read_mitsuba(const std::string& filename, const ReadOptions& options) {
  return parse_mitsuba(read_file(filename, SourceLocation{}, kMaxText), filename, options);
}

}  // namespace lumirank::scenedesc
