#include <algorithm>
#include <cmath>

#include "scenedesc/schema/hair.h"
#include "scenedesc/writer/writer.h"

namespace lumirank::scenedesc {
namespace {

bool is_smooth(const FloatInput& u, const FloatInput& v) {
  return u.texture == kNone && v.texture == kNone && u.value == 0 && v.value == 0;
}
bool same(const FloatInput& a, const FloatInput& b) { return a.value == b.value && a.texture == b.texture; }

}  // namespace

void MitsubaWriter::open_bsdf(const char* type, const std::string& id) {
  if (id.empty())
    xml_.open("bsdf", {{"type", type}});
  else
    xml_.open("bsdf", {{"type", type}, {"id", id}});
}

void MitsubaWriter::roughness(Distribution distribution, const FloatInput& u, const FloatInput& v) {
  if (is_smooth(u, v)) return;
  xml_.string("distribution", distribution == Distribution::ggx ? "ggx" : "beckmann");
  if (same(u, v)) return scalar("alpha", u);
  scalar("alpha_u", u), scalar("alpha_v", v);
}

// Whether light passes, so that Mitsuba's "twosided" refuses it.
bool MitsubaWriter::transmits(int index) const {
  if (index == kNone) return false;
  const auto& kind = scene_.bsdfs[static_cast<std::size_t>(index)].kind;
  if (std::holds_alternative<DielectricDesc>(kind) || std::holds_alternative<ThinDielectricDesc>(kind) ||
      std::holds_alternative<NullBsdfDesc>(kind) || std::holds_alternative<MaskDesc>(kind) ||
      std::holds_alternative<PrincipledThinDesc>(kind))
    return true;
  if (const auto* p = std::get_if<PrincipledDesc>(&kind))
    return p->spec_trans.texture != kNone || p->spec_trans.value > 0;
  if (const auto* bump = std::get_if<BumpMapDesc>(&kind)) return transmits(bump->nested);
  if (const auto* normal = std::get_if<NormalMapDesc>(&kind)) return transmits(normal->nested);
  if (const auto* coat = std::get_if<CoatingDesc>(&kind)) return transmits(coat->nested);
  if (const auto* sheen = std::get_if<SheenDesc>(&kind)) return transmits(sheen->nested);
  if (const auto* mix = std::get_if<MixtureDesc>(&kind))
    return std::any_of(mix->parts.begin(), mix->parts.end(),
                       [&](const auto& p) { return transmits(p.bsdf); });
  return false;
}

void MitsubaWriter::bsdf(int index) {
  const BsdfDesc& desc = scene_.bsdfs[static_cast<std::size_t>(index)];
  kind_of(desc, bsdf_ids_[static_cast<std::size_t>(index)]);
}

void MitsubaWriter::kind_of(const BsdfDesc& desc, const std::string& id) {
  const auto nested = [&](int k) { xml_.reference(bsdf_ids_[static_cast<std::size_t>(k)]); };
  const auto& kind = desc.kind;
  if (std::holds_alternative<NullBsdfDesc>(kind)) {
    open_bsdf("null", id);
  } else if (const auto* diffuse = std::get_if<DiffuseDesc>(&kind)) {
    open_bsdf("diffuse", id);
    color("reflectance", diffuse->reflectance);
  } else if (const auto* rough = std::get_if<RoughDiffuseDesc>(&kind)) {
    warn(desc.where, "rough diffuse surfaces (Oren-Nayar)", "diffuse");
    open_bsdf("diffuse", id);
    color("reflectance", rough->reflectance);
  } else if (const auto* metal = std::get_if<ConductorDesc>(&kind)) {
    open_bsdf(is_smooth(metal->alpha_u, metal->alpha_v) ? "conductor" : "roughconductor", id);
    if (metal->eta == Rgb(0) && metal->k == Rgb(1))
      xml_.string("material", "none");
    else
      xml_.color("eta", metal->eta), xml_.color("k", metal->k);
    color("specular_reflectance", metal->specular_reflectance);
    roughness(metal->distribution, metal->alpha_u, metal->alpha_v);
  } else if (const auto* glass = std::get_if<DielectricDesc>(&kind)) {
    open_bsdf(is_smooth(glass->alpha_u, glass->alpha_v) ? "dielectric" : "roughdielectric", id);
    xml_.number("int_ior", glass->eta), xml_.number("ext_ior", 1);
    color("specular_reflectance", glass->specular_reflectance);
    color("specular_transmittance", glass->specular_transmittance);
    roughness(glass->distribution, glass->alpha_u, glass->alpha_v);
  } else if (const auto* thin = std::get_if<ThinDielectricDesc>(&kind)) {
    open_bsdf("thindielectric", id);
    xml_.number("int_ior", thin->eta), xml_.number("ext_ior", 1);
    color("specular_reflectance", thin->specular_reflectance);
    color("specular_transmittance", thin->specular_transmittance);
  } else if (const auto* plastic = std::get_if<PlasticDesc>(&kind)) {
    const bool smooth = is_smooth(plastic->alpha, plastic->alpha);
    if (plastic->lossless && !smooth) return lossless_plastic(*plastic, desc, id);
    open_bsdf(smooth ? "plastic" : "roughplastic", id);
    xml_.number("int_ior", plastic->eta), xml_.number("ext_ior", 1);
    color("diffuse_reflectance", plastic->diffuse_reflectance);
    color("specular_reflectance", plastic->specular_reflectance);
    xml_.flag("nonlinear", plastic->nonlinear && !plastic->lossless);
    if (!smooth) {
      xml_.string("distribution", plastic->distribution == Distribution::ggx ? "ggx" : "beckmann");
      constant("alpha", plastic->alpha, desc.where, "a textured roughness of plastic");
    }
  } else if (const auto* phong = std::get_if<PhongDesc>(&kind)) {
    // A Beckmann lobe of about the width of cosⁿ about the mirror direction.
    warn(desc.where, "Phong's model", "a mixture of diffuse and rough conductor");
    const float n = phong->exponent.texture == kNone ? phong->exponent.value : 30;
    const FloatInput alpha{std::sqrt(2 / (n + 2)) * 2, kNone};
    return dull_and_glossy(id, phong->diffuse_reflectance, phong->specular_reflectance, alpha, alpha);
  } else if (const auto* ward = std::get_if<WardDesc>(&kind)) {
    warn(desc.where, "Ward's model", "a mixture of diffuse and rough conductor");
    return dull_and_glossy(id, ward->diffuse_reflectance, ward->specular_reflectance, ward->alpha_u,
                           ward->alpha_v);
  } else if (const auto* p = std::get_if<PrincipledDesc>(&kind)) {
    open_bsdf("principled", id);
    color("base_color", p->base_color);
    const std::pair<const char*, const FloatInput*> inputs[] = {
        {"roughness", &p->roughness},   {"anisotropic", &p->anisotropic},
        {"metallic", &p->metallic},     {"spec_trans", &p->spec_trans},
        {"spec_tint", &p->spec_tint},   {"sheen", &p->sheen},
        {"sheen_tint", &p->sheen_tint}, {"clearcoat", &p->clearcoat},
        {"flatness", &p->flatness},     {"clearcoat_gloss", &p->clearcoat_gloss}};
    // What is 0 is left out: Mitsuba leaves the lobe out.
    for (const auto& [name, input] : inputs)
      if (input->texture != kNone || input->value != 0 || input == &p->roughness) scalar(name, *input);
    xml_.number("eta", p->eta);
  } else if (const auto* sheet = std::get_if<PrincipledThinDesc>(&kind)) {
    open_bsdf("principledthin", id);
    color("base_color", sheet->base_color);
    const std::pair<const char*, const FloatInput*> inputs[] = {
        {"roughness", &sheet->roughness},   {"anisotropic", &sheet->anisotropic},
        {"spec_trans", &sheet->spec_trans}, {"spec_tint", &sheet->spec_tint},
        {"sheen", &sheet->sheen},           {"sheen_tint", &sheet->sheen_tint},
        {"flatness", &sheet->flatness},     {"diff_trans", &sheet->diff_trans}};
    for (const auto& [name, input] : inputs)
      if (input->texture != kNone || input->value != 0 || input == &sheet->roughness) scalar(name, *input);
    xml_.number("eta", sheet->eta);
  } else if (const auto* paper = std::get_if<DiffuseTransmitterDesc>(&kind)) {
    warn(desc.where, "diffuse transmission", "diffuse reflection alone");
    open_bsdf("diffuse", id);
    color("reflectance", paper->reflectance);
  } else if (const auto* hair = std::get_if<HairDesc>(&kind)) {
    if (hair->diffuse_reflectance.texture != kNone) {
      warn(desc.where, "Kajiya and Kay's hair, textured", "diffuse");
      open_bsdf("diffuse", id);
      color("reflectance", hair->diffuse_reflectance);
    } else {
      HairDesc plain = *hair;
      const bool painted = plain.specular_reflectance.texture != kNone || plain.exponent.texture != kNone;
      if (plain.specular_reflectance.texture != kNone)
        plain.specular_reflectance = HairDesc{}.specular_reflectance;
      if (plain.exponent.texture != kNone) plain.exponent = HairDesc{}.exponent;
      warn(desc.where, "Kajiya and Kay's hair",
           painted ? "Mitsuba's hair, of one gloss" : "Mitsuba's hair of the same brightness");
      const HairAbsorption fibre = hair_to_absorption(plain);
      open_bsdf("hair", id);
      xml_.color("sigma_a", fibre.sigma_a);
      xml_.number("int_ior", fibre.eta), xml_.number("ext_ior", 1);
      xml_.number("longitudinal_roughness", fibre.beta_m);
    }
  } else if (const auto* coat = std::get_if<CoatingDesc>(&kind)) {
    return coating(*coat, desc, id);
  } else if (const auto* sheen = std::get_if<SheenDesc>(&kind)) {
    warn(desc.where, "sheen of cloth", "the BSDF below it alone");
    return kind_of(scene_.bsdfs[static_cast<std::size_t>(sheen->nested)], id);
  } else if (const auto* mask = std::get_if<MaskDesc>(&kind)) {
    open_bsdf("mask", id);
    scalar("opacity", mask->opacity);
    nested(mask->nested);
  } else if (const auto* both = std::get_if<TwoSidedDesc>(&kind)) {
    if (transmits(both->front) || transmits(both->back)) {
      warn(desc.where, "\"twosided\" around a BSDF that lets light pass", "that BSDF alone");
      const BsdfDesc& inner = scene_.bsdfs[static_cast<std::size_t>(both->front)];
      return kind_of(inner, id);
    }
    open_bsdf("twosided", id);
    nested(both->front);
    if (both->back != both->front) nested(both->back);
  } else if (const auto* bump = std::get_if<BumpMapDesc>(&kind)) {
    const Input height = resolve(bump->texture);
    if (height.texture == kNone) return kind_of(scene_.bsdfs[static_cast<std::size_t>(bump->nested)], id);
    open_bsdf("bumpmap", id);
    reference(height.texture, "arbitrary");
    xml_.number("scale", bump->scale);
    nested(bump->nested);
  } else if (const auto* normal = std::get_if<NormalMapDesc>(&kind)) {
    const Input map = resolve(normal->texture);
    if (map.texture == kNone) return kind_of(scene_.bsdfs[static_cast<std::size_t>(normal->nested)], id);
    if (normal->scale != 1) warn(desc.where, "a scale of normal maps", "1");
    if (normal->follow_uv) warn(desc.where, "normal maps that follow mirrored uvs", "those of Mitsuba");
    open_bsdf("normalmap", id);
    reference(map.texture, "normalmap");
    nested(normal->nested);
  } else if (const auto* mix = std::get_if<MixtureDesc>(&kind)) {
    return mixture(*mix, desc, id);
  }
  xml_.close();
}

// Rough plastic that loses nothing. Mitsuba's keeps what single scattering in its interface lets through: a
// matt white one 0.33 of the light, where principled sends back 1.05. A smooth one is Mitsuba's linear
// plastic.
void MitsubaWriter::lossless_plastic(const PlasticDesc& d, const BsdfDesc& desc, const std::string& id) {
  warn(desc.where, "rough plastic that loses nothing", "principled");
  if (d.specular_reflectance.texture != kNone || !(d.specular_reflectance.value == Rgb(1)))
    warn(desc.where, "a colour of the reflection of plastic", "white");
  open_bsdf("principled", id);
  color("base_color", d.diffuse_reflectance);
  // Its roughness is the square root of alpha.
  FloatInput roughness{std::sqrt(d.alpha.value), kNone};
  if (d.alpha.texture != kNone) {
    const auto* product =
        std::get_if<ProductTextureDesc>(&scene_.textures[static_cast<std::size_t>(d.alpha.texture)].kind);
    const bool square = product && product->a.texture != kNone && product->a.texture == product->b.texture;
    if (!square) warn(desc.where, "the square root of a texture", "the texture itself");
    roughness.texture = square ? product->a.texture : d.alpha.texture;
  }
  scalar("roughness", roughness);
  xml_.number("eta", d.eta);
  xml_.close();
}

// Weights by the brightest of constants; the parts are divided by them, so that the sum keeps its energy.
void MitsubaWriter::dull_and_glossy(const std::string& id, const ColorInput& dull, const ColorInput& glossy,
                                    const FloatInput& alpha_u, const FloatInput& alpha_v) {
  const Input d = resolve(dull), s = resolve(glossy);
  const float kd = d.texture == kNone ? max_component(d.value) : 0.5f,
              ks = s.texture == kNone ? max_component(s.value) : 0.5f;
  const float weight = kd + ks > 0 ? ks / (kd + ks) : 0;
  const auto part = [&](const char* name, const ColorInput& input, const Input& in, float share) {
    if (in.texture == kNone && share > 0)
      xml_.color(name, clamp_below(in.value / share, 1));
    else
      color(name, input);
  };
  open_bsdf("blendbsdf", id);
  xml_.number("weight", weight);
  open_bsdf("diffuse", "");
  part("reflectance", dull, d, 1 - weight);
  xml_.close();
  open_bsdf("roughconductor", "");
  xml_.string("material", "none");
  part("specular_reflectance", glossy, s, weight);
  roughness(Distribution::beckmann, alpha_u, alpha_v);
  xml_.close();
  xml_.close();
}

void MitsubaWriter::coating(const CoatingDesc& d, const BsdfDesc& desc, const std::string& id) {
  const BsdfDesc& inner = scene_.bsdfs[static_cast<std::size_t>(d.nested)];
  const auto* diffuse = std::get_if<DiffuseDesc>(&inner.kind);
  if (!diffuse || d.weight.texture != kNone || d.weight.value != 1) {
    warn(desc.where, "a coating over another BSDF", "that BSDF alone");
    return kind_of(inner, id);
  }
  warn(desc.where, "a coating over a diffuse BSDF", "plastic");
  const bool smooth = is_smooth(d.alpha_u, d.alpha_v);
  open_bsdf(smooth ? "plastic" : "roughplastic", id);
  xml_.number("int_ior", d.eta), xml_.number("ext_ior", 1);
  color("diffuse_reflectance", diffuse->reflectance);
  color("specular_reflectance", d.specular_reflectance);
  xml_.flag("nonlinear", true);
  if (!smooth) {
    xml_.string("distribution", d.distribution == Distribution::ggx ? "ggx" : "beckmann");
    constant("alpha", d.alpha_u, desc.where, "a textured roughness of plastic");
  }
  xml_.close();
}

void MitsubaWriter::mixture(const MixtureDesc& d, const BsdfDesc& desc, const std::string& id) {
  const auto nested = [&](int k) { xml_.reference(bsdf_ids_[static_cast<std::size_t>(k)]); };
  // A pair of complementary weights, either way round: the first has the complement.
  if (d.parts.size() == 2 && d.parts[0].complement != d.parts[1].complement &&
      same(d.parts[0].weight, d.parts[1].weight)) {
    const std::size_t rest = d.parts[0].complement ? 0 : 1;
    open_bsdf("blendbsdf", id);
    scalar("weight", d.parts[0].weight);
    nested(d.parts[rest].bsdf), nested(d.parts[1 - rest].bsdf);
    return xml_.close();
  }
  double sum = 0;
  for (const auto& part : d.parts) {
    if (part.weight.texture != kNone) warn(desc.where, "a mixture with textured weights", "0.5 for each");
    sum += part.weight.texture != kNone ? 0.5 : part.complement ? 1 - part.weight.value : part.weight.value;
  }
  // The rest up to 1 is black.
  blend_rest(d, 0, std::max(1.0, sum), id);
}

// Parts from `from` on, and black, whose weights add up to `sum`: nested pairs.
void MitsubaWriter::blend_rest(const MixtureDesc& d, std::size_t from, double sum, const std::string& id) {
  if (from == d.parts.size()) {
    open_bsdf("diffuse", id);
    xml_.color("reflectance", Rgb(0));
    return xml_.close();
  }
  const auto& part = d.parts[from];
  const double own = part.weight.texture != kNone ? 0.5
                     : part.complement            ? 1 - part.weight.value
                                                  : part.weight.value;
  open_bsdf("blendbsdf", id);
  const double share = sum > 0 ? std::min(1.0, own / sum) : 0;
  xml_.number("weight", static_cast<float>(1 - share));
  xml_.reference(bsdf_ids_[static_cast<std::size_t>(part.bsdf)]);
  blend_rest(d, from + 1, sum - own, "");
  xml_.close();
}

}  // namespace lumirank::scenedesc
