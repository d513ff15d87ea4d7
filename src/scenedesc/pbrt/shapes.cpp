#include <algorithm>
#include <cmath>

#include "scenedesc/pbrt/reader.h"
#include "scenedesc/pbrt/shape_kinds.h"
#include "scenedesc/pbrt/version3.h"

namespace lumirank::scenedesc::pbrt {

namespace {

bool is_null(const SceneDesc& scene, int bsdf) {
  return std::holds_alternative<NullBsdfDesc>(scene.bsdfs[static_cast<std::size_t>(bsdf)].kind);
}

// Curves of the same looks, one after the other, are one shape: hair has millions of them.
bool joins(const ShapeDesc& last, const ShapeDesc& next) {
  const auto *a = std::get_if<CurvesDesc>(&last.kind), *b = std::get_if<CurvesDesc>(&next.kind);
  return a && b && a->basis == b->basis && last.bsdf == next.bsdf && last.to_world == next.to_world &&
         last.flip_normals == next.flip_normals && last.in_group == next.in_group &&
         last.media.inside == next.media.inside && last.media.outside == next.media.outside &&
         !last.emitter && !next.emitter;
}

void join(CurvesDesc& all, const CurvesDesc& more) {
  const auto base = static_cast<std::uint32_t>(all.points.size());
  all.points.insert(all.points.end(), more.points.begin(), more.points.end());
  all.radii.insert(all.radii.end(), more.radii.begin(), more.radii.end());
  for (std::size_t i = 1; i < more.first.size(); ++i) all.first.push_back(base + more.first[i]);
}

}  // namespace

// The shape's own cut-out around its material.
int Reader::masked(Params& p, const FloatInput& alpha, int bsdf) {
  if (alpha.texture == kNone && alpha.value >= 1) return bsdf;
  if (alpha.texture == kNone) {
    return add_bsdf("", p.where_of("alpha"), MaskDesc{{std::max(alpha.value, 0.0f)}, bsdf});
  }
  const auto [it, fresh] = masks_.try_emplace({bsdf, alpha.texture}, kNone);
  if (fresh) it->second = add_bsdf("", p.where_of("alpha"), MaskDesc{alpha, bsdf});
  return it->second;
}

void Reader::read_shape(Params& p, const std::string& type) {
  if (version3_) upgrade_shape(p, type);
  ShapeDesc shape;
  shape.where = p.where();
  shape.to_world = to_world(p.where());
  shape.flip_normals = state_.reverse;
  shape.media = current_media();
  if (!shape.to_world.inverse())
    throw InputError(p.where(), "the transform of " + p.title() + " is singular", "a Scale by 0 perhaps");
  auto kind = make_shape(*this, p, type, shape.to_world);
  const int bsdf = current_bsdf(p.where());
  const FloatInput alpha = scalar(p, "alpha", {1});
  // What no ray meets still casts light.
  const bool unseen_lamp = state_.light && alpha.texture == kNone && alpha.value <= 0;
  shape.bsdf = unseen_lamp ? add_bsdf("", p.where_of("alpha"), NullBsdfDesc{}) : masked(p, alpha, bsdf);
  if (unseen_lamp) shape.media = {};
  if (!kind) return;
  shape.kind = std::move(*kind);
  std::shared_ptr<const AreaLight> light = state_.light;
  if (light && std::holds_alternative<CurvesDesc>(shape.kind)) {
    warn_once(p.where(), "curves that shine", "dark ones");
    light = nullptr;
  }
  if (light && in_object_) {
    warn_once(p.where(), "area lights in objects (pbrt leaves them out too)", "the shapes without light");
    light = nullptr;
  }
  if (light && version3_ &&
      is_null(scene_, bsdf))  // which shines there, and lets through what comes from behind
    shape.bsdf = add_bsdf("", p.where(), DiffuseDesc{{Rgb(0), kNone}});
  else if (light && is_null(scene_, bsdf)) {
    warn_once(p.where(), "area lights with the material \"interface\" (pbrt leaves them out too)",
              "no light");
    light = nullptr;
  }
  add_shape(p, std::move(shape), light, !unseen_lamp);
}

void Reader::add_shape(Params& p, ShapeDesc shape, const std::shared_ptr<const AreaLight>& light,
                       bool lamp_is_seen) {
  shape.in_group = in_object_;
  if (!scene_.shapes.empty() && joins(scene_.shapes.back(), shape)) {
    join(std::get<CurvesDesc>(scene_.shapes.back().kind), std::get<CurvesDesc>(shape.kind));
    return;
  }
  std::optional<ShapeDesc> back;
  if (light) back = shine(*this, p, shape, *light);
  for (ShapeDesc* side : {&shape, back ? &*back : nullptr})
    if (side && side->emitter) side->emitter->seen = lamp_is_seen;
  scene_.shapes.push_back(std::move(shape));
  const auto add_to_object = [&] {
    if (!in_object_) return;
    auto& group = scene_.shapes[static_cast<std::size_t>(object_group_)];
    std::get<ShapeGroupDesc>(group.kind).shapes.push_back(static_cast<int>(scene_.shapes.size()) - 1);
  };
  add_to_object();
  if (back) scene_.shapes.push_back(std::move(*back));
}

void Reader::begin_object(const std::string& name, const Place& where) {
  if (in_object_)
    throw InputError(where, "ObjectBegin in the object " + in_quotes(object_),
                     "objects cannot be nested; close it first");
  if (objects_.count(name))
    throw InputError(where, "the object " + in_quotes(name) + " is defined twice", "rename one");
  push("ObjectBegin", where);
  in_object_ = true;
  object_ = name;
  ShapeDesc group;
  group.id = name;
  group.where = where;
  group.kind = ShapeGroupDesc{};
  scene_.shapes.push_back(std::move(group));
  object_group_ = static_cast<int>(scene_.shapes.size()) - 1;
}

void Reader::end_object(const Place& where) {
  pop("ObjectBegin", "ObjectEnd", where);
  in_object_ = false;
  objects_[object_] = object_group_;
}

void Reader::read_instance(const std::string& name, const Place& where) {
  if (in_object_)
    throw InputError(where, "ObjectInstance in the object " + in_quotes(object_),
                     "objects cannot hold instances");
  ShapeDesc shape;
  shape.where = where;
  shape.to_world = to_world(where);
  const auto found = objects_.find(name);
  shape.kind = InstanceDesc{found == objects_.end() ? kNone : found->second};
  if (found == objects_.end()) pending_instances_.emplace_back(static_cast<int>(scene_.shapes.size()), name);
  scene_.shapes.push_back(std::move(shape));
}

}  // namespace lumirank::scenedesc::pbrt
