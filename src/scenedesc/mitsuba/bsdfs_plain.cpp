// BSDFs that hold no others.
#include <cmath>

#include "scenedesc/data/ior.h"
#include "scenedesc/data/mitsuba_metals.h"
#include "scenedesc/mitsuba/bsdf_fields.h"

namespace lumirank::scenedesc::mitsuba {

namespace {

// A number, or the name of a material.
float index_of(Plugin& p, const std::string& name, const std::string& fallback) {
  std::string material = fallback;
  if (p.has(name)) {
    const auto text = p.text_or_number(name);
    if (const float* number = std::get_if<float>(&text)) {
      if (!(*number > 0))
        throw InputError(p.where_of(name), "\"" + name + "\" of " + p.title() + " is not positive",
                         "indices of refraction are 1 or more");
      return *number;
    }
    material = std::get<std::string>(text);
  }
  if (const auto index = dielectric_index(material)) return *index;
  throw InputError(p.where_of(name), "the material \"" + material + "\" is not known",
                   "give a number, or one of: " + dielectric_names());
}

void check_alpha(Plugin& p, const std::string& name, const FloatInput& alpha) {
  if (alpha.texture == kNone && !(alpha.value >= 0))
    throw InputError(p.where_of(name), "\"" + name + "\" of " + p.title() + " is negative",
                     "give a roughness from 0 to 1");
}

}  // namespace

float relative_index(Plugin& p, const std::string& interior) {
  const float inside = index_of(p, "int_ior", interior);
  return inside / index_of(p, "ext_ior", "air");
}

Roughness roughness(Reader& reader, Plugin& p, float fallback) {
  Roughness out;
  if (const auto name = p.text("distribution")) {
    if (*name == "ggx" || *name == "trowbridge-reitz")
      out.distribution = Distribution::ggx;
    else if (*name == "phong" || *name == "as")
      reader.warn(p.where_of("distribution"), "the microfacet distribution \"" + *name + "\"",
                  "beckmann of the same alpha");
    else if (*name != "beckmann")
      throw InputError(p.where_of("distribution"), "the distribution \"" + *name + "\" is not known",
                       "beckmann and ggx are");
  }
  const FloatInput alpha = p.scalar("alpha", fallback);
  check_alpha(p, "alpha", alpha);
  out.alpha_u = p.has("alpha_u") ? p.scalar("alpha_u", fallback) : alpha;
  out.alpha_v = p.has("alpha_v") ? p.scalar("alpha_v", fallback) : alpha;
  check_alpha(p, "alpha_u", out.alpha_u);
  check_alpha(p, "alpha_v", out.alpha_v);
  p.ignore({"sample_visible"});
  return out;
}

bool is_rough(const Plugin& p) { return p.type().rfind("rough", 0) == 0; }

void check_range(Plugin& p, const char* name, const FloatInput& found, Range range) {
  if (found.texture != kNone || range == Range::any) return;
  const std::string what = std::string("\"") + name + "\" of " + p.title();
  if (!(found.value >= 0) && range == Range::not_negative)
    throw InputError(p.where_of(name), what + " is negative", "give 0 or more");
  const float max = range == Range::to_2 ? 2 : 1;
  const std::string limits = max == 1 ? "0 and 1" : "0 and 2";
  if (range != Range::not_negative && !(found.value >= 0 && found.value <= max))
    throw InputError(p.where_of(name), what + " is not between " + limits, "give a number between " + limits);
}

namespace {

// 0.6 takes either name.
void diffuse_reflectance(Plugin& p, ColorInput& reflectance) {
  if (!p.has("reflectance")) reflectance = p.reflectance("diffuse_reflectance", Rgb(0.5f));
}

}  // namespace

BsdfKind diffuse(Reader& reader, Plugin& p) {
  DiffuseDesc out;
  read_fields(reader, p, out);
  diffuse_reflectance(p, out.reflectance);
  return out;
}

BsdfKind rough_diffuse(Reader& reader, Plugin& p) {
  RoughDiffuseDesc out;
  read_fields(reader, p, out);
  diffuse_reflectance(p, out.reflectance);
  p.ignore({"use_fast_approx"});
  return out;
}

BsdfKind conductor(Reader& reader, Plugin& p) {
  ConductorDesc out;
  const bool own = p.has("eta") || p.has("k");
  const auto name = p.text("material");
  if (own && name)
    throw InputError(p.where_of("material"), p.title() + " has both a material and its own eta and k",
                     "keep one of them");
  MetalIndex metal = {Rgb(0), Rgb(1)};
  if (!own) {
    const std::string material = name.value_or(reader.dialect().camel_case() ? "Cu" : "none");
    if (const auto known = mitsuba_metal(material)) {
      metal = *known;
    } else {
      metal = *mitsuba_metal("Cr");
      reader.warn(p.where_of("material"),
                  "the metal \"" + material + "\" (known are: " + mitsuba_metal_names() + ")", "Cr");
    }
  } else {
    metal.eta = p.constant_color("eta", Rgb(0), Intent::index);
    metal.k = p.constant_color("k", Rgb(0), Intent::index);
    for (int i = 0; i < 3; ++i) {
      if (metal.eta[i] < 0) throw InputError(p.where_of("eta"), "\"eta\" of " + p.title() + " is negative");
      if (metal.k[i] < 0) throw InputError(p.where_of("k"), "\"k\" of " + p.title() + " is negative");
    }
  }
  // 0.6 divides by the outside's index, which is that of air unless given; 3.x does not know it.
  const float outside = p.has("ext_eta") ? index_of(p, "ext_eta", "air")
                                         : (reader.dialect().camel_case() ? *dielectric_index("air") : 1.0f);
  out.eta = metal.eta / outside;
  out.k = metal.k / outside;
  read_fields(reader, p, out);
  return out;
}

BsdfKind plastic(Reader& reader, Plugin& p) {
  PlasticDesc out;
  read_fields(reader, p, out);
  if (is_rough(p)) {
    if (p.has("alpha_u") || p.has("alpha_v"))
      throw InputError(p.where_of(p.has("alpha_u") ? "alpha_u" : "alpha_v"),
                       p.title() + " cannot be anisotropic", "give one \"alpha\"");
    const Roughness r = roughness(reader, p, 0.1f);
    out.distribution = r.distribution, out.alpha = r.alpha_u;
    out.as_mitsuba_3 = !reader.dialect().camel_case();
  }
  return out;
}

// Without polarization it is a rough plastic, nearly: of what is reflected within, less comes out there.
BsdfKind polarized_plastic(Reader& reader, Plugin& p) {
  PlasticDesc out;
  read_fields(reader, p, out);
  const bool has_two = p.has("alpha_u") && p.has("alpha_v");
  const Roughness r = roughness(reader, p, 0.1f);
  if (has_two)
    reader.warn(p.where_of("alpha_v"), "the anisotropy of " + p.title(), "\"alpha_u\" in both directions");
  out.distribution = r.distribution, out.alpha = r.alpha_u;
  out.as_mitsuba_3 = true;
  return out;
}

BsdfKind ward(Reader& reader, Plugin& p) {
  WardDesc out;
  const std::string variant = p.text("variant").value_or("balanced");
  if (variant == "ward")
    out.variant = WardDesc::Variant::ward;
  else if (variant == "ward-duer")
    out.variant = WardDesc::Variant::ward_duer;
  else if (variant != "balanced")
    throw InputError(p.where_of("variant"),
                     "the variant \"" + variant + "\" of " + p.title() + " is not known",
                     "ward, ward-duer and balanced are");
  read_fields(reader, p, out);
  const FloatInput alpha = p.scalar("alpha", 0.1f);
  out.alpha_u = p.has("alpha_u") ? p.scalar("alpha_u", 0.1f) : alpha;
  out.alpha_v = p.has("alpha_v") ? p.scalar("alpha_v", 0.1f) : alpha;
  for (const auto& [name, value] : {std::pair{"alpha_u", out.alpha_u}, std::pair{"alpha_v", out.alpha_v}})
    if (value.texture == kNone && !(value.value > 0))
      throw InputError(p.where_of(p.has(name) ? name : "alpha"),
                       std::string("\"") + name + "\" of " + p.title() + " is not positive",
                       "Ward's model has no mirror limit");
  return out;
}

}  // namespace lumirank::scenedesc::mitsuba
