// The BSDFs of a scene, prepared: textures and nested BSDFs are indices, indices of refraction are resolved.
// A material becomes a Closure at a surface point.
//
// The members of a material are in the order in which its description lists its fields
// (scenedesc/schema/bsdfs.h), and the materials in the order of BsdfKind: world/material_conversion.cpp makes
// the one of the other by position. `smooth`, which is no field, comes last.
#pragma once

#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "base/error.h"
#include "base/frame.h"
#include "base/rgb.h"
#include "scatter/closure.h"
#include "scatter/texture.h"

namespace lumirank::scatter {

// An input that may vary over the surface.
struct ColorInput {
  Rgb value{0};
  int texture = -1;
};
struct FloatInput {
  float value = 0;
  int texture = -1;
};

// What a material needs to know of a point.
struct SurfacePoint {
  Vec3f position;
  Vec3f ng;          // unit geometric normal, on the outside
  Frame shading;     // shading.n in the hemisphere of ng; shading.s along dp/du where uv exist
  Vec3f dpdu, dpdv;  // for bump maps; zero if the mesh has no uv
  SurfaceUv uv;
};

// A material is a struct, with how its lobes are added to a closure at a point, scaled by `weight` > 0.
class ClosureBuilder;

// Whether light passes, whatever the inputs: such a material says `transmits`.
template <typename Kind>
inline constexpr bool kTransmits = requires {
  Kind::transmits;
};

struct NullMaterial {
  static constexpr bool transmits = true;
};
void add_lobes(const NullMaterial& m, ClosureBuilder& out, const SurfacePoint& at, float weight);

struct DiffuseMaterial {
  ColorInput reflectance;
};
void add_lobes(const DiffuseMaterial& m, ClosureBuilder& out, const SurfacePoint& at, float weight);

struct RoughDiffuseMaterial {
  ColorInput reflectance;
  FloatInput alpha;
};
void add_lobes(const RoughDiffuseMaterial& m, ClosureBuilder& out, const SurfacePoint& at, float weight);

struct ConductorMaterial {
  Rgb eta, k;
  ColorInput specular_reflectance;
  NormalDistribution distribution;
  FloatInput alpha_u, alpha_v;
  bool smooth = false;
};
void add_lobes(const ConductorMaterial& m, ClosureBuilder& out, const SurfacePoint& at, float weight);

struct DielectricMaterial {
  static constexpr bool transmits = true;
  float eta;
  ColorInput specular_reflectance, specular_transmittance;
  NormalDistribution distribution;
  FloatInput alpha_u, alpha_v;
  bool smooth = true;
};
void add_lobes(const DielectricMaterial& m, ClosureBuilder& out, const SurfacePoint& at, float weight);

struct ThinDielectricMaterial {
  static constexpr bool transmits = true;
  float eta;
  ColorInput specular_reflectance, specular_transmittance;
};
void add_lobes(const ThinDielectricMaterial& m, ClosureBuilder& out, const SurfacePoint& at, float weight);

// One of the two faces of a slab through which light goes straight; no format has it. The eye sees the glass
// that it stands for, whose rim shows.
struct SlabFaceMaterial {
  static constexpr bool transmits = true;
  float eta;
  ColorInput specular_reflectance, specular_transmittance;
  int glass = -1;  // of the set
};
void add_lobes(const SlabFaceMaterial& m, ClosureBuilder& out, const SurfacePoint& at, float weight);

struct PlasticMaterial {
  float eta;
  ColorInput diffuse_reflectance, specular_reflectance;
  bool nonlinear = false;
  NormalDistribution distribution;
  FloatInput alpha;
  bool lossless = false;  // these four: see PlasticDesc
  bool schlick = false;
  bool as_mitsuba_3 = false;
  FloatInput stretch = {};
  bool smooth = true;
};
void add_lobes(const PlasticMaterial& m, ClosureBuilder& out, const SurfacePoint& at, float weight);

struct PhongMaterial {
  ColorInput diffuse_reflectance, specular_reflectance;
  FloatInput exponent;
};
void add_lobes(const PhongMaterial& m, ClosureBuilder& out, const SurfacePoint& at, float weight);

struct WardMaterial {
  int variant = 2;  // 0 ward, 1 ward-duer, 2 balanced
  ColorInput diffuse_reflectance, specular_reflectance;
  FloatInput alpha_u, alpha_v;
};
void add_lobes(const WardMaterial& m, ClosureBuilder& out, const SurfacePoint& at, float weight);

struct PrincipledMaterial {
  ColorInput base_color;
  FloatInput roughness, anisotropic, metallic, spec_trans, spec_tint, sheen, sheen_tint, clearcoat,
      clearcoat_gloss, flatness;
  float eta = 1.5f;
  bool lossless = false;  // these two: see PrincipledDesc
  FloatInput stretch;
};
void add_lobes(const PrincipledMaterial& m, ClosureBuilder& out, const SurfacePoint& at, float weight);

// A measured isotropic BRDF (lobes/measured.cpp).
struct MeasuredTable;
struct MeasuredMaterial {
  std::shared_ptr<const MeasuredTable> table;
};
void add_lobes(const MeasuredMaterial& m, ClosureBuilder& out, const SurfacePoint& at, float weight);
// The table in the bytes of a file of the MERL database, or of the RGL database (tensor_brdf.h). InputError,
// at `where`, if that is not what they are; `filename` only names them.
std::shared_ptr<const MeasuredTable> parse_measured(const std::string& bytes, const std::string& filename,
                                                    const SourceLocation& where);
// A thin sheet that reflects and lets through diffusely, alike on both sides.
struct DiffuseTransmitterMaterial {
  static constexpr bool transmits = true;
  ColorInput reflectance, transmittance;
};
void add_lobes(const DiffuseTransmitterMaterial& m, ClosureBuilder& out, const SurfacePoint& at,
               float weight);

// Mitsuba 3's principledthin: a sheet without thickness, alike on both sides. diff_trans within [0, 2].
struct PrincipledThinMaterial {
  static constexpr bool transmits = true;
  ColorInput base_color;
  FloatInput roughness, anisotropic, spec_trans, spec_tint, sheen, sheen_tint, flatness, diff_trans;
  float eta = 1.5f;
};
void add_lobes(const PrincipledThinMaterial& m, ClosureBuilder& out, const SurfacePoint& at, float weight);

// A dielectric layer over another material (coating.cpp).
struct CoatingMaterial {
  float eta = 1.5f;
  ColorInput specular_reflectance;
  ColorInput absorption;  // optical thickness
  FloatInput weight;      // share of the surface that is coated
  NormalDistribution distribution;
  FloatInput alpha_u, alpha_v;
  bool straight = false;  // see CoatingDesc
  int nested = -1;
  bool smooth = true;
};
void add_lobes(const CoatingMaterial& m, ClosureBuilder& out, const SurfacePoint& at, float weight);

// Sheen (charlie_sheen.h) over an opaque material without coating, sheen or hair.
struct SheenMaterial {
  ColorInput color;
  FloatInput roughness;  // √α
  int nested = -1;
};
void add_lobes(const SheenMaterial& m, ClosureBuilder& out, const SurfacePoint& at, float weight);

struct HairMaterial {  // for fibers only: the point's shading.s runs along them
  ColorInput diffuse_reflectance, specular_reflectance;
  FloatInput exponent;
};
void add_lobes(const HairMaterial& m, ClosureBuilder& out, const SurfacePoint& at, float weight);

// A dielectric fiber (fiber_table.h), for fibers only.
struct FiberTable;
struct HairFiberMaterial {
  std::shared_ptr<const FiberTable> table;
};
void add_lobes(const HairFiberMaterial& m, ClosureBuilder& out, const SurfacePoint& at, float weight);

struct MaskMaterial {
  static constexpr bool transmits = true;
  FloatInput opacity;
  int nested;
};
void add_lobes(const MaskMaterial& m, ClosureBuilder& out, const SurfacePoint& at, float weight);

struct TwoSidedMaterial {
  int front, back;
};
void add_lobes(const TwoSidedMaterial& m, ClosureBuilder& out, const SurfacePoint& at, float weight);

struct BumpMaterial {
  int texture;
  float scale;
  int nested;
};
void add_lobes(const BumpMaterial& m, ClosureBuilder& out, const SurfacePoint& at, float weight);

struct NormalMapMaterial {
  int texture;
  float scale = 1;         // of the normal's first two components
  bool follow_uv = false;  // second axis against dp/dv where uvs are mirrored; see NormalMapDesc
  int nested = -1;
};
void add_lobes(const NormalMapMaterial& m, ClosureBuilder& out, const SurfacePoint& at, float weight);

struct TurnedTangentMaterial {
  ColorInput direction;  // these two: see TurnedTangentDesc
  float angle = 0;
  int nested = -1;
};
void add_lobes(const TurnedTangentMaterial& m, ClosureBuilder& out, const SurfacePoint& at, float weight);

struct MixtureMaterial {
  struct Part {
    FloatInput weight;
    bool complement;
    int nested;
  };
  std::vector<Part> parts;
};
void add_lobes(const MixtureMaterial& m, ClosureBuilder& out, const SurfacePoint& at, float weight);

using Material =
    std::variant<DiffuseMaterial, NullMaterial, RoughDiffuseMaterial, ConductorMaterial, DielectricMaterial,
                 ThinDielectricMaterial, PlasticMaterial, PhongMaterial, WardMaterial, PrincipledMaterial,
                 PrincipledThinMaterial, DiffuseTransmitterMaterial, MeasuredMaterial, CoatingMaterial,
                 SheenMaterial, HairMaterial, HairFiberMaterial, MaskMaterial, TwoSidedMaterial, BumpMaterial,
                 NormalMapMaterial, TurnedTangentMaterial, MixtureMaterial, SlabFaceMaterial>;

// All materials of a world with the textures that they read; nested materials come before their users.
struct MaterialSet {
  std::vector<Material> materials;
  TextureSet textures;

