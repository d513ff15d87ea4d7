// BSDFs of a scene description. Each lists its fields once (fields.h). A new one is a struct here, and then:
// a line in mitsuba/bsdfs.cpp that reads it, and a material in scatter/material.h with its lobes
// (docs/adding-a-bsdf.md). World makes the material from the list, by position: a material has its members in
// the order of the fields, and the materials are in the order of BsdfKind.
#pragma once

#include <string>
#include <tuple>
#include <type_traits>
#include <variant>
#include <vector>

#include "base/error.h"
#include "scenedesc/schema/fields.h"
#include "scenedesc/schema/textures.h"

namespace lumirank::scenedesc {

// What a kind of BSDF is as a whole.
struct BsdfInfo {
  const char* name;  // Mitsuba's plugin, or one that only Lumirank has
  // Where Mitsuba 3 does not have it: its name in warnings, and what a diffuse BSDF in its place is called.
  const char* lacking = nullptr;
  const char* stand_in = nullptr;
  bool transmits = false;  // whatever its inputs
};

enum class Distribution { beckmann, ggx };

struct NullBsdfDesc {
  static constexpr BsdfInfo kInfo{"null", nullptr, nullptr, true};
  static constexpr auto fields() { return std::tuple{}; }
};
struct DiffuseDesc {
  ColorInput reflectance{Rgb(0.5f)};

  static constexpr BsdfInfo kInfo{"diffuse"};
  static constexpr auto fields() {
    return std::tuple{Field{"reflectance", &DiffuseDesc::reflectance, Role::reflectance}};
  }
};
struct RoughDiffuseDesc {  // Oren-Nayar, alpha as in Mitsuba (σ = alpha/√2)
  ColorInput reflectance{Rgb(0.5f)};
  FloatInput alpha{0.2f};

  static constexpr BsdfInfo kInfo{"roughdiffuse", "rough diffuse surfaces (Oren-Nayar)", "diffuse"};
  static constexpr auto fields() {
    return std::tuple{Field{"reflectance", &RoughDiffuseDesc::reflectance, Role::reflectance},
                      Field{"alpha", &RoughDiffuseDesc::alpha, Role::number, Range::not_negative}};
  }
};
struct ConductorDesc {  // smooth if alpha_u and alpha_v are the constant 0
  Rgb eta{0}, k{1};     // relative to the outside medium
  ColorInput specular_reflectance{Rgb(1)};
  Distribution distribution = Distribution::beckmann;
  FloatInput alpha_u{0}, alpha_v{0};

  static constexpr BsdfInfo kInfo{"conductor"};
  static constexpr auto fields() {
    return std::tuple{Field{"eta", &ConductorDesc::eta, Role::own},
                      Field{"k", &ConductorDesc::k, Role::own},
                      Field{"specular_reflectance", &ConductorDesc::specular_reflectance, Role::reflectance},
                      Field{"distribution", &ConductorDesc::distribution, Role::roughness},
                      Field{"alpha_u", &ConductorDesc::alpha_u, Role::roughness},
                      Field{"alpha_v", &ConductorDesc::alpha_v, Role::roughness}};
  }
};
struct DielectricDesc {             // smooth if alpha_u and alpha_v are the constant 0
  float eta = 1.5046f / 1.000277f;  // interior index over exterior index
  ColorInput specular_reflectance{Rgb(1)}, specular_transmittance{Rgb(1)};
  Distribution distribution = Distribution::beckmann;
  FloatInput alpha_u{0}, alpha_v{0};

  static constexpr BsdfInfo kInfo{"dielectric", nullptr, nullptr, true};
  static constexpr auto fields() {
    return std::tuple{
        Field{"eta", &DielectricDesc::eta, Role::index, Range::index, "bk7"},
        Field{"specular_reflectance", &DielectricDesc::specular_reflectance, Role::reflectance},
        Field{"specular_transmittance", &DielectricDesc::specular_transmittance, Role::reflectance},
        Field{"distribution", &DielectricDesc::distribution, Role::roughness},
        Field{"alpha_u", &DielectricDesc::alpha_u, Role::roughness},
        Field{"alpha_v", &DielectricDesc::alpha_v, Role::roughness}};
  }
};
struct ThinDielectricDesc {
  float eta = 1.5046f / 1.000277f;
  ColorInput specular_reflectance{Rgb(1)}, specular_transmittance{Rgb(1)};

