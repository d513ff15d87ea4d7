// Closure: how a surface scatters light at one point, a short sum of lobes with all textures already looked
// up.
//
// Every BSDF of a scene (scatter/material.h) becomes such a closure at a hit. The path tracer samples
// closures; the lighting matrix evaluates them in bulk. Because a closure is plain data, one evaluation code
// serves both.
//
// Directions are in world space and point away from the surface. `wo` is the side that is known first
// (towards the eye at a receiver, towards the previous vertex at a virtual light), `wi` the other one.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <type_traits>

#include "base/frame.h"
#include "base/rgb.h"
#include "base/vec.h"

namespace lumirank::scatter {

// A lobe acts alike on both sides of the surface: a one-sided material makes no lobes where wo is on its
// back. Formulas give f (without the cosine of wi); cos_o, cos_i > 0 are the cosines of wo and wi with
// frame.n, m = normalize(wo + wi).
//
// A family of lobes is a file in lobes/ and a line here: its name, and how it stands to the surface.
enum class LobeSort : std::uint8_t {
  reflects,        // non-delta, on wo's side
  shines_through,  // non-delta, to the other side
  fiber,  // non-delta, of a fiber along frame.s whatever the side; stands with no other non-delta lobes
  delta_reflects,  // delta lobes ("specular"): eval and pdf are 0, only sample() and delta_continuations()
                   // meet them
  delta_through,
};
// clang-format off
#define LUMIRANK_LOBE_KINDS(KIND)                                                                               \
  /* color/π */                                                                                                 \
  KIND(diffuse, reflects)                                                                                       \
  /* alpha_u = σ (radians); color = ρ, conductor_eta = ρ² (interreflection) */                                  \
  KIND(oren_nayar, reflects)                                                                                    \
  /* Plastic's base: color/π · T(cos_i) · T(cos_o), T = interface_transmittance() in interface.h: six           \
     coefficients in conductor_eta and conductor_k, and eta. color has                                          \
     ρ/(eta²·(1 - internal reflectance[·ρ])) multiplied in; alpha_v = 2∫T(μ)μ dμ (for the albedo only) */       \
  KIND(interfaced_diffuse, reflects)                                                                            \
  /* color · F(wo·m) · D(m) · G1(wo) · G1(wi) / (4 cos_o cos_i), D and G1 as in microfacet.h with alpha_u,      \
     alpha_v; F by `fresnel` */                                                                                 \
  KIND(microfacet_reflect, reflects)                                                                            \
  /* Rough dielectric's refraction (radiance from wi to wo) */                                                  \
  KIND(microfacet_transmit, shines_through)                                                                     \
  /* color · (n+2)/(2π) · cosⁿ(angle to the mirror direction), alpha_u = exponent */                            \
  KIND(phong, reflects)                                                                                         \
  /* color, alpha_u, alpha_v; variant 0 ward, 1 ward-duer, 2 balanced */                                        \
  KIND(ward, reflects)                                                                                          \
  /* Disney's: color · (1 - wi·m)⁵ */                                                                           \
  KIND(sheen, reflects)                                                                                         \
  /* Cloth, alpha_u = α */                                                                                      \
  KIND(charlie_sheen, reflects)                                                                                 \
  /* Disney's with retro-reflection; alpha_u = roughness, extra = flatness */                                   \
  KIND(disney_diffuse, reflects)                                                                                \
  /* Disney's: color · F · D · G with GTR1 of width alpha_u */                                                  \
  KIND(clearcoat, reflects)                                                                                     \
  /* A table of measurements: color · f; alpha_u is the width of what is drawn */                               \
  KIND(measured, reflects)                                                                                      \
  /* Through thin sheets, unbent; eta is that of the sheet from either side: color/π */                         \
  KIND(diffuse_transmit, shines_through)                                                                        \
  /* ... and microfacet_reflect with wi mirrored to wo's side and 1 - F instead of F */                         \
  KIND(thin_transmit, shines_through)                                                                           \
  /* color/π² */                                                                                                \
  KIND(hair_diffuse, fiber)                                                                                     \
  /* Kajiya and Kay's, normalized; alpha_u = exponent, alpha_v = hair_specular_scale() */                       \
  KIND(hair_specular, fiber)                                                                                    \
  /* color · one part of what a dielectric fiber scatters: `variant` of `table` (fiber_table.h) */              \
  KIND(hair_fiber, fiber)                                                                                       \
  /* color · F by `fresnel`; of sheets sheet_reflectance() */                                                    \
  KIND(delta_reflect, delta_reflects)                                                                           \
  /* color · (1 - F), refracts by eta */                                                                        \
  KIND(delta_transmit, delta_through)                                                                           \
  /* Goes straight on: null surfaces, cut-outs: color; of sheets color · (1 - sheet_reflectance()) */           \
  KIND(delta_pass, delta_through)
// clang-format on

#define LUMIRANK_LOBE_NAME(name, sort) name,
enum class LobeKind : std::uint8_t { LUMIRANK_LOBE_KINDS(LUMIRANK_LOBE_NAME) };
#undef LUMIRANK_LOBE_NAME

#define LUMIRANK_LOBE_SORT(name, sort) LobeSort::sort,
inline constexpr LobeSort kLobeSorts[] = {LUMIRANK_LOBE_KINDS(LUMIRANK_LOBE_SORT)};
#undef LUMIRANK_LOBE_SORT
inline constexpr int kLobeKinds = sizeof kLobeSorts / sizeof kLobeSorts[0];

inline LobeSort sort_of(LobeKind kind) { return kLobeSorts[static_cast<int>(kind)]; }
inline bool is_delta(LobeKind kind) { return sort_of(kind) >= LobeSort::delta_reflects; }
inline bool is_hair(LobeKind kind) { return sort_of(kind) == LobeSort::fiber; }
inline bool shines_through(LobeKind kind) { return sort_of(kind) == LobeSort::shines_through; }

enum class FresnelKind : std::uint8_t { none, dielectric, conductor, schlick };
enum class NormalDistribution : std::uint8_t { beckmann, ggx };

// Variants of delta lobes that let light pass unbent: a thin slab as a whole, and one face of a slab that has
// two (sheet_reflectance() in fresnel.h).
inline constexpr std::uint8_t kThinSlab = 1, kSlabFace = 2;

// A dielectric layer over a lobe, as seen from outside (coat.h). 52 bytes.
struct Coat {
  float eta = 0;                    // index of the layer over that of the outside; 0: there is no layer
  float bend = 1;                   // index by which directions are bent: eta where the layer covers all
  float t[6] = {0, 1, 0, 0, 0, 0};  // coefficients of its transmittance, as in interface.h
  Rgb depth{0};                     // optical thickness: absorption coefficient times thickness
  float trapped = 0, width = 1;     // glossy lobes: see coat_return()
  explicit operator bool() const { return eta > 0; }
  friend bool operator==(const Coat&, const Coat&) = default;
};

// Sheen over a lobe (charlie_sheen.h), in 65535ths to be small; the share is rounded up.
struct SheenLayer {
  std::uint16_t share = 0;  // the largest channel of the sheen's color; 0: there is no sheen
  std::uint16_t roughness = 0;
  SheenLayer() = default;
  SheenLayer(float share_, float roughness_)
      : share(static_cast<std::uint16_t>(std::min(65535.0f, std::ceil(share_ * 65535)))),
        roughness(static_cast<std::uint16_t>(roughness_ * 65535 + 0.5f)) {}
  float share_value() const { return static_cast<float>(share) / 65535; }
  float roughness_value() const { return static_cast<float>(roughness) / 65535; }
  explicit operator bool() const { return share > 0; }
  friend bool operator==(const SheenLayer&, const SheenLayer&) = default;
};

// What a family keeps per material beyond numbers. Each family knows its own.
struct LobeTable {};

// Plain data; which fields mean something depends on `kind`. 120 bytes.
struct Lobe {
  LobeKind kind = LobeKind::diffuse;
  FresnelKind fresnel = FresnelKind::none;
  NormalDistribution distribution = NormalDistribution::ggx;
  std::uint8_t variant = 0;  // ward's variant; kThinSlab or kSlabFace for delta lobes of sheets
  Rgb color{0};              // reflectance or scale, mixture weights multiplied in
  float alpha_u = 0, alpha_v = 0;
  float eta = 1;                         // inside over outside, for wo on the outside
  Rgb conductor_eta{0}, conductor_k{0};  // conductor; schlick: conductor_eta is F0
  float extra = 0;                       // disney_diffuse: flatness
  Coat coat;                             // over this lobe, if any
  SheenLayer sheen_layer;                // the same; between the lobe and the coat
  const LobeTable* table =
      nullptr;  // of measured kinds: what their material holds, which outlives the closure
};

inline constexpr int kMaxLobes = 8;

// Least roughness alpha of a lobe (Phong's exponent n → √(2/(n+2)); under a coat as it looks from outside); 1
// for diffuse ones, 0 for delta lobes.
float lobe_roughness(const Lobe& lobe);

struct Closure {
  Frame frame;        // shading frame; frame.n on the outside (towards wo if two-sided)
  Vec3f ng{0, 0, 1};  // geometric normal, in the hemisphere of frame.n; zero on a fiber
  int count = 0;
  // Those beyond `count` are not made: a closure is built and copied at every vertex of every path.
  union {
    Lobe lobes[kMaxLobes];
  };

