// The materials of pbrt-v3. Its opaque ones add a diffuse and a specular BRDF, which together may reflect
// more than there is; here the specular one is a layer that leaves the rest to what is below it.
#include <algorithm>
#include <cmath>

#include "scenedesc/pbrt/material_maker.h"
#include "scenedesc/pbrt/version3.h"

namespace lumirank::scenedesc::pbrt {
namespace {

bool is_dark(const ColorInput& c) { return c.texture == kNone && is_black(c.value); }

// Half of all light, where a texture says.
float brightness(const ColorInput& c) { return c.texture == kNone ? luminance(c.value) : 0.5f; }

}  // namespace

int MaterialMaker::make_of_version3(const std::string& type) {
  p_.rename("bumpmap", "displacement");
  if (type == "matte") return matte();
  if (type == "plastic") return glossy(color("Kd", 0.25f), color("Ks", 0.25f), 1.5f, false);
  // Ashikhmin and Shirley's, whose specular color is that at normal incidence.
  if (type == "substrate") return glossy(color("Kd", 0.5f), color("Ks", 0.5f), 1.5f, true);
  if (type == "uber") return uber();
  if (type == "metal") return metal();
  if (type == "mirror") return mirror();
  if (type == "glass") return glass();
  if (type == "translucent") return translucent();
  if (type == "mix") return mix_of_version3();
  if (type == "disney") return disney();
  if (type == "hair") return hair();
  if (type.empty() || type == "none") return add(NullBsdfDesc{});
  if (type == "subsurface" || type == "kdsubsurface") {
    p_.rename("Kd", "reflectance");
    p_.rename("index", "eta");
    p_.ignore({"Kr", "Kt"});
    return subsurface();
  }
  if (type == "fourier") {
    reader_.warn(p_.where(), "the material \"fourier\"", "diffuse of 0.5");
    p_.ignore({"bsdffile"});
    return two_sided(DiffuseDesc{});
  }
  throw InputError(p_.where(), "the material " + in_quotes(type) + " of pbrt-v3 is not known",
                   "matte, plastic, substrate, uber, metal, mirror, glass, translucent, mix, disney, hair, "
                   "subsurface, kdsubsurface, fourier and none are");
}

FloatInput MaterialMaker::width(const char* name, FloatInput roughness) {
  if (roughness.texture != kNone) {
    if (!remap_) return roughness;
    // Near the polynomial, which no texture can be put through.
    const ColorInput input{Rgb(0), roughness.texture};
    return {0, reader_.add_texture("", p_.where_of(name), RootTextureDesc{input})};
  }
  if (!(roughness.value >= 0)) p_.fail(name, "is negative");
  return {remap_ ? std::min(alpha_of_version3(roughness.value), 1.0f) : roughness.value};
}

MaterialMaker::Widths MaterialMaker::widths(float fallback) {
  const FloatInput both = reader_.scalar(p_, "roughness", {fallback});
  const FloatInput u = reader_.scalar(p_, "uroughness", both), v = reader_.scalar(p_, "vroughness", both);
  const bool equal = u.value == v.value && u.texture == v.texture;
  Widths out;
  out.u = width(p_.has("uroughness") ? "uroughness" : "roughness", u);
  out.v = equal ? out.u : width(p_.has("vroughness") ? "vroughness" : "roughness", v);
  return out;
}

int MaterialMaker::matte() {
  const ColorInput reflectance = color("Kd", 0.5f);
  const FloatInput sigma = reader_.scalar(p_, "sigma", {0});  // Oren and Nayar's, in degrees
  if (sigma.texture != kNone) reader_.warn(p_.where_of("sigma"), "a textured roughness of matte", "none");
  if (sigma.texture != kNone || !(sigma.value > 0)) return two_sided(DiffuseDesc{reflectance});
  return two_sided(RoughDiffuseDesc{reflectance, {sigma.value * (kPi / 180) * std::sqrt(2.0f)}});
}

// `schlick`: the specular color is the reflectance at normal incidence, not a factor of Fresnel's.
int MaterialMaker::glossy(const ColorInput& diffuse, const ColorInput& specular, float eta, bool schlick) {
  const Widths alpha = widths(0.1f);
  // Between equal indices nothing is reflected.
  if (is_dark(specular) || (!schlick && std::abs(eta - 1) < 1e-3f)) return two_sided(DiffuseDesc{diffuse});
  PlasticDesc out;
  out.eta = eta;
  out.diffuse_reflectance = diffuse, out.specular_reflectance = specular;
  out.distribution = Distribution::ggx, out.alpha = alpha.u;
  out.lossless = true, out.schlick = schlick;
  if (alpha.v.texture != alpha.u.texture || alpha.v.value != alpha.u.value)
    reader_.warn_once(p_.where(), "the anisotropy of " + p_.title(), "\"uroughness\" in both directions");
  return two_sided(out);
}

ColorInput MaterialMaker::over(const ColorInput& color, float share) {
  if (color.texture == kNone) return {clamp_below(color.value / share, 1), kNone};
  return {Rgb(0), reader_.add_texture("", p_.where(), ScaleTextureDesc{color, Rgb(1 / share)})};
}

int MaterialMaker::uber() {
  const float eta = p_.positive(p_.has("index") ? "index" : "eta", 1.5f);
  const ColorInput diffuse = color("Kd", 0.25f), specular = color("Ks", 0.25f);
  const ColorInput mirrored = color("Kr", 0), refracted = color("Kt", 0);
  int made = kNone;
  if (!is_dark(refracted)) {
    // What goes through does not meet what is matt, so both share the surface, as they share the light.
    const float through = brightness(refracted), matt = brightness(diffuse);
    const float share = through / std::max(through + matt, 1e-6f);
    DielectricDesc glass;
    glass.eta = eta;
    glass.specular_reflectance = over(mirrored, share), glass.specular_transmittance = over(refracted, share);
    made = detailed(add(glass));
    if (share < 1)
      made = add(MixtureDesc{
          {{{share}, false, made},
           {{share}, true, glossy(over(diffuse, 1 - share), over(specular, 1 - share), eta, false)}}});
    else
      widths(0.1f);
  } else if (is_dark(mirrored)) {
    made = glossy(diffuse, specular, eta, false);
  } else {
    CoatingDesc coat;
    coat.nested = glossy(diffuse, specular, eta, false);
    coat.eta = eta, coat.specular_reflectance = mirrored, coat.straight = true;
    made = two_sided(coat);
  }
  // A color in pbrt-v3, as a rule a gray one.
  FloatInput opacity{1};
  if (const ColorInput given = color("opacity", 1); given.texture != kNone)
    opacity = {0, given.texture};
  else
    opacity = {luminance(given.value)};
  return opacity.texture == kNone && opacity.value >= 1 ? made : add(MaskDesc{opacity, made});
}

int MaterialMaker::metal() {
  ConductorDesc out;
  const Widths alpha = widths(0.01f);
  out.distribution = Distribution::ggx, out.alpha_u = alpha.u, out.alpha_v = alpha.v;
  const ConductorIndex index = conductor_index(p_, "eta", "k");
  out.eta = index.eta, out.k = index.k;
  return two_sided(out);
}

int MaterialMaker::mirror() {
  ConductorDesc out;
  out.eta = Rgb(0), out.k = Rgb(1);
  out.specular_reflectance = color("Kr", 0.9f);
  return two_sided(out);
}

int MaterialMaker::glass() {
  DielectricDesc out;
  out.eta = dielectric_eta(p_, p_.has("index") ? "index" : "eta", 1.5f);
  out.specular_reflectance = color("Kr", 1), out.specular_transmittance = color("Kt", 1);
  out.distribution = Distribution::ggx;
  const FloatInput u = reader_.scalar(p_, "uroughness", {0}), v = reader_.scalar(p_, "vroughness", {0});
  // Roughnesses of 0 are a smooth surface here, whatever they are made elsewhere.
  const auto smooth = [](const FloatInput& r) { return r.texture == kNone && r.value == 0; };
  if (!smooth(u) || !smooth(v)) out.alpha_u = width("uroughness", u), out.alpha_v = width("vroughness", v);
  return detailed(add(out));
}

int MaterialMaker::translucent() {
  const ColorInput diffuse = color("Kd", 0.25f);
  if (p_.has("Ks")) reader_.warn_once(p_.where_of("Ks"), "the gloss of translucent materials", "none");
  p_.ignore({"Ks", "roughness"});
  const auto part = [&](const char* name) -> ColorInput {
    const ColorInput share = color(name, 0.5f);
    if (diffuse.texture == kNone && share.texture == kNone) return {diffuse.value * share.value, kNone};
    if (share.texture == kNone)
      return {Rgb(0), reader_.add_texture("", p_.where(), ScaleTextureDesc{diffuse, share.value})};
    return {Rgb(0), reader_.add_texture("", p_.where(), ProductTextureDesc{diffuse, share})};
  };
  return detailed(add(DiffuseTransmitterDesc{part("reflect"), part("transmit")}));
}

// The amount is that of the first material, and a color.
int MaterialMaker::mix_of_version3() {
  const ColorInput given = color("amount", 0.5f);
  const FloatInput amount =
      given.texture == kNone ? FloatInput{luminance(given.value)} : FloatInput{0, given.texture};
  return mix({p_.required_text("namedmaterial2"), p_.required_text("namedmaterial1")}, amount);
}

int MaterialMaker::disney() {
  const auto scalar = [&](const char* name, float fallback) { return reader_.scalar(p_, name, {fallback}); };
  p_.ignore({"scatterdistance"});
  const ColorInput base = color("color", 0.5f);
  const float eta = p_.number("eta", 1.5f);
  const FloatInput roughness = scalar("roughness", 0.5f), anisotropic = scalar("anisotropic", 0);
  const FloatInput spec_tint = scalar("speculartint", 0), spec_trans = scalar("spectrans", 0);
  const FloatInput sheen = scalar("sheen", 0), sheen_tint = scalar("sheentint", 0.5f);
  const FloatInput flatness = scalar("flatness", 0), metallic = scalar("metallic", 0);
  const FloatInput clearcoat = scalar("clearcoat", 0), gloss = scalar("clearcoatgloss", 1);
  const FloatInput through = scalar("difftrans", 1);
  if (p_.flag("thin", false)) {
    PrincipledThinDesc out;
    out.base_color = base, out.eta = eta, out.roughness = roughness, out.anisotropic = anisotropic;
    out.spec_tint = spec_tint, out.spec_trans = spec_trans, out.sheen = sheen, out.sheen_tint = sheen_tint;
    out.flatness = flatness, out.diff_trans = through;
    return detailed(add(out));
  }
  PrincipledDesc out;
  out.base_color = base, out.eta = eta, out.roughness = roughness, out.anisotropic = anisotropic;
  out.spec_tint = spec_tint, out.spec_trans = spec_trans, out.sheen = sheen, out.sheen_tint = sheen_tint;
  out.flatness = flatness, out.metallic = metallic, out.clearcoat = clearcoat, out.clearcoat_gloss = gloss;
  const bool opaque = spec_trans.texture == kNone && spec_trans.value == 0;
  return opaque ? two_sided(out) : detailed(add(out));
}

}  // namespace lumirank::scenedesc::pbrt