  static constexpr BsdfInfo kInfo{"thindielectric", nullptr, nullptr, true};
  static constexpr auto fields() {
    return std::tuple{
        Field{"eta", &ThinDielectricDesc::eta, Role::index, Range::index, "bk7"},
        Field{"specular_reflectance", &ThinDielectricDesc::specular_reflectance, Role::reflectance},
        Field{"specular_transmittance", &ThinDielectricDesc::specular_transmittance, Role::reflectance}};
  }
};
struct PlasticDesc {  // smooth coating if alpha is the constant 0
  float eta = 1.49f / 1.000277f;
  ColorInput diffuse_reflectance{Rgb(0.5f)}, specular_reflectance{Rgb(1)};
  bool nonlinear = false;
  Distribution distribution = Distribution::beckmann;
  FloatInput alpha{0};
  // The base gets all that the layer does not reflect (a color of 1 loses nothing, whatever the roughness);
  // otherwise what single scattering by a rough interface lets through: much less, if it is rough. glTF;
  // overrides nonlinear.
  bool lossless = false;
  // Reflects by Schlick's curve from `specular_reflectance`, the reflectance at normal incidence, and the
  // base keeps what the largest of its channels leaves: glTF's materials by specular color and glossiness.
  // `eta` then shapes the base alone.
  bool schlick = false;
  // Under a rough coating, what comes back inside is averaged as Mitsuba 3 does (scatter/interface.h).
  bool as_mitsuba_3 = false;
  // glTF's KHR_materials_anisotropy: along the tangent alpha grows to alpha + (1 - alpha)·stretch². Of a
  // rough coating.
  FloatInput stretch{0};

  static constexpr BsdfInfo kInfo{"plastic"};
  static constexpr auto fields() {
    return std::tuple{Field{"eta", &PlasticDesc::eta, Role::index, Range::index, "polypropylene"},
                      Field{"diffuse_reflectance", &PlasticDesc::diffuse_reflectance, Role::reflectance},
                      Field{"specular_reflectance", &PlasticDesc::specular_reflectance, Role::reflectance},
                      Field{"nonlinear", &PlasticDesc::nonlinear, Role::flag},
                      Field{"distribution", &PlasticDesc::distribution, Role::roughness},
                      Field{"alpha", &PlasticDesc::alpha, Role::roughness},
                      Field{"lossless", &PlasticDesc::lossless, Role::own},
                      Field{"schlick", &PlasticDesc::schlick, Role::own},
                      Field{"as_mitsuba_3", &PlasticDesc::as_mitsuba_3, Role::own},
                      Field{"stretch", &PlasticDesc::stretch, Role::own}};
  }
};
struct PhongDesc {  // the modified (energy-conserving) Phong model
  ColorInput diffuse_reflectance{Rgb(0.5f)}, specular_reflectance{Rgb(0.2f)};
  FloatInput exponent{30};

  static constexpr BsdfInfo kInfo{"phong"};
  static constexpr auto fields() {
    return std::tuple{Field{"diffuse_reflectance", &PhongDesc::diffuse_reflectance, Role::reflectance},
                      Field{"specular_reflectance", &PhongDesc::specular_reflectance, Role::reflectance},
                      Field{"exponent", &PhongDesc::exponent, Role::number, Range::not_negative}};
  }
};
struct WardDesc {
  enum class Variant { ward, ward_duer, balanced };
  Variant variant = Variant::balanced;
  ColorInput diffuse_reflectance{Rgb(0.5f)}, specular_reflectance{Rgb(0.2f)};
  FloatInput alpha_u{0.1f}, alpha_v{0.1f};

  static constexpr BsdfInfo kInfo{"ward"};
  static constexpr auto fields() {
    return std::tuple{Field{"variant", &WardDesc::variant, Role::own},
                      Field{"diffuse_reflectance", &WardDesc::diffuse_reflectance, Role::reflectance},
                      Field{"specular_reflectance", &WardDesc::specular_reflectance, Role::reflectance},
                      Field{"alpha_u", &WardDesc::alpha_u, Role::own},
                      Field{"alpha_v", &WardDesc::alpha_v, Role::own}};
  }
};
struct PrincipledDesc {  // Mitsuba 3's "principled"
  ColorInput base_color{Rgb(0.5f)};
  FloatInput roughness{0.5f}, anisotropic{0}, metallic{0}, spec_trans{0}, spec_tint{0}, sheen{0},
      sheen_tint{0}, clearcoat{0}, clearcoat_gloss{0}, flatness{0};
  float eta = 1.5f;
  // Its metal sends back what single scattering by microfacets loses (scatter/interface.h). glTF.
  bool lossless = false;
  FloatInput stretch{0};  // as PlasticDesc's, beside `anisotropic`