  // The closure at a point, for a known direction wo (which decides the side of two-sided and dielectric
  // BSDFs). A mask's transparency appears as a delta_pass lobe of weight 1 - opacity.
  Closure closure(int material, const SurfacePoint& at, Vec3f wo) const;

  // Asks memory for texels that closure() will read. Only after note_bitmaps(), when all is there.
  void fetch(int material, const SurfaceUv& uv) const {
    const auto k = static_cast<std::size_t>(material);
    if (k >= bitmaps.size()) return;
    for (const int bitmap : bitmaps[k]) textures.fetch_bitmap(bitmap, uv);
  }
  void note_bitmaps();
  std::vector<std::vector<int>> bitmaps;  // of each material: textures that are a BitmapTexture

  // What the eye sees of it: itself, or the glass of a pane.
  int seen(int material) const {
    const auto* face = std::get_if<SlabFaceMaterial>(&materials[static_cast<std::size_t>(material)]);
    return face && face->glass >= 0 ? face->glass : material;
  }

  // A BSDF of fibers: all non-delta lobes of its closures are hair lobes (Closure::is_fiber()).
  bool is_hair(int material) const;

  // Whether shadow rays may pass straight through somewhere (null, thin dielectric, mask): such geometry gets
  // a filter.
  enum class Passage {
    opaque,
    attenuating,
    cutout
  };  // attenuating: colored transmittance (goes into E); cutout: binary (into V)
  Passage passage(int material) const;
  // Straight-through transmittance along w (pointing away from the surface, to the side that decides for
  // two-sided materials): the coefficients of all delta_pass lobes, so thin dielectrics, null surfaces and 1
  // - opacity of masks.
  Rgb transmittance(int material, const SurfacePoint& at, Vec3f w) const;
  // Probability that a cut-out lets nothing through; 1 for whatever passage() does not call a cutout.
  float opacity(int material, const SurfaceUv& uv) const;
};

}  // namespace lumirank::scatter
