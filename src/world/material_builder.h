// Descriptions of BSDFs → materials, nested before their users; only those in use.
#pragma once

#include <vector>

#include "scatter/material.h"
#include "scenedesc/scene_desc.h"
#include "world/notes.h"
#include "world/texture_builder.h"

namespace lumirank::world {

// What a material lies on: hair is for fibres only.
enum class Carrier { surface, fibres };

class MaterialBuilder {
 public:
  MaterialBuilder(const scenedesc::SceneDesc& desc, TextureBuilder& textures, Notes& notes);

  // Index of the material for a BSDF; kNone stands for the default, diffuse with reflectance 0.5.
  int use(int bsdf, const SourceLocation& user, Carrier carrier = Carrier::surface);
  std::vector<scatter::Material> take() { return std::move(materials_); }

 private:
  int add(scatter::Material material);
  bool transmits(int material) const;
  // The material, or one nested in it, is a Sought.
  template <typename Sought>
  bool holds(int material) const;

  scatter::Material convert(const scenedesc::BsdfDesc& b, Carrier carrier);
  bool holds_hair(int bsdf, std::size_t depth = 0) const;
  // On fibres: hair has no sides, no bumps and does not mix with the BSDFs of surfaces. kNone: it may stay.
  int instead_around_hair(const scenedesc::BsdfDesc& b);
  // A two-sided wrapper around something that lets light through is replaced by its contents: -1 if it may
  // stay.
  int instead_of_two_sided(const scenedesc::TwoSidedDesc& d, const SourceLocation& where);

  const scenedesc::SceneDesc& desc_;
  TextureBuilder& textures_;
  Notes& notes_;
  std::vector<scatter::Material> materials_;
  // Of each description: ≥ 0 built, -1 not yet, -2 being built. Those with hair differ between the carriers.
  std::vector<int> index_, index_on_fibres_;
  int default_ = -1;
};

}  // namespace lumirank::world
