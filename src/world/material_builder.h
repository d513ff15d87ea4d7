// Descriptions of BSDFs → materials, nested before their users; only those in use.
#pragma once

#include <vector>

#include "scatter/fiber_table.h"
#include "scatter/material.h"
#include "scenedesc/schema/scene_desc.h"
#include "world/notes.h"
#include "world/texture_builder.h"

namespace lumirank::world {

// What a material lies on: hair is for fibers only.
enum class Carrier { surface, fibers };

class MaterialBuilder {
 public:
  MaterialBuilder(const scenedesc::SceneDesc& desc, TextureBuilder& textures, Notes& notes);

  // Index of the material for a BSDF; kNone stands for the default, diffuse with reflectance 0.5.
  int use(int bsdf, const SourceLocation& user, Carrier carrier = Carrier::surface);
  std::vector<scatter::Material> take() { return std::move(materials_); }
  // Whether light passes it, whatever way. Also after take().
  bool transmits(int material) const { return of(material).transmits; }

 private:
  int add(scatter::Material material);
  // What a material is, those nested in it included: noted when it is added, after them, because sides and
  // mixtures may share what they nest many times over.
  struct Traits {
    bool transmits = false, coated = false, sheen = false;
  };
  const Traits& of(int material) const { return traits_[static_cast<std::size_t>(material)]; }
  Traits traits_of(const scatter::Material& material) const;

  // material_conversion.cpp
  class Conversion;
  scatter::Material convert(const scenedesc::BsdfDesc& b, Carrier carrier);
  bool holds_hair(int bsdf, std::size_t depth = 0) const;
  // On fibers: hair has no sides, no bumps and does not mix with the BSDFs of surfaces. kNone: it may stay.
  int instead_around_hair(const scenedesc::BsdfDesc& b);
  // Made once for all materials that ask for the same.
  std::shared_ptr<const scatter::FiberTable> fiber_table(const scatter::FiberOptics& fiber);
  // A two-sided wrapper around something that lets light through is replaced by its contents: -1 if it may
  // stay.
  int instead_of_two_sided(const scenedesc::TwoSidedDesc& d, const SourceLocation& where);

  const scenedesc::SceneDesc& desc_;
  TextureBuilder& textures_;
  Notes& notes_;
  std::vector<scatter::Material> materials_;
  std::vector<Traits> traits_;
  // Of each description: ≥ 0 built, -1 not yet, -2 being built. Those with hair differ between the carriers.
  std::vector<int> index_, index_on_fibers_;
  std::vector<std::pair<scatter::FiberOptics, std::shared_ptr<const scatter::FiberTable>>> fiber_tables_;
  int default_ = -1;
};

}  // namespace lumirank::world
