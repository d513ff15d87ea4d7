// A description becomes a material field by field: what happens to a field follows from its type. What is
// left to the kinds is where something else must stand in for them.
#include <cmath>
#include <type_traits>

#include "base/error.h"
#include "base/members.h"
#include "scenedesc/schema/files.h"
#include "scenedesc/schema/hair.h"
#include "world/material_builder.h"

namespace lumirank::world {

namespace sd = scenedesc;
namespace sc = scatter;

namespace {

// The material of a description: the alternative in the same place.
// The last one, faces of panes, no format has.
static_assert(std::variant_size_v<sd::BsdfKind> + 1 == std::variant_size_v<sc::Material>);
template <typename Desc, std::size_t k = 0>
constexpr std::size_t place_of_kind() {
  if constexpr (std::is_same_v<Desc, std::variant_alternative_t<k, sd::BsdfKind>>)
    return k;
  else
    return place_of_kind<Desc, k + 1>();
}
template <typename Desc>
using MaterialOf = std::variant_alternative_t<place_of_kind<Desc>(), sc::Material>;

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

Rgb checked_index(Rgb value, const SourceLocation& where) {
  if (!is_finite(value) || value.r < 0 || value.g < 0 || value.b < 0)
    throw InputError(where, "a conductor's index of refraction is negative or not finite",
                     "give numbers ≥ 0");
  if (max_component(value) > kMaxIndex)
    throw InputError(where, "a conductor's index of refraction is beyond what 32-bit arithmetic can carry",
                     "give numbers up to 1e6");
  return value;
}

bool is_zero(const sd::FloatInput& f) { return f.texture == sd::kNone && f.value == 0; }

template <typename Desc>
bool is_smooth(const Desc& d) {
  if constexpr (requires { d.alpha_u; })
    return is_zero(d.alpha_u) && is_zero(d.alpha_v);
  else
    return is_zero(d.alpha);
}

bool lacks_file(const sd::BsdfKind& kind) {
  bool lacks = false;
  sd::for_each_file(kind, [&](const sd::FileInput& file) { lacks = lacks || file.missing; });
  return lacks;
}

}  // namespace

class MaterialBuilder::Conversion {
 public:
  Conversion(MaterialBuilder& builder, const SourceLocation& where, Carrier carrier)
      : builder_(builder), where_(where), carrier_(carrier) {}

  template <typename Desc>
  sc::Material operator()(const Desc& d) const {
    return by_fields(d);
  }
  // Hair is for fibers only.
  sc::Material operator()(const sd::HairDesc& d) const {
    if (carrier_ == Carrier::fibers) return by_fields(d);
    builder_.notes_.warn(where_, "a hair BSDF on a surface", "diffuse of its diffuse reflectance");
    return sc::DiffuseMaterial{builder_.textures_.color(d.diffuse_reflectance, where_)};
  }
  sc::Material operator()(const sd::HairFiberDesc& d) const {
    if (carrier_ == Carrier::fibers)
      return sc::HairFiberMaterial{builder_.fiber_table(
          {d.sigma_a, checked_index(Rgb(d.eta), where_).r, d.beta_m, d.beta_n, d.tilt * (kPi / 180)})};
    const Rgb color = sd::hair_from_absorption(d.sigma_a, d.eta, d.beta_m).diffuse_reflectance.value;
    builder_.notes_.warn(where_, "a hair BSDF on a surface", "diffuse of the color of what has been inside");
    return sc::DiffuseMaterial{sc::ColorInput{color, -1}};
  }
  sc::Material operator()(const sd::CoatingDesc& d) const {
    const int below = nested(d.nested);
    if (!builder_.of(below).coated) return by_fields(d);
    builder_.notes_.warn(where_, "a coating over a BSDF that has a coating", "the inner one alone");
    return built(below);
  }
  sc::Material operator()(const sd::SheenDesc& d) const {
    const int nested_material = nested(d.nested);
    const Traits& below = builder_.of(nested_material);
    const char* which = below.transmits ? "that lets light pass"
                        : below.coated  ? "that has a coating"
                        : below.sheen   ? "that has sheen"
                                        : nullptr;
    if (!which) return by_fields(d);
    builder_.notes_.warn(where_, std::string("sheen over a BSDF ") + which, "that BSDF alone");
    return built(nested_material);
  }
  // Where the picture of the opacity is missing, nothing is cut out.
  sc::Material operator()(const sd::MaskDesc& d) const {
    sc::MaskMaterial out = by_fields(d);
    out.opacity = builder_.textures_.number(d.opacity, where_, 1);
    return out;
  }
  sc::Material operator()(const sd::BumpMapDesc& d) const { return by_map(d); }
  sc::Material operator()(const sd::NormalMapDesc& d) const { return by_map(d); }
  sc::Material operator()(const sd::MixtureDesc& d) const {
    sc::MixtureMaterial out;
    for (const auto& part : d.parts)
      out.parts.push_back(
          {builder_.textures_.number(part.weight, where_), part.complement, nested(part.bsdf)});
    return out;
  }

