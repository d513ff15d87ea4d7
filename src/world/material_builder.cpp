#include "world/material_builder.h"

#include <type_traits>

#include "base/error.h"

namespace lumirank::world {

namespace sd = scenedesc;
namespace sc = scatter;

namespace {

constexpr int kNotBuilt = -1, kInProgress = -2;

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
  if (std::holds_alternative<sd::HairDesc>(kind) || std::holds_alternative<sd::HairFiberDesc>(kind))
    return true;
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

std::shared_ptr<const sc::FiberTable> MaterialBuilder::fiber_table(const sc::FiberOptics& fiber) {
  for (const auto& [optics, table] : fiber_tables_)
    if (optics == fiber) return table;
  return fiber_tables_.emplace_back(fiber, sc::make_fiber_table(fiber)).second;
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
          out.transmits |= sc::kTransmits<Kind>;
          out.coated |= std::is_same_v<Kind, sc::CoatingMaterial>;
          out.sheen |= std::is_same_v<Kind, sc::SheenMaterial>;
        } else if constexpr (std::is_same_v<Kind, sc::PrincipledMaterial>) {
          out.transmits = m.spec_trans.texture >= 0 || m.spec_trans.value > 0;
        } else {
          out.transmits = sc::kTransmits<Kind>;
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

}  // namespace lumirank::world