  static constexpr BsdfInfo kInfo{"principled"};
  static constexpr auto fields() {
    return std::tuple{Field{"base_color", &PrincipledDesc::base_color, Role::reflectance},
                      Field{"roughness", &PrincipledDesc::roughness, Role::number, Range::to_1},
                      Field{"anisotropic", &PrincipledDesc::anisotropic, Role::number, Range::to_1},
                      Field{"metallic", &PrincipledDesc::metallic, Role::number, Range::to_1},
                      Field{"spec_trans", &PrincipledDesc::spec_trans, Role::number, Range::to_1},
                      Field{"spec_tint", &PrincipledDesc::spec_tint, Role::number, Range::to_1},
                      Field{"sheen", &PrincipledDesc::sheen, Role::number, Range::to_1},
                      Field{"sheen_tint", &PrincipledDesc::sheen_tint, Role::number, Range::to_1},
                      Field{"clearcoat", &PrincipledDesc::clearcoat, Role::number, Range::to_1},
                      Field{"clearcoat_gloss", &PrincipledDesc::clearcoat_gloss, Role::number, Range::to_1},
                      Field{"flatness", &PrincipledDesc::flatness, Role::number, Range::to_1},
                      Field{"eta", &PrincipledDesc::eta, Role::own, Range::index},
                      Field{"lossless", &PrincipledDesc::lossless, Role::own},
                      Field{"stretch", &PrincipledDesc::stretch, Role::own}};
  }
};
struct HairDesc {  // Kajiya-Kay; only for curves. Shares of the light that meets a fiber
  ColorInput diffuse_reflectance{Rgb(0.4f)}, specular_reflectance{Rgb(0.1f)};
  FloatInput exponent{40};  // the specular lobe falls like cosⁿ of the angle to the mirror cone

  static constexpr BsdfInfo kInfo{"kajiyakay"};
  static constexpr auto fields() {
    return std::tuple{Field{"diffuse_reflectance", &HairDesc::diffuse_reflectance, Role::reflectance},
                      Field{"specular_reflectance", &HairDesc::specular_reflectance, Role::reflectance},
                      Field{"exponent", &HairDesc::exponent, Role::number, Range::not_negative}};
  }
};
// A dielectric fiber with a rough surface (Chiang et al. 2016), as pbrt's and Mitsuba 3's "hair"; only for
// curves.
struct HairFiberDesc {
  Rgb sigma_a{0};                      // absorption per radius of the fiber
  float eta = 1.55f;                   // of the fiber over what is around it
  float beta_m = 0.3f, beta_n = 0.3f;  // longitudinal and azimuthal roughness
  float tilt = 2;                      // of the scales, towards the root of the curve, degrees

  static constexpr BsdfInfo kInfo{"hair"};
  static constexpr auto fields() {
    return std::tuple{Field{"sigma_a", &HairFiberDesc::sigma_a, Role::own},
                      Field{"eta", &HairFiberDesc::eta, Role::own, Range::index},
                      Field{"longitudinal_roughness", &HairFiberDesc::beta_m, Role::own},
                      Field{"azimuthal_roughness", &HairFiberDesc::beta_n, Role::own},
                      Field{"scale_tilt", &HairFiberDesc::tilt, Role::own}};
  }
};
struct PrincipledThinDesc {  // Mitsuba 3's "principledthin": a sheet without thickness, alike on both sides
  ColorInput base_color{Rgb(0.5f)};
  FloatInput roughness{0.5f}, anisotropic{0}, spec_trans{0}, spec_tint{0}, sheen{0}, sheen_tint{0},
      flatness{0}, diff_trans{0};  // diff_trans: 0 to 2, all of the matt light goes through
  float eta = 1.5f;

  static constexpr BsdfInfo kInfo{"principledthin", nullptr, nullptr, true};
  static constexpr auto fields() {
    return std::tuple{Field{"base_color", &PrincipledThinDesc::base_color, Role::reflectance},
                      Field{"roughness", &PrincipledThinDesc::roughness, Role::number, Range::to_1},
                      Field{"anisotropic", &PrincipledThinDesc::anisotropic, Role::number, Range::to_1},
                      Field{"spec_trans", &PrincipledThinDesc::spec_trans, Role::number, Range::to_1},
                      Field{"spec_tint", &PrincipledThinDesc::spec_tint, Role::number, Range::to_1},
                      Field{"sheen", &PrincipledThinDesc::sheen, Role::number, Range::to_1},
                      Field{"sheen_tint", &PrincipledThinDesc::sheen_tint, Role::number, Range::to_1},
                      Field{"flatness", &PrincipledThinDesc::flatness, Role::number, Range::to_1},
                      Field{"diff_trans", &PrincipledThinDesc::diff_trans, Role::number, Range::to_2},
                      Field{"eta", &PrincipledThinDesc::eta, Role::own, Range::index}};
  }
};
// A thin sheet that reflects and lets through diffusely, alike on both sides: Mitsuba 0.6's "difftrans",
// pbrt's diffusetransmission. If both together exceed 1, they are scaled down alike.
struct DiffuseTransmitterDesc {
  ColorInput reflectance{Rgb(0)}, transmittance{Rgb(0.5f)};

