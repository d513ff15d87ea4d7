#include <algorithm>
#include <cmath>
#include <optional>
#include <type_traits>

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
  const BsdfKind& kind = scene_.bsdfs[static_cast<std::size_t>(index)].kind;
  if (std::visit([](const auto& desc) { return desc.kInfo.transmits; }, kind)) return true;
  if (const auto* p = std::get_if<PrincipledDesc>(&kind))
    return p->spec_trans.texture != kNone || p->spec_trans.value > 0;
  if (std::holds_alternative<TwoSidedDesc>(kind)) return false;
  bool any = false;
  for_each_nested(kind, [&](int nested) { any = any || transmits(nested); });
  return any;
}

void MitsubaWriter::bsdf(int index) {
  const BsdfDesc& desc = scene_.bsdfs[static_cast<std::size_t>(index)];
  kind_of(desc, bsdf_ids_[static_cast<std::size_t>(index)]);
}

void MitsubaWriter::kind_of(const BsdfDesc& desc, const std::string& id) {
  std::visit([&](const auto& d) { write(d, desc, id); }, desc.kind);
}

void MitsubaWriter::nested(int index) { xml_.reference(bsdf_ids_[static_cast<std::size_t>(index)]); }

// What is 0 where that is Mitsuba's default too is left out: Mitsuba leaves the lobe out.
template <typename Desc>
void MitsubaWriter::fields(const Desc& d) {
  const Desc plain{};
  for_each_field(d, [&](const auto& field, const auto& value) {
    using Value = std::decay_t<decltype(value)>;
    if constexpr (std::is_same_v<Value, ColorInput>) {
      if (field.role == Role::reflectance) color(field.name, value);
    } else if constexpr (std::is_same_v<Value, FloatInput>) {
      const bool left_out = value.texture == kNone && value.value == 0 && (plain.*field.member).value == 0;
      if (field.role == Role::number && !left_out) scalar(field.name, value);
    } else if constexpr (std::is_same_v<Value, float>) {
      if (field.role == Role::index) xml_.number("int_ior", value), xml_.number("ext_ior", 1);
    } else if constexpr (std::is_same_v<Value, bool>) {
      if (field.role == Role::flag) xml_.flag(field.name, value);
    } else if constexpr (std::is_same_v<Value, int>) {
      if (field.role == Role::nested) nested(value);
    }
  });
  if constexpr (requires {
                  d.alpha_u;
                  d.distribution;
                })
    roughness(d.distribution, d.alpha_u, d.alpha_v);
}

// The first color among the fields, for a diffuse BSDF in place of one that Mitsuba 3 does not have.
template <typename Desc>
ColorInput MitsubaWriter::matt_color(const Desc& d) {
  std::optional<ColorInput> found;
  for_each_field(d, [&](const auto&, const auto& value) {
    if constexpr (std::is_same_v<std::decay_t<decltype(value)>, ColorInput>)
      if (!found) found = value;
  });
  return found.value_or(ColorInput{Rgb(0.5f)});
}

template <typename Desc>
void MitsubaWriter::write(const Desc& d, const BsdfDesc& desc, const std::string& id) {
  if constexpr (Desc::kInfo.lacking != nullptr) {
    warn(desc.where, Desc::kInfo.lacking, Desc::kInfo.stand_in);
    open_bsdf("diffuse", id);
    color("reflectance", matt_color(d));
  } else {
    std::string name = Desc::kInfo.name;
    if constexpr (requires {
                    d.alpha_u;
                    d.distribution;
                  })
      if (!is_smooth(d.alpha_u, d.alpha_v)) name = "rough" + name;
    if constexpr (std::is_same_v<Desc, PrincipledDesc>) warn_of_stretch(d.stretch, desc.where);
    if constexpr (std::is_same_v<Desc, PrincipledDesc>)
      if (d.lossless)
        warn(desc.where, "metal that gives back what its facets mask",
             "metal that loses it, darker if it is rough");
    open_bsdf(name.c_str(), id);
    fields(d);
    if constexpr (std::is_same_v<Desc, PrincipledDesc> || std::is_same_v<Desc, PrincipledThinDesc>)
      xml_.number("eta", d.eta);
    if constexpr (std::is_same_v<Desc, ConductorDesc>) {
      if (d.eta == Rgb(0) && d.k == Rgb(1))
        xml_.string("material", "none");
      else
        xml_.color("eta", d.eta), xml_.color("k", d.k);
    }
  }
  xml_.close();
}

void MitsubaWriter::warn_of_stretch(const FloatInput& stretch, const SourceLocation& where) {
  if (stretch.texture != kNone || stretch.value > 0)
    warn(where, "anisotropy as glTF has it", "a reflection alike in all directions");
}

void MitsubaWriter::write(const PlasticDesc& d, const BsdfDesc& desc, const std::string& id) {
  warn_of_stretch(d.stretch, desc.where);
  const bool smooth = is_smooth(d.alpha, d.alpha);
  if (d.lossless && !smooth) return lossless_plastic(d, desc, id);
  PlasticDesc written = d;
  written.nonlinear = d.nonlinear && !d.lossless;
  open_bsdf(smooth ? "plastic" : "roughplastic", id);
  fields(written);
  if (!smooth) {
    xml_.string("distribution", d.distribution == Distribution::ggx ? "ggx" : "beckmann");
    constant("alpha", d.alpha, desc.where, "a textured roughness of plastic");
  }
  xml_.close();
}

