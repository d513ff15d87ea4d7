// BSDFs that change or mix others.
#include <cmath>

#include "scenedesc/mitsuba/bsdf_fields.h"

namespace lumirank::scenedesc::mitsuba {

namespace {

int only_texture(Reader& reader, Plugin& p, std::initializer_list<const char*> names) {
  for (const char* name : names)
    if (const Element* found = p.take_named(name, "texture")) return reader.build_texture(*found);
  if (const Element* nested = p.take_one("texture")) return reader.build_texture(*nested);
  throw InputError(p.where(), p.title() + " has no texture in it", "nest a <texture>, or a <ref> to one");
}

}  // namespace

int only_bsdf(Reader& reader, Plugin& p) {
  const Element* nested = p.take_one("bsdf");
  if (!nested)
    throw InputError(p.where(), p.title() + " has no BSDF in it", "nest a <bsdf>, or a <ref> to one");
  return reader.build_bsdf(*nested);
}

BsdfKind coating(Reader& reader, Plugin& p) {
  CoatingDesc out;
  read_fields(reader, p, out);
  const float thickness = p.number("thickness", 1);
  if (!(thickness >= 0))
    throw InputError(p.where_of("thickness"), "\"thickness\" of " + p.title() + " is negative");
  out.absorption = p.color("sigma_a", Rgb(0), Intent::index);
  if (out.absorption.texture == kNone) {
    const Rgb a = out.absorption.value;
    if (a.r < 0 || a.g < 0 || a.b < 0)
      throw InputError(p.where_of("sigma_a"), "\"sigma_a\" of " + p.title() + " is negative");
    out.absorption.value *= thickness;
  } else if (thickness != 1) {
    out.absorption.texture =
        reader.add_texture("", p.where_of("sigma_a"), ScaleTextureDesc{out.absorption, Rgb(thickness)});
  }
  return out;
}

BsdfKind two_sided(Reader& reader, Plugin& p) {
  const auto nested = p.take_all("bsdf");
  if (nested.empty())
    throw InputError(p.where(), p.title() + " has no BSDF in it", "nest a <bsdf>, or a <ref> to one");
  if (nested.size() > 2)
    throw InputError(nested[2]->where, p.title() + " has more than two BSDFs", "keep one or two");
  TwoSidedDesc out;
  out.front = reader.build_bsdf(*nested[0]);
  out.back = nested.size() == 2 ? reader.build_bsdf(*nested[1]) : out.front;
  return out;
}

BsdfKind bump_map(Reader& reader, Plugin& p) {
  BumpMapDesc out;
  out.scale = p.number("scale", 1);
  out.texture = only_texture(reader, p, {"map", "texture", "bump", "nested_texture"});
  read_fields(reader, p, out);
  return out;
}

BsdfKind normal_map(Reader& reader, Plugin& p) {
  NormalMapDesc out;
  out.texture = only_texture(reader, p, {"normalmap", "map", "texture"});
  read_fields(reader, p, out);
  return out;
}

BsdfKind mixture(Reader& reader, Plugin& p) {
  const auto weights =
      parse_list(p.required_text("weights"), p.where_of("weights"), "\"weights\" of " + p.title());
  const auto nested = p.take_all("bsdf");
  if (weights.size() != nested.size())
    throw InputError(p.where_of("weights"),
                     p.title() + " has " + std::to_string(weights.size()) + " weights and " +
                         std::to_string(nested.size()) + " BSDFs",
                     "give one weight for each");
  MixtureDesc out;
  double sum = 0;
  for (const double w : weights) {
    if (w < 0) throw InputError(p.where_of("weights"), "a weight of " + p.title() + " is negative");
    sum += w;
  }
  if (!(sum > 0)) throw InputError(p.where_of("weights"), "the weights of " + p.title() + " are all 0");
  if (sum > 1 + 1e-4)
    reader.warn(p.where_of("weights"), "weights of a mixture that add up to more than 1",
                "the weights divided by their sum");
  const double scale = sum > 1 ? 1 / sum : 1;
  for (std::size_t i = 0; i < nested.size(); ++i)
    out.parts.push_back(
        {{static_cast<float>(weights[i] * scale), kNone}, false, reader.build_bsdf(*nested[i])});
  return out;
}

BsdfKind blend(Reader& reader, Plugin& p) {
  if (!p.has("weight"))
    throw InputError(p.where(), p.title() + " has no \"weight\"",
                     "add <float name=\"weight\" value=\"…\"/> or a texture");
  const FloatInput weight = p.scalar("weight", 0.5f);
  if (weight.texture == kNone && !(weight.value >= 0 && weight.value <= 1))
    throw InputError(p.where_of("weight"), "\"weight\" of " + p.title() + " is not between 0 and 1");
  const auto nested = p.take_all("bsdf");
  if (nested.size() != 2)
    throw InputError(p.where(), p.title() + " has " + std::to_string(nested.size()) + " BSDFs; 2 are needed");
  MixtureDesc out;
  out.parts.push_back({weight, true, reader.build_bsdf(*nested[0])});
  out.parts.push_back({weight, false, reader.build_bsdf(*nested[1])});
  return out;
}

}  // namespace lumirank::scenedesc::mitsuba
