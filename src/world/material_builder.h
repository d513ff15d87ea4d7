// Descriptions of BSDFs → materials, nested before their users; only those in use.
#pragma once

#include <vector>

#include "scatter/material.h"
#include "scenedesc/scene_desc.h"
#include "world/notes.h"
#include "world/texture_builder.h"

namespace lumirank::world {

class MaterialBuilder {
 public:
  MaterialBuilder(const scenedesc::SceneDesc& desc, TextureBuilder& textures, Notes& notes);

  // Index of the material for a BSDF; kNone stands for the default, diffuse with reflectance 0.5.
  int use(int bsdf, const SourceLocation& user);
  std::vector<scatter::Material> take() { return std::move(materials_); }

 private:
  int add(scatter::Material material);
  bool transmits(int material) const;
  bool is_coated(int material) const;

  scatter::Material convert(const scenedesc::BsdfDesc& b);
  // A two-sided wrapper around something that lets light through is replaced by its contents: -1 if it may
  // stay.
  int instead_of_two_sided(const scenedesc::TwoSidedDesc& d, const SourceLocation& where);

  const scenedesc::SceneDesc& desc_;
  TextureBuilder& textures_;
  Notes& notes_;
  std::vector<scatter::Material> materials_;
  std::vector<int> index_;  // of each description: ≥ 0 built, -1 not yet, -2 being built
  int default_ = -1;
};

}  // namespace lumirank::world