void MitsubaWriter::write(const PhongDesc& d, const BsdfDesc& desc, const std::string& id) {
  // A Beckmann lobe of about the width of cosⁿ about the mirror direction.
  warn(desc.where, "Phong's model", "a mixture of diffuse and rough conductor");
  const float n = d.exponent.texture == kNone ? d.exponent.value : 30;
  const FloatInput alpha{std::sqrt(2 / (n + 2)) * 2, kNone};
  dull_and_glossy(id, d.diffuse_reflectance, d.specular_reflectance, alpha, alpha);
}

void MitsubaWriter::write(const WardDesc& d, const BsdfDesc& desc, const std::string& id) {
  warn(desc.where, "Ward's model", "a mixture of diffuse and rough conductor");
  dull_and_glossy(id, d.diffuse_reflectance, d.specular_reflectance, d.alpha_u, d.alpha_v);
}

void MitsubaWriter::write(const HairDesc& d, const BsdfDesc& desc, const std::string& id) {
  if (d.diffuse_reflectance.texture != kNone) {
    warn(desc.where, "Kajiya and Kay's hair, textured", "diffuse");
    open_bsdf("diffuse", id);
    color("reflectance", d.diffuse_reflectance);
    return xml_.close();
  }
  HairDesc plain = d;
  const bool painted = plain.specular_reflectance.texture != kNone || plain.exponent.texture != kNone;
  if (plain.specular_reflectance.texture != kNone)
    plain.specular_reflectance = HairDesc{}.specular_reflectance;
  if (plain.exponent.texture != kNone) plain.exponent = HairDesc{}.exponent;
  warn(desc.where, "Kajiya and Kay's hair",
       painted ? "Mitsuba's hair, of one gloss" : "Mitsuba's hair of the same brightness");
  const HairAbsorption fiber = hair_to_absorption(plain);
  open_bsdf("hair", id);
  xml_.color("sigma_a", fiber.sigma_a);
  xml_.number("int_ior", fiber.eta), xml_.number("ext_ior", 1);
  xml_.number("longitudinal_roughness", fiber.beta_m);
  xml_.close();
}

void MitsubaWriter::write(const HairFiberDesc& d, const BsdfDesc&, const std::string& id) {
  open_bsdf("hair", id);
  xml_.color("sigma_a", d.sigma_a);
  xml_.number("int_ior", d.eta), xml_.number("ext_ior", 1);
  xml_.number("longitudinal_roughness", d.beta_m), xml_.number("azimuthal_roughness", d.beta_n);
  xml_.number("scale_tilt", d.tilt);
  xml_.close();
}

void MitsubaWriter::write(const SheenDesc& d, const BsdfDesc& desc, const std::string& id) {
  warn(desc.where, "sheen of cloth", "the BSDF below it alone");
  kind_of(scene_.bsdfs[static_cast<std::size_t>(d.nested)], id);
}

void MitsubaWriter::write(const TwoSidedDesc& d, const BsdfDesc& desc, const std::string& id) {
  if (transmits(d.front) || transmits(d.back)) {
    warn(desc.where, "\"twosided\" around a BSDF that lets light pass", "that BSDF alone");
    return kind_of(scene_.bsdfs[static_cast<std::size_t>(d.front)], id);
  }
  open_bsdf("twosided", id);
  nested(d.front);
  if (d.back != d.front) nested(d.back);
  xml_.close();
}

void MitsubaWriter::write(const BumpMapDesc& d, const BsdfDesc&, const std::string& id) {
  const Input height = resolve(d.texture);
  if (height.texture == kNone) return kind_of(scene_.bsdfs[static_cast<std::size_t>(d.nested)], id);
  open_bsdf("bumpmap", id);
  reference(height.texture, "arbitrary");
  xml_.number("scale", d.scale);
  fields(d);
  xml_.close();
}

void MitsubaWriter::write(const NormalMapDesc& d, const BsdfDesc& desc, const std::string& id) {
  const Input map = resolve(d.texture);
  if (map.texture == kNone) return kind_of(scene_.bsdfs[static_cast<std::size_t>(d.nested)], id);
  if (d.scale != 1) warn(desc.where, "a scale of normal maps", "1");
  if (d.follow_uv) warn(desc.where, "normal maps that follow mirrored uvs", "those of Mitsuba");
  open_bsdf("normalmap", id);
  reference(map.texture, "normalmap");
  fields(d);
  xml_.close();
}

// Without stretched lobes, of which a warning tells, a turn changes nothing.
void MitsubaWriter::write(const TurnedTangentDesc& d, const BsdfDesc&, const std::string& id) {
  kind_of(scene_.bsdfs[static_cast<std::size_t>(d.nested)], id);
}

// Rough plastic that loses nothing. Mitsuba's keeps what single scattering in its interface lets through: a
// matt white one 0.33 of the light, where principled sends back 1.05. A smooth one is Mitsuba's linear
// plastic.
void MitsubaWriter::lossless_plastic(const PlasticDesc& d, const BsdfDesc& desc, const std::string& id) {
  warn(desc.where, "rough plastic that loses nothing", "principled");
  if (d.specular_reflectance.texture != kNone || !(d.specular_reflectance.value == Rgb(1)))
    warn(desc.where, "a color of the reflection of plastic", "white");
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

void MitsubaWriter::write(const CoatingDesc& d, const BsdfDesc& desc, const std::string& id) {
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

void MitsubaWriter::write(const MixtureDesc& d, const BsdfDesc& desc, const std::string& id) {
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
