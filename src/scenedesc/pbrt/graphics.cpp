// Directives that change the graphics state: transforms, blocks, attributes.
#include <cmath>

#include "scenedesc/pbrt/reader.h"
#include "scenedesc/pbrt/version3.h"
#include "scenedesc/schema/keyed_transform.h"
#include "scenedesc/schema/warnings.h"

namespace lumirank::scenedesc::pbrt {

namespace {

// pbrt writes matrices column by column.
Transform from_columns(const std::vector<double>& v) {
  Transform t;
  for (std::size_t row = 0; row < 4; ++row)
    for (std::size_t column = 0; column < 4; ++column) t.m[4 * row + column] = v[4 * column + row];
  return t;
}

Vec3f vec3(const std::vector<double>& v, std::size_t at) {
  return {static_cast<float>(v[at]), static_cast<float>(v[at + 1]), static_cast<float>(v[at + 2])};
}

Transform look_at(const std::vector<double>& v, const Place& where) {
  const Vec3d eye{v[0], v[1], v[2]}, target{v[3], v[4], v[5]};
  const Vec3f up = vec3(v, 6);
  if (eye == target) throw InputError(where, "LookAt has the same eye and target");
  const auto forward = static_cast<Vec3f>(Transform::look_at(eye, target, up).axis(2));
  if (!(length(up) > 0) || !(length(cross(forward, normalize(up))) > 1e-6f))
    throw InputError(where, "the up of LookAt is parallel to its line of sight", "choose another up");
  // The same columns in pbrt, where the first points to the right.
  return Transform::look_at(eye, target, up).inverse().value_or(Transform{});
}

}  // namespace

void Reader::apply(const Transform& step, const Place& where) {
  const auto move = [&](Transform& t) {
    const Transform next = t * step;
    if (!next.is_finite()) throw InputError(where, "the transform overflows", "use smaller factors");
    t = next;
  };
  if (state_.start_active) move(state_.at_start);
  if (state_.end_active) move(state_.at_end);
}

void Reader::set_transform(const Transform& at_start, const Transform& at_end) {
  if (state_.start_active) state_.at_start = at_start;
  if (state_.end_active) state_.at_end = at_end;
}

Transform Reader::between(const Transform& at_start, const Transform& at_end, const Place& where) {
  if (at_start == at_end) return at_start;
  if (is_new("moves at " + to_string(where)))
    add_motion(to_string(where) + ": ActiveTransform", start_time_, end_time_);
  if (!options_.time) {
    if (is_new("ActiveTransform"))
      add_note(
          scene_, where,
          "moving objects (ActiveTransform): as they are at the start; --at SECONDS shows another moment");
    return at_start;
  }
  return transform_at({{start_time_, at_start}, {end_time_, at_end}}, *options_.time);
}

bool Reader::transform_directive(Tokens& tokens, const Token& word) {
  const std::string_view name = word.value;
  const Place where = tokens.place(word);
  if (name == "Identity") {
    set_transform({}, {});
  } else if (name == "Translate") {
    const auto v = take_numbers(tokens, word, 3);
    apply(Transform::translate(v[0], v[1], v[2]), where);
  } else if (name == "Scale") {
    const auto v = take_numbers(tokens, word, 3);
    apply(Transform::scale(v[0], v[1], v[2]), where);
  } else if (name == "Rotate") {
    const auto v = take_numbers(tokens, word, 4);
    if (!(std::hypot(v[1], v[2], v[3]) > 0))
      throw InputError(where, "the axis of Rotate is zero", "write Rotate 90 0 1 0, say");
    apply(Transform::rotate(v[1], v[2], v[3], v[0]), where);
  } else if (name == "LookAt") {
    apply(look_at(take_numbers(tokens, word, 9), where), where);
  } else if (name == "Transform") {
    const Transform t = from_columns(take_numbers(tokens, word, 16));
    set_transform(t, t);
  } else if (name == "ConcatTransform") {
    apply(from_columns(take_numbers(tokens, word, 16)), where);
  } else if (name == "CoordinateSystem") {
    coordinate_systems_[take_text(tokens, word, "name")] = {state_.at_start, state_.at_end};
  } else if (name == "CoordSysTransform") {
    const std::string system = take_text(tokens, word, "name");
    const auto found = coordinate_systems_.find(system);
    if (found == coordinate_systems_.end())
      throw InputError(where, "the coordinate system " + in_quotes(system) + " is not defined",
                       "define it with CoordinateSystem");
    set_transform(found->second.first, found->second.second);
  } else if (name == "ActiveTransform") {
    const Token which = tokens.take();
    if (which.kind != Token::Kind::word ||
        (which.value != "StartTime" && which.value != "EndTime" && which.value != "All"))
      throw InputError(where, "ActiveTransform is not followed by StartTime, EndTime or All");
    state_.start_active = which.value != "EndTime";
    state_.end_active = which.value != "StartTime";
  } else if (name == "TransformTimes") {
    const auto v = take_numbers(tokens, word, 2);
    if (!(v[1] > v[0]))
      throw InputError(where, "TransformTimes does not rise", "give the start, then the end");
    start_time_ = v[0], end_time_ = v[1];
  } else {
    return false;
  }
  return true;
}

bool Reader::block_directive(Tokens& tokens, const Token& word) {
  const std::string_view name = word.value;
  const Place where = tokens.place(word);
  if (name == "AttributeBegin") {
    push("AttributeBegin", where);
  } else if (name == "AttributeEnd") {
    pop("AttributeBegin", "AttributeEnd", where);
  } else if (name == "TransformBegin") {  // of older scenes; pbrt-v4 still takes them
    push("TransformBegin", where);
  } else if (name == "TransformEnd") {
    GraphicsState kept = state_;
    pop("TransformBegin", "TransformEnd", where);
    kept.at_start = state_.at_start, kept.at_end = state_.at_end;
    kept.start_active = state_.start_active, kept.end_active = state_.end_active;
    state_ = std::move(kept);
  } else if (name == "WorldBegin") {
    require_world(word, where, false);
    if (!saved_.empty())
      throw InputError(where, "WorldBegin in a block of " + std::string(saved_.back().by), "close it first");
    in_world_ = true;
    state_.at_start = state_.at_end = {};
    state_.start_active = state_.end_active = true;
    coordinate_systems_["world"] = {};
    finish_camera();
  } else if (name == "WorldEnd") {
    if (!version3_)
      throw InputError(where, "WorldEnd is not a directive of pbrt-v4",
                       "a scene of pbrt-v3 ends with it: remove what comes after it");
    require_world(word, where, true);
    ended_ = true;  // what may come after it is another scene
  } else {
    return false;
  }
  return true;
}

bool Reader::state_directive(Tokens& tokens, const Token& word) {
  const std::string_view name = word.value;
  const Place where = tokens.place(word);
  if (name == "ReverseOrientation") {
    state_.reverse = !state_.reverse;
  } else if (name == "Attribute") {
    inherit(tokens, word);
  } else if (name == "Texture") {
    const std::string texture = take_text(tokens, word, "name"), type = take_text(tokens, word, "type");
    const std::string kind = take_text(tokens, word, "class");
    Params p = take_params(tokens, word, kind, "texture");
    if (version3_) upgrade_texture(p, kind);
    read_texture(p, texture, type, kind);
    p.finish();
  } else if (name == "Material") {
    const std::string type = take_text(tokens, word, "type");
    Params p = take_params(tokens, word, type, "material");
    state_.bsdf = make_material(p, type, "");
    p.finish();
  } else if (name == "MakeNamedMaterial") {
    const std::string material = take_text(tokens, word, "name");
    Params p = take_params(tokens, word, material, "material");
    name_material(p, material);
    p.finish();
  } else if (name == "NamedMaterial") {
    state_.bsdf = named_material(take_text(tokens, word, "name"), where);
  } else if (name == "MakeNamedMedium") {
    const std::string medium = take_text(tokens, word, "name");
    Params p = take_params(tokens, word, medium, "medium");
    name_medium(p, medium);
    p.finish();
  } else if (name == "MediumInterface") {
    state_.inside = state_.outside = medium_slot(take_text(tokens, word, "medium"), where);
    if (tokens.peek().kind == Token::Kind::text)
      state_.outside = medium_slot(std::string(tokens.take().value), where);
  } else {
    return false;
  }
  return true;
}

bool Reader::object_directive(Tokens& tokens, const Token& word) {
  const std::string_view name = word.value;
  const Place where = tokens.place(word);
  if (name == "ObjectBegin") {
    require_world(word, where, true);
    begin_object(take_text(tokens, word, "name"), where);
  } else if (name == "ObjectEnd") {
    end_object(where);
  } else if (name == "ObjectInstance") {
    require_world(word, where, true);
    read_instance(take_text(tokens, word, "name"), where);
  } else if (name == "Shape") {
    require_world(word, where, true);
    const std::string type = take_text(tokens, word, "type");
    Params p = take_params(tokens, word, type, "shape");
    read_shape(p, type);
    p.finish();
  } else if (name == "LightSource") {
    require_world(word, where, true);
    const std::string type = take_text(tokens, word, "type");
    Params p = take_params(tokens, word, type, "light");
    read_light(p, type);
    p.finish();
  } else if (name == "AreaLightSource") {
    require_world(word, where, true);
    const std::string type = take_text(tokens, word, "type");
    Params p = take_params(tokens, word, type, "light");
    read_area_light(p, type);
    p.finish();
  } else {
    return false;
  }
  return true;
}

}  // namespace lumirank::scenedesc::pbrt
