#include "scenedesc/mitsuba/curves.h"
#include "scenedesc/mitsuba/plugin.h"
#include "scenedesc/schema/files.h"

namespace lumirank::scenedesc::mitsuba {

namespace {

decltype(ShapeDesc::kind) mesh_file(Reader& reader, Plugin& p, MeshFormat format) {
  MeshFileDesc out;
  out.format = format;
  const std::string name = p.required_text("filename");
  const SourceLocation where = p.where_of("filename");
  const std::string path = resolve_path(name, where.file);
  const auto file = reader.named_file(reader.path_at_time(path), where, "mesh file", "");
  out.filename = file.name;
  out.sequence = Reader::sequence(path);
  out.face_normals = p.flag("face_normals", false);
  // The same defaults in 0.6 and 3.x: the v of OBJ runs up and is flipped, that of the others runs down
  // already.
  out.flip_tex_coords = p.flag("flip_tex_coords", format == MeshFormat::obj);
  if (const auto angle = p.number("max_smooth_angle")) {
    if (!(*angle >= 0 && *angle <= 180))
      throw InputError(p.where_of("max_smooth_angle"),
                       "\"max_smooth_angle\" of " + p.title() + " is not between 0 and 180");
    if (out.face_normals)
      throw InputError(p.where_of("max_smooth_angle"),
                       p.title() + " has both \"max_smooth_angle\" and \"face_normals\"", "keep one of them");
    out.max_smooth_angle = *angle;
  }
  if (format == MeshFormat::serialized) {
    out.shape_index = p.integer("shape_index", 0);
    if (out.shape_index < 0)
      throw InputError(p.where_of("shape_index"), "\"shape_index\" of " + p.title() + " is negative");
  } else if (format == MeshFormat::obj && p.has("shape_index")) {
    reader.warn(p.where_of("shape_index"), "a \"shape_index\" of OBJ files", "all shapes of the file");
    p.ignore({"shape_index"});
  }
  p.ignore({"collapse", "load_materials", "srgb", "vertex_normals", "compress"});
  if (file.missing) return InlineMeshDesc{nullptr, out.filename};
  return out;
}

Vec3d point(Plugin& p, const std::string& name, Vec3d fallback) { return p.vec3(name).value_or(fallback); }

// The kinds that are no group and no instance; false: Lumirank does not have it.
bool plain_shape(Reader& reader, Plugin& p, ShapeDesc& shape) {
  const std::string& type = p.type();
  if (type == "obj" || type == "ply" || type == "serialized") {
    shape.kind = mesh_file(
        reader, p,
        type == "obj" ? MeshFormat::obj : (type == "ply" ? MeshFormat::ply : MeshFormat::serialized));
  } else if (type == "bsplinecurve" || type == "linearcurve" || type == "hair") {
    shape.to_world = p.regular_transform();
    shape.kind = curves(reader, p, shape.to_world);
  } else if (type == "rectangle") {
    shape.kind = RectangleDesc{};
  } else if (type == "cube") {
    shape.kind = CubeDesc{};
  } else if (type == "sphere") {
    shape.kind = SphereDesc{point(p, "center", {}), p.positive("radius", 1)};
  } else if (type == "disk") {
    shape.kind = DiskDesc{};
  } else if (type == "cylinder") {
    const CylinderDesc cylinder{point(p, "p0", {0, 0, 0}), point(p, "p1", {0, 0, 1}),
                                p.positive("radius", 1)};
    if (cylinder.p1 == cylinder.p0)
      throw InputError(p.where_of("p1"), "p0 and p1 of " + p.title() + " are the same point");
    shape.kind = cylinder;
  } else {
    return false;
  }
  return true;
}

}  // namespace

AreaEmitterDesc Reader::area_emitter(const Element& element) {
  Plugin p(*this, element);
  AreaEmitterDesc out;
  out.id = p.id();
  out.where = p.where();
  out.radiance = p.radiance("radiance", Rgb(1));
  p.ignore({"sampling_weight"});
  p.take_all("medium");  // the shape says what is around it
  p.finish();
  used_area_emitters_.insert(&element);
  return out;
}

// Merges that name merges twice over would double at each.
std::vector<const Element*> Reader::merged(Plugin& p) {
  constexpr std::size_t kMost = 1'000'000;
  std::vector<const Element*> parts = p.take_all("shape");
  merged_ += 1 + parts.size();
  if (merged_ > kMost)
    throw InputError(p.where(), "merged shapes name more than a million shapes", "name each of them once");
  return parts;
}

ShapeGroupDesc Reader::shape_group(Plugin& p) {
  ShapeGroupDesc out;
  const auto add = [&](const auto& self, const Element& member) -> void {
    if (member.require("type") == "merge") {
      const OpenGuard guard(*this, member);
      Plugin merge(*this, member);
      for (const Element* part : merged(merge)) self(self, *part);
      merge.finish();
    } else if (const int index = build_shape(member, true); index != kNone) {
      out.shapes.push_back(index);
    }
  };
  for (const Element* member : p.take_all("shape")) add(add, *member);
  if (out.shapes.empty()) throw InputError(p.where(), p.title() + " holds no shapes", "nest a <shape>");
  return out;
}

InstanceDesc Reader::shape_instance(Plugin& p) {
  const Element* target = p.take_one("shape");
  if (!target) throw InputError(p.where(), p.title() + " names no shapegroup", "add <ref id=\"…\"/>");
  if (target->require("type") != "shapegroup")
    throw InputError(p.where(), p.title() + " refers to a shape that is not a shapegroup",
                     "put that shape into a shapegroup");
  return InstanceDesc{build_shape(*target, false)};
}

void Reader::add_surface(Plugin& p, ShapeDesc& shape) {
  const auto bsdfs = p.take_all("bsdf");
  if (bsdfs.size() > 1)
    throw InputError(bsdfs[1]->where, p.title() + " has more than one BSDF", "keep one of them");
  if (!bsdfs.empty()) shape.bsdf = build_bsdf(*bsdfs[0]);
  const Element* emitter = p.take_one("emitter");
  if (emitter && emitter->require("type") == "directionalarea") {
    // Mitsuba's own path tracer finds none of its light either.
    warn(emitter->where, "the emitter \"directionalarea\"", "a dark surface");
    emitter = nullptr;
  }
  if (emitter) {
    if (emitter->require("type") != "area")
      throw InputError(emitter->where, "an emitter \"" + emitter->require("type") + "\" in a shape",
                       "only area emitters can be there");
    if (shape.in_group)
      throw InputError(emitter->where, "an area emitter in a shapegroup",
                       "instances cannot emit light; take the shape out of the group");
    shape.emitter = area_emitter(*emitter);
    if (shape.emitter->id.empty()) shape.emitter->id = shape.id;
  }
  // Without a BSDF, lamps are black in both dialects, and in 0.6 the boundary of a medium cannot be seen.
  if (shape.bsdf == kNone && shape.emitter)
    shape.bsdf = add_bsdf("", p.where(), DiffuseDesc{{Rgb(0), kNone}});
  else if (shape.bsdf == kNone && dialect().camel_case() && p.has_object("medium"))
    shape.bsdf = add_bsdf("", p.where(), NullBsdfDesc{});
  add_media(p, shape);
}

int Reader::build_shape(const Element& element, bool in_group) {
  if (const auto found = groups_.find(&element); found != groups_.end()) return found->second;
  const OpenGuard guard(*this, element);
  Plugin p(*this, element);
  ShapeDesc shape;
  shape.id = p.id();
  shape.where = p.where();
  shape.in_group = in_group;
  const std::string& type = p.type();
  const bool group = type == "shapegroup", instance = type == "instance";
  if (in_group && (group || instance))
    throw InputError(p.where(), "a " + type + " in a shapegroup", "groups cannot be nested; take it out");

  if (type == "merge") {  // its shapes as they are
    for (const Element* part : merged(p)) build_shape(*part, in_group);
    p.finish();
    return kNone;
  }
  if (group) {
    shape.kind = shape_group(p);
  } else if (instance) {
    shape.kind = shape_instance(p);
  } else if (!plain_shape(*this, p, shape)) {
    warn(p.where(), "the shape \"" + type + "\"", "");
    return kNone;
  }
  if (!group) shape.to_world = p.regular_transform();
  shape.flip_normals = p.flag("flip_normals", false);
  if (!group && !instance) add_surface(p, shape);
  p.finish();
  scene_.shapes.push_back(std::move(shape));
  const int index = static_cast<int>(scene_.shapes.size()) - 1;
  if (group) groups_[&element] = index;
  return index;
}

}  // namespace lumirank::scenedesc::mitsuba