  static constexpr BsdfInfo kInfo{"difftrans", "diffuse transmission", "diffuse reflection alone"};
  static constexpr auto fields() {
    return std::tuple{Field{"reflectance", &DiffuseTransmitterDesc::reflectance, Role::own},
                      Field{"transmittance", &DiffuseTransmitterDesc::transmittance, Role::reflectance}};
  }
};
// A measured isotropic BRDF: a table in the format of the MERL database (Matusik et al. 2003).
struct MeasuredDesc {
  FileInput file;

  static constexpr BsdfInfo kInfo{"merl", "measured BRDFs of the MERL database", "diffuse, gray 0.5"};
  static constexpr auto fields() {
    return std::tuple{Field{"filename", &MeasuredDesc::file, Role::file, Range::any, "BRDF table"}};
  }
};
// A dielectric layer over the nested BSDF, without scattering in it; smooth if alpha_u and alpha_v are the
// constant 0. Mitsuba 0.6's "coating" and "roughcoating", pbrt's coateddiffuse and coatedconductor (over a
// diffuse or conductor BSDF whose eta and k are relative to the layer), glTF's clear coat (`weight`).
struct CoatingDesc {
  int nested = kNone;
  float eta = 1.5046f / 1.000277f;          // index of the layer over that of the outside
  ColorInput specular_reflectance{Rgb(1)};  // scales the layer's own reflection alone
  ColorInput absorption{Rgb(0)};            // absorption coefficient × thickness, per channel, ≥ 0
  FloatInput weight{1};                     // share of the surface that is coated
  Distribution distribution = Distribution::beckmann;
  FloatInput alpha_u{0}, alpha_v{0};
  // Light goes straight through the layer, which returns nothing inside: the base gets all that the layer
  // does not reflect. glTF's clear coat; without absorption.
  bool straight = false;

  static constexpr BsdfInfo kInfo{"coating"};
  static constexpr auto fields() {
    return std::tuple{Field{"eta", &CoatingDesc::eta, Role::index, Range::index, "bk7"},
                      Field{"specular_reflectance", &CoatingDesc::specular_reflectance, Role::reflectance},
                      Field{"absorption", &CoatingDesc::absorption, Role::own},
                      Field{"weight", &CoatingDesc::weight, Role::own},
                      Field{"distribution", &CoatingDesc::distribution, Role::roughness},
                      Field{"alpha_u", &CoatingDesc::alpha_u, Role::roughness},
                      Field{"alpha_v", &CoatingDesc::alpha_v, Role::roughness},
                      Field{"straight", &CoatingDesc::straight, Role::own},
                      Field{"nested", &CoatingDesc::nested, Role::nested}};
  }
};
// Sheen of cloth over the nested BSDF, which is dimmed by what the sheen reflects: glTF's
// KHR_materials_sheen.
struct SheenDesc {
  int nested = kNone;
  ColorInput color{Rgb(0)};
  FloatInput roughness{0};  // the square root of α

  static constexpr BsdfInfo kInfo{"sheen"};
  static constexpr auto fields() {
    return std::tuple{Field{"color", &SheenDesc::color, Role::own},
                      Field{"roughness", &SheenDesc::roughness, Role::own},
                      Field{"nested", &SheenDesc::nested, Role::nested}};
  }
};
struct MaskDesc {  // opacity 1: the nested BSDF; 0: nothing there
  FloatInput opacity{0.5f};
  int nested = kNone;

  static constexpr BsdfInfo kInfo{"mask", nullptr, nullptr, true};
  static constexpr auto fields() {
    return std::tuple{Field{"opacity", &MaskDesc::opacity, Role::number, Range::to_1},
                      Field{"nested", &MaskDesc::nested, Role::nested}};
  }
};
struct TwoSidedDesc {
  int front = kNone, back = kNone;  // equal if one BSDF serves both