  Closure() {}  // NOLINT: the lobes are left alone
  Closure(const Closure& o) : frame(o.frame), ng(o.ng), count(o.count) { copy_lobes(o); }
  Closure& operator=(const Closure& o) {
    frame = o.frame, ng = o.ng, count = o.count;
    copy_lobes(o);
    return *this;
  }

  void add(const Lobe& lobe);  // ignored if its color is black; throws InternalError when full
  bool empty() const { return count == 0; }
  bool has_non_delta() const;  // any lobe that is not delta
  bool has_delta() const;
  // A thin fiber along frame.s instead of a surface: it has no sides, light arrives and leaves all around,
  // and wherever a surface has the cosine of the normal, a fiber has the sine of the angle to frame.s (its
  // width as light sees it). frame.n is any normal.
  bool is_fiber() const;
  // |cos(w, n)|, or of a fiber the sine.
  float cosine(Vec3f w) const;
  // n and ng agree about the side of w; on a fiber always.
  bool sides_agree(Vec3f w) const;
  // The only non-delta lobe is `diffuse` (delta lobes may stand beside it).
  bool is_lambertian() const;
  Rgb diffuse_color() const;  // of the diffuse lobe of a lambertian closure: its reflectance
  // Least roughness alpha of a glossy lobe (Phong's exponent n → √(2/(n+2))); 1 if all are diffuse, 0 if all
  // are delta lobes.
  float roughness() const;

