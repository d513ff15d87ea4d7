// Makes the BSDF of a material: one of pbrt-v4 (materials.cpp), or one of pbrt-v3 (version3_materials.cpp).
#pragma once

#include <optional>
#include <string>

#include "scenedesc/pbrt/reader.h"

namespace lumirank::scenedesc::pbrt {

class MaterialMaker {
 public:
  MaterialMaker(Reader& reader, Params& p, const std::string& id)
      : reader_(reader), p_(p), id_(id), remap_(p.flag("remaproughness", true)) {}

  // Indices into the scene's BSDFs.
  int make(const std::string& type);
  int make_of_version3(const std::string& type);

 private:
  using MaterialKind = decltype(BsdfDesc::kind);

  int add(MaterialKind kind) { return reader_.add_bsdf(id_, p_.where(), std::move(kind)); }
  ColorInput color(const char* name, float fallback) {
    return reader_.color(p_, name, {Rgb(fallback), kNone}, Intent::albedo);
  }
  // "normalmap" and "displacement" around it.
  int detailed(int bsdf);
  // What is opaque reflects on both sides.
  int two_sided(MaterialKind kind);

  ConductorDesc conductor(const std::string& prefix, std::optional<float> outside);
  void reflecting(ConductorDesc& out);
  int coated(int nested, const char* eta, const std::string& prefix);
  int coated_diffuse();
  int coated_conductor();
  int dielectric();
  int diffuse_transmission();
  int mix(const std::vector<std::string>& names, const FloatInput& amount);
  int mix();
  ColorInput color_of_depth();
  int subsurface();
  int hair();

  // Of pbrt-v3.
  struct Widths {
    FloatInput u, v;
  };
  FloatInput width(const char* name, FloatInput roughness);
  Widths widths(float fallback);
  int matte();
  int glossy(const ColorInput& diffuse, const ColorInput& specular, float eta, bool schlick);
  // What has the color, counted by a share of the surface.
  ColorInput over(const ColorInput& color, float share);
  int uber();
  int metal();
  int mirror();
  int glass();
  int translucent();
  int mix_of_version3();
  int disney();

  Reader& reader_;
  Params& p_;
  const std::string& id_;
  const bool remap_;
};

}  // namespace lumirank::scenedesc::pbrt