  static constexpr BsdfInfo kInfo{"twosided"};
  static constexpr auto fields() {
    return std::tuple{Field{"front", &TwoSidedDesc::front, Role::nested},
                      Field{"back", &TwoSidedDesc::back, Role::nested}};
  }
};
struct BumpMapDesc {
  int texture = kNone;  // displacement height, in world units per unit of uv
  float scale = 1;
  int nested = kNone;

  static constexpr BsdfInfo kInfo{"bumpmap"};
  static constexpr auto fields() {
    return std::tuple{Field{"texture", &BumpMapDesc::texture, Role::texture},
                      Field{"scale", &BumpMapDesc::scale, Role::own, Range::any, "bump map's scale"},
                      Field{"nested", &BumpMapDesc::nested, Role::nested}};
  }
};
// The tangent turned within the surface: glTF's KHR_materials_anisotropy. Axes are those of NormalMapDesc
// with follow_uv.
struct TurnedTangentDesc {
  ColorInput direction{Rgb(1, 0.5f, 0)};  // where it points along the first two axes, 2·rg - 1
  float angle = 0;  // by which that is turned on, from the first towards the second, radians
  int nested = kNone;

  static constexpr BsdfInfo kInfo{"turnedtangent"};
  static constexpr auto fields() {
    return std::tuple{Field{"direction", &TurnedTangentDesc::direction, Role::own},
                      Field{"angle", &TurnedTangentDesc::angle, Role::own, Range::any, "tangent's angle"},
                      Field{"nested", &TurnedTangentDesc::nested, Role::nested}};
  }
};
struct NormalMapDesc {
  int texture = kNone;  // raw RGB, n = 2·rgb - 1 in the tangent frame
  int nested = kNone;
  float scale = 1;  // of n's first two components
  // The second axis points up in the picture, so against rising v, also where the uvs are mirrored (glTF);
  // otherwise it is n × dp/du (Mitsuba).
  bool follow_uv = false;

  static constexpr BsdfInfo kInfo{"normalmap"};
  static constexpr auto fields() {
    return std::tuple{Field{"texture", &NormalMapDesc::texture, Role::texture},
                      Field{"scale", &NormalMapDesc::scale, Role::own, Range::any, "normal map's scale"},
                      Field{"follow_uv", &NormalMapDesc::follow_uv, Role::own},
                      Field{"nested", &NormalMapDesc::nested, Role::nested}};
  }
};
struct MixtureDesc {  // Σ weight_k · bsdf_k; "blendbsdf" has two entries and weights 1 - w, w
  struct Part {
    FloatInput weight;
    bool complement = false;  // the weight is 1 - value
    int bsdf = kNone;
  };
  std::vector<Part> parts;

  static constexpr BsdfInfo kInfo{"mixturebsdf"};
};

using BsdfKind =
    std::variant<DiffuseDesc, NullBsdfDesc, RoughDiffuseDesc, ConductorDesc, DielectricDesc,
                 ThinDielectricDesc, PlasticDesc, PhongDesc, WardDesc, PrincipledDesc, PrincipledThinDesc,
                 DiffuseTransmitterDesc, MeasuredDesc, CoatingDesc, SheenDesc, HairDesc, HairFiberDesc,
                 MaskDesc, TwoSidedDesc, BumpMapDesc, NormalMapDesc, TurnedTangentDesc, MixtureDesc>;

struct BsdfDesc {
  std::string id;
  SourceLocation where;
  BsdfKind kind;
};

// Calls visit(index) for every BSDF nested in one of this kind, as often as it names them; some may be kNone.
template <typename Visit>
void for_each_nested(const BsdfKind& kind, Visit&& visit) {
  std::visit(
      [&](const auto& desc) {
        if constexpr (requires { desc.parts; }) {
          for (const auto& part : desc.parts) visit(part.bsdf);
        } else {
          for_each_field(desc, [&](const auto& field, const auto& value) {
            if constexpr (std::is_same_v<std::decay_t<decltype(value)>, int>)
              if (field.role == Role::nested) visit(value);
          });
        }
      },
      kind);
}

// Calls visit(file) for every file that a BSDF of this kind names.
template <typename Visit>
void for_each_file(const BsdfKind& kind, Visit&& visit) {
  std::visit(
      [&](const auto& desc) {
        if constexpr (!requires { desc.parts; })
          for_each_field(desc, [&](const auto&, const auto& value) {
            if constexpr (std::is_same_v<std::decay_t<decltype(value)>, FileInput>) visit(value);
          });
      },
      kind);
}

}  // namespace lumirank::scenedesc