 private:
  void copy_lobes(const Closure& o) { std::copy_n(o.lobes, o.count, lobes); }
};
static_assert(std::is_trivially_copyable_v<Lobe>);

// The non-delta lobes with roughness below `limit` (sharp) or the other non-delta ones (broad).
Closure sharp_part(const Closure& closure, float limit);
Closure broad_part(const Closure& closure, float limit);
// With its non-delta lobes of a roughness below `least` widened to that (regularized, as in Kaplanyan and
// Dachsbacher 2013, section 4), and scaled so that of what arrives from wo as much is scattered. Tables of
// measurements, clear coats and fibers stay as they are.
Closure widened(const Closure& closure, Vec3f wo, float least);

// Turns a shading normal that faces away from wo, although the surface faces it, until it faces wo: at the
// silhouettes of coarse meshes with smooth normals, and in steep bumps, nothing would be seen otherwise. For
// closures that the eye sees.
void face_viewer(Closure& closure, Vec3f wo);

// Which half of the closure a caller wants.
enum class Lobes : std::uint8_t { non_delta, delta, all };

// Σ f(wo, wi)·cosine(wi) of the non-delta lobes, per steradian. 0 where wi and wo lie on sides that disagree
// between the shading and the geometric normal (no light leaks). Radiance flows from wi to wo; with
// `adjoint`, from wo to wi, as at a virtual light (it matters to refraction only, where the two differ by
// eta²).
Rgb eval(const Closure& closure, Vec3f wo, Vec3f wi, bool adjoint = false);
// The same without the cosine: f alone.
Rgb eval_f(const Closure& closure, Vec3f wo, Vec3f wi, bool adjoint = false);
// Solid-angle density with which sample(…, Lobes::non_delta or all) draws wi among the non-delta lobes. With
// Lobes::all the probability of choosing the non-delta lobes at all is included.
float pdf(const Closure& closure, Vec3f wo, Vec3f wi, Lobes which);

struct BsdfSample {
  Vec3f wi;
  Rgb weight;     // f·cosine/pdf, or the delta lobe's coefficient over its probability
  float pdf = 0;  // solid-angle density; for a delta lobe its discrete probability
  bool delta = false;
  bool transmitted = false;
  LobeKind kind = LobeKind::diffuse;
  float eta = 1;  // relative index crossed (1 unless refracted); for radiance scaling in Russian roulette
};
// u1 chooses the lobe, u2 the direction. Empty if nothing is left to sample (absorbed).
// Radiance transport: refraction scales by 1/eta² when `adjoint` is false; particles pass adjoint = true.
std::optional<BsdfSample> sample(const Closure& closure, Vec3f wo, float u1, Vec2f u2, Lobes which,
                                 bool adjoint = false);

// One delta lobe followed deterministically: direction and coefficient (not divided by any probability).
struct DeltaContinuation {
  Vec3f wi;
  Rgb weight;
  LobeKind kind;
  float eta = 1;
};
// All delta continuations at wo (at most kMaxLobes, total internal reflection resolved); returns how many.
int delta_continuations(const Closure& closure, Vec3f wo, DeltaContinuation out[kMaxLobes + 1],
                        bool adjoint = false);

// Directional albedo at wo (energy, so without the scaling of radiance), delta lobes included, at most 1:
// exact for diffuse, plastic's base and delta lobes, otherwise by a table or a rule of 55 fixed draws (to
// about 0.03). For Russian roulette and AOVs.
Rgb albedo(const Closure& closure, Vec3f wo);
// The same within 0.12, in a quarter of the time: for ratios of it, and as a feature.
Rgb rough_albedo(const Closure& closure, Vec3f wo);

// Factor by which a particle's throughput must be multiplied beside sample(…, adjoint)'s weight where the
// shading normal is not the geometric one: |wo·ns||wi·ng| / (|wo·ng||wi·ns|) (Veach 1997, section 5.3). wo:
// where the particle came from; wi: where it goes. 1 on a fiber.
float shading_correction(const Closure& closure, Vec3f wo, Vec3f wi);

}  // namespace lumirank::scatter