 private:
  // The material whose members are the converted fields, in their order.
  template <typename Desc>
  MaterialOf<Desc> by_fields(const Desc& d) const {
    using Made = MaterialOf<Desc>;
    constexpr bool smooth = requires(Made m) { m.smooth; };
    static_assert(has_members<Made, std::tuple_size_v<decltype(Desc::fields())> + (smooth ? 1 : 0)>(),
                  "the members of a material are the fields of its description");
    Made out = std::apply([&](const auto&... field) { return Made{member(field, d.*field.member)...}; },
                          Desc::fields());
    if constexpr (smooth) {
      out.smooth = is_smooth(d);
      const void* last = nullptr;
      for_each_member(out, [&](const auto& member) { last = &member; });
      if (last != &out.smooth) throw InternalError("a material's `smooth` is not its last member");
    }
    return out;
  }

  // Without its picture a map leaves the BSDF below as it is.
  template <typename Desc>
  sc::Material by_map(const Desc& d) const {
    const auto out = by_fields(d);
    if (builder_.textures_.is_missing(d.texture)) return built(out.nested);
    return out;
  }

  // A material that is there already, again.
  const sc::Material& built(int material) const {
    return builder_.materials_[static_cast<std::size_t>(material)];
  }
  int nested(int bsdf) const {
    if (bsdf == sd::kNone) throw InputError(where_, "a BSDF lacks the one nested in it", "nest a BSDF");
    return builder_.use(bsdf, where_, carrier_);
  }
  int texture(int index) const {
    if (index == sd::kNone) throw InputError(where_, "a BSDF lacks its texture", "nest a texture");
    return builder_.textures_.use(index, where_);
  }

  // What a field becomes, for each type of fields.
  sc::ColorInput member(const auto&, const sd::ColorInput& c) const {
    return builder_.textures_.color(c, where_);
  }
  sc::FloatInput member(const auto&, const sd::FloatInput& f) const {
    return builder_.textures_.number(f, where_);
  }
  float member(const auto& field, float value) const {
    if (field.range == sd::Range::index) return checked_eta(value, where_);
    if (!std::isfinite(value))
      throw InputError(where_,
                       std::string("the ") + (field.detail ? field.detail : field.name) + " is not finite",
                       "give a number");
    return value;
  }
  int member(const auto& field, int index) const {
    return field.role == sd::Role::nested ? nested(index) : texture(index);
  }
  Rgb member(const auto&, const Rgb& index) const { return checked_index(index, where_); }
  bool member(const auto&, bool flag) const { return flag; }
  sc::NormalDistribution member(const auto&, sd::Distribution d) const {
    return d == sd::Distribution::ggx ? sc::NormalDistribution::ggx : sc::NormalDistribution::beckmann;
  }
  int member(const auto&, sd::WardDesc::Variant variant) const { return static_cast<int>(variant); }
  std::shared_ptr<const sc::MeasuredTable> member(const auto&, const sd::FileInput& file) const {
    return sc::parse_measured(sd::read_file(file.name, where_), file.name, where_);
  }

  MaterialBuilder& builder_;
  const SourceLocation& where_;
  Carrier carrier_;
};

sc::Material MaterialBuilder::convert(const sd::BsdfDesc& b, Carrier carrier) {
  if (lacks_file(b.kind)) return sc::DiffuseMaterial{sc::ColorInput{Rgb(0.5f), -1}};
  return std::visit(Conversion(*this, b.where, carrier), b.kind);
}

}  // namespace lumirank::world
