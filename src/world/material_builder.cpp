#include "world/material_builder.h"

#include <algorithm>
#include <cmath>
#include <type_traits>

#include "base/error.h"
#include "scenedesc/schema/files.h"

namespace lumirank::world {

namespace sd = scenedesc;
namespace sc = scatter;

namespace {

constexpr int kNotBuilt = -1, kInProgress = -2;

sc::NormalDistribution convert(sd::Distribution d) {
  return d == sd::Distribution::ggx ? sc::NormalDistribution::ggx : sc::NormalDistribution::beckmann;
}

bool is_zero(const sd::FloatInput& f) { return f.texture == sd::kNone && f.value == 0; }

// Fresnel's formulas have sixth powers of them.
constexpr float kMaxIndex = 1e6f;

float checked_eta(float eta, const SourceLocation& where) {
  if (!(eta > 0) || !std::isfinite(eta))
    throw InputError(where, "a relative index of refraction is not a positive number",
                     "give positive interior and exterior indices");
  if (eta > kMaxIndex || eta < 1 / kMaxIndex)
    throw InputError(where, "a relative index of refraction is beyond what 32-bit arithmetic can carry",
                     "give one from 1e-6 to 1e6");
  return eta;
}

void check_index(Rgb value, const SourceLocation& where) {
  if (!is_finite(value) || value.r < 0 || value.g < 0 || value.b < 0)
    throw InputError(where, "a conductor's index of refraction is negative or not finite",
                     "give numbers ≥ 0");
  if (max_component(value) > kMaxIndex)
    throw InputError(where, "a conductor's index of refraction is beyond what 32-bit arithmetic can carry",
                     "give numbers up to 1e6");
}

}  // namespace

MaterialBuilder::MaterialBuilder(const sd::SceneDesc& desc, TextureBuilder& textures, Notes& notes)
    : desc_(desc),
      textures_(textures),
      notes_(notes),
      index_(desc.bsdfs.size(), kNotBuilt),
      index_on_fibers_(index_) {}

int MaterialBuilder::add(sc::Material material) {
  traits_.push_back(traits_of(material));
  materials_.push_back(std::move(material));
  return static_cast<int>(materials_.size()) - 1;
}

int MaterialBuilder::use(int bsdf, const SourceLocation& user, Carrier carrier) {
  if (bsdf == sd::kNone) {
    if (default_ < 0) default_ = add(sc::DiffuseMaterial{sc::ColorInput{Rgb(0.5f), -1}});
    return default_;
  }
  if (bsdf < 0 || static_cast<std::size_t>(bsdf) >= desc_.bsdfs.size())
    throw InputError(user, "a BSDF is referred to that the scene does not have", "define it");
  const auto slot = static_cast<std::size_t>(bsdf);
  const auto& b = desc_.bsdfs[slot];
  if (carrier == Carrier::fibers && !holds_hair(bsdf)) carrier = Carrier::surface;
  std::vector<int>& index = carrier == Carrier::fibers ? index_on_fibers_ : index_;
  if (index[slot] >= 0) return index[slot];
  if (index[slot] == kInProgress)
    throw InputError(b.where, "the BSDF '" + b.id + "' is, through others, nested in itself",
                     "break the cycle");
  index[slot] = kInProgress;
  int built = -1;
  if (carrier == Carrier::fibers) {
    if (const int other = instead_around_hair(b); other != sd::kNone) built = use(other, b.where, carrier);
  } else if (const auto* two = std::get_if<sd::TwoSidedDesc>(&b.kind)) {
    built = instead_of_two_sided(*two, b.where);
  }
  if (built < 0) {
    sc::Material material = convert(b, carrier);
    built = add(std::move(material));
  }
  return index[slot] = built;
}

bool MaterialBuilder::holds_hair(int bsdf, std::size_t depth) const {
  // A loop of nested BSDFs is found, with its message, when they are built.
  if (bsdf < 0 || static_cast<std::size_t>(bsdf) >= desc_.bsdfs.size() || depth > desc_.bsdfs.size())
    return false;
  const auto& kind = desc_.bsdfs[static_cast<std::size_t>(bsdf)].kind;
  if (std::holds_alternative<sd::HairDesc>(kind)) return true;
  // Of two sides the front alone lies on fibers.
  if (const auto* m = std::get_if<sd::TwoSidedDesc>(&kind)) return holds_hair(m->front, depth + 1);
  bool found = false;
  sd::for_each_nested(kind, [&](int nested) { found = found || holds_hair(nested, depth + 1); });
  return found;
}

int MaterialBuilder::instead_around_hair(const sd::BsdfDesc& b) {
  if (const auto* m = std::get_if<sd::TwoSidedDesc>(&b.kind)) return m->front;
  const auto* bump = std::get_if<sd::BumpMapDesc>(&b.kind);
  const auto* map = std::get_if<sd::NormalMapDesc>(&b.kind);
  if (const auto* coat = std::get_if<sd::CoatingDesc>(&b.kind)) {
    notes_.warn(b.where, "a coating over hair", "the hair without it");
    return coat->nested;
  }
  if (const auto* sheen = std::get_if<sd::SheenDesc>(&b.kind)) {
    notes_.warn(b.where, "sheen over hair", "the hair without it");
    return sheen->nested;
  }
  if (bump || map) {
    notes_.warn(b.where, "a bump or normal map around hair", "the hair without it");
    return bump ? bump->nested : map->nested;
  }
  if (const auto* m = std::get_if<sd::MixtureDesc>(&b.kind)) {
    int hair = sd::kNone;
    bool mixed = false;
    for (const auto& part : m->parts) {
      const bool holds = holds_hair(part.bsdf);
      if (holds && hair == sd::kNone) hair = part.bsdf;
      mixed |= !holds;
    }
    if (!mixed) return sd::kNone;
    notes_.warn(b.where, "a mixture of hair with a BSDF of surfaces", "the hair alone");
    return hair;
  }
  return sd::kNone;
}

MaterialBuilder::Traits MaterialBuilder::traits_of(const sc::Material& material) const {
  const auto join = [](Traits a, Traits b) {
    return Traits{a.transmits || b.transmits, a.coated || b.coated, a.sheen || b.sheen};
  };
  return std::visit(
      [&](const auto& m) {
        using Kind = std::decay_t<decltype(m)>;
        Traits out;
        if constexpr (std::is_same_v<Kind, sc::TwoSidedMaterial>) {
          out = join(of(m.front), of(m.back));
          out.transmits = false;
        } else if constexpr (std::is_same_v<Kind, sc::MixtureMaterial>) {
          for (const auto& part : m.parts) out = join(out, of(part.nested));
        } else if constexpr (requires { m.nested; }) {
          out = of(m.nested);
          out.transmits |= std::is_same_v<Kind, sc::MaskMaterial>;
          out.coated |= std::is_same_v<Kind, sc::CoatingMaterial>;
          out.sheen |= std::is_same_v<Kind, sc::SheenMaterial>;
        } else if constexpr (std::is_same_v<Kind, sc::PrincipledMaterial>) {
          out.transmits = m.spec_trans.texture >= 0 || m.spec_trans.value > 0;
        } else {
          out.transmits = std::is_same_v<Kind, sc::NullMaterial> ||
                          std::is_same_v<Kind, sc::DielectricMaterial> ||
                          std::is_same_v<Kind, sc::ThinDielectricMaterial> ||
                          std::is_same_v<Kind, sc::PrincipledThinMaterial> ||
                          std::is_same_v<Kind, sc::DiffuseTransmitterMaterial>;
        }
        return out;
      },
      material);
}

int MaterialBuilder::instead_of_two_sided(const sd::TwoSidedDesc& d, const SourceLocation& where) {
  const int front = use(d.front, where);
  const int back = d.back == d.front ? front : use(d.back, where);
  if (!transmits(front) && !transmits(back)) return -1;
  notes_.warn(where, "a twosided BSDF around one that transmits light",
              front == back ? "the nested BSDF without twosided" : "the first nested BSDF without twosided");
  return front;
}

sc::Material MaterialBuilder::convert(const sd::BsdfDesc& b, Carrier on) {
  struct Convert {
    MaterialBuilder& self;
    const SourceLocation& where;
    Carrier carrier;

    sc::ColorInput color(const sd::ColorInput& c) const { return self.textures_.color(c, where); }
    sc::FloatInput number(const sd::FloatInput& f) const { return self.textures_.number(f, where); }
    int nested(int bsdf) const {
      if (bsdf == sd::kNone) throw InputError(where, "a BSDF lacks the one nested in it", "nest a BSDF");
      return self.use(bsdf, where, carrier);
    }
    int texture(int t) const {
      if (t == sd::kNone) throw InputError(where, "a BSDF lacks its texture", "nest a texture");
      return self.textures_.use(t, where);
    }

    sc::Material operator()(const sd::NullBsdfDesc&) const { return sc::NullMaterial{}; }
    sc::Material operator()(const sd::DiffuseDesc& d) const {
      return sc::DiffuseMaterial{color(d.reflectance)};
    }
    sc::Material operator()(const sd::RoughDiffuseDesc& d) const {
      return sc::RoughDiffuseMaterial{color(d.reflectance), number(d.alpha)};
    }
    sc::Material operator()(const sd::ConductorDesc& d) const {
      check_index(d.eta, where);
      check_index(d.k, where);
      sc::ConductorMaterial m;
      m.eta = d.eta, m.k = d.k;
      m.specular_reflectance = color(d.specular_reflectance);
      m.distribution = world::convert(d.distribution);
      m.alpha_u = number(d.alpha_u), m.alpha_v = number(d.alpha_v);
      m.smooth = is_zero(d.alpha_u) && is_zero(d.alpha_v);
      return m;
    }
    sc::Material operator()(const sd::DielectricDesc& d) const {
      sc::DielectricMaterial m;
      m.eta = checked_eta(d.eta, where);
      m.specular_reflectance = color(d.specular_reflectance);
      m.specular_transmittance = color(d.specular_transmittance);
      m.distribution = world::convert(d.distribution);
      m.alpha_u = number(d.alpha_u), m.alpha_v = number(d.alpha_v);
      m.smooth = is_zero(d.alpha_u) && is_zero(d.alpha_v);
      return m;
    }
    sc::Material operator()(const sd::ThinDielectricDesc& d) const {
      return sc::ThinDielectricMaterial{checked_eta(d.eta, where), color(d.specular_reflectance),
                                        color(d.specular_transmittance)};
    }
    sc::Material operator()(const sd::PlasticDesc& d) const {
      sc::PlasticMaterial m;
      m.eta = checked_eta(d.eta, where);
      m.diffuse_reflectance = color(d.diffuse_reflectance);
      m.specular_reflectance = color(d.specular_reflectance);
      m.nonlinear = d.nonlinear;
      m.lossless = d.lossless;
      m.distribution = world::convert(d.distribution);
      m.alpha = number(d.alpha);
      m.smooth = is_zero(d.alpha);
      return m;
    }
    sc::Material operator()(const sd::PhongDesc& d) const {
      return sc::PhongMaterial{color(d.diffuse_reflectance), color(d.specular_reflectance),
                               number(d.exponent)};
    }
    sc::Material operator()(const sd::WardDesc& d) const {
      return sc::WardMaterial{static_cast<int>(d.variant), color(d.diffuse_reflectance),
                              color(d.specular_reflectance), number(d.alpha_u), number(d.alpha_v)};
    }
    sc::Material operator()(const sd::PrincipledDesc& d) const {
      sc::PrincipledMaterial m;
      m.base_color = color(d.base_color);
      m.roughness = number(d.roughness), m.anisotropic = number(d.anisotropic);
      m.metallic = number(d.metallic), m.spec_trans = number(d.spec_trans);
      m.spec_tint = number(d.spec_tint), m.sheen = number(d.sheen), m.sheen_tint = number(d.sheen_tint);
      m.clearcoat = number(d.clearcoat), m.clearcoat_gloss = number(d.clearcoat_gloss);
      m.flatness = number(d.flatness);
      m.eta = checked_eta(d.eta, where);
      return m;
    }
    sc::Material operator()(const sd::HairDesc& d) const {
      if (carrier == Carrier::fibers)
        return sc::HairMaterial{color(d.diffuse_reflectance), color(d.specular_reflectance),
                                number(d.exponent)};
      self.notes_.warn(where, "a hair BSDF on a surface", "diffuse of its diffuse reflectance");
      return sc::DiffuseMaterial{color(d.diffuse_reflectance)};
    }
    sc::Material operator()(const sd::PrincipledThinDesc& d) const {
      sc::PrincipledThinMaterial m;
      m.base_color = color(d.base_color);
      m.roughness = number(d.roughness), m.anisotropic = number(d.anisotropic);
      m.spec_trans = number(d.spec_trans), m.spec_tint = number(d.spec_tint);
      m.sheen = number(d.sheen), m.sheen_tint = number(d.sheen_tint);
      m.flatness = number(d.flatness), m.diff_trans = number(d.diff_trans);
      m.eta = checked_eta(d.eta, where);
      return m;
    }
    sc::Material operator()(const sd::DiffuseTransmitterDesc& d) const {
      return sc::DiffuseTransmitterMaterial{color(d.reflectance), color(d.transmittance)};
    }
    sc::Material operator()(const sd::MeasuredDesc& d) const {
      if (d.file.missing) return sc::DiffuseMaterial{sc::ColorInput{Rgb(0.5f), -1}};
      return sc::MeasuredMaterial{sc::parse_merl(sd::read_file(d.file.name, where), d.file.name, where)};
    }
    sc::Material operator()(const sd::CoatingDesc& d) const {
      sc::CoatingMaterial m;
      m.nested = nested(d.nested);
      if (self.of(m.nested).coated) {
        self.notes_.warn(where, "a coating over a BSDF that has a coating", "the inner one alone");
        return self.materials_[static_cast<std::size_t>(m.nested)];
      }
      m.eta = checked_eta(d.eta, where);
      m.specular_reflectance = color(d.specular_reflectance);
      m.absorption = color(d.absorption);
      m.weight = number(d.weight);
      m.distribution = world::convert(d.distribution);
      m.alpha_u = number(d.alpha_u), m.alpha_v = number(d.alpha_v);
      m.smooth = is_zero(d.alpha_u) && is_zero(d.alpha_v);
      return m;
    }
    sc::Material operator()(const sd::SheenDesc& d) const {
      sc::SheenMaterial m;
      m.nested = nested(d.nested);
      const char* below = self.transmits(m.nested)   ? "that lets light pass"
                          : self.of(m.nested).coated ? "that has a coating"
                          : self.of(m.nested).sheen  ? "that has sheen"
                                                     : nullptr;
      if (below) {
        self.notes_.warn(where, std::string("sheen over a BSDF ") + below, "that BSDF alone");
        return self.materials_[static_cast<std::size_t>(m.nested)];
      }
      m.color = color(d.color), m.roughness = number(d.roughness);
      return m;
    }
    sc::Material operator()(const sd::MaskDesc& d) const {
      const sc::FloatInput opacity = self.textures_.number(d.opacity, where, 1);
      return sc::MaskMaterial{opacity, nested(d.nested)};
    }
    sc::Material operator()(const sd::TwoSidedDesc& d) const {
      const int front = nested(d.front);
      return sc::TwoSidedMaterial{front, nested(d.back)};
    }
    sc::Material operator()(const sd::BumpMapDesc& d) const {
      if (!std::isfinite(d.scale))
        throw InputError(where, "the bump map's scale is not finite", "give a number");
      const int map = texture(d.texture), below = nested(d.nested);
      if (self.textures_.is_missing(d.texture)) return self.materials_[static_cast<std::size_t>(below)];
      return sc::BumpMaterial{map, d.scale, below};
    }
    sc::Material operator()(const sd::NormalMapDesc& d) const {
      if (!std::isfinite(d.scale))
        throw InputError(where, "the normal map's scale is not finite", "give a number");
      const int map = texture(d.texture), below = nested(d.nested);
      if (self.textures_.is_missing(d.texture)) return self.materials_[static_cast<std::size_t>(below)];
      return sc::NormalMapMaterial{map, below, d.scale, d.follow_uv};
    }
    sc::Material operator()(const sd::MixtureDesc& d) const {
      sc::MixtureMaterial m;
      for (const auto& part : d.parts)
        m.parts.push_back({number(part.weight), part.complement, nested(part.bsdf)});
      return m;
    }
  };
  return std::visit(Convert{*this, b.where, on}, b.kind);
}

}  // namespace lumirank::world
