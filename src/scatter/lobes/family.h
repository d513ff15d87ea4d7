// Families of lobes: each one's formulas, its bounds and what others must know of it. One table, by LobeKind;
// a family's entry is in its own file of this folder.
#pragma once

#include <cmath>

#include "scatter/closure.h"
#include "scatter/lobe.h"
#include "scatter/lobe_bound.h"

namespace lumirank::scatter {

struct AngleRange;  // bound_terms.h

// The vectorized formulas of transport/pairs/lobe_lanes.cpp. A family without one is evaluated closure by
// closure.
enum class LaneForm : std::uint8_t {
  none,
  constant,
  interfaced_diffuse,
  oren_nayar,
  microfacet_reflect,
  thin_transmit,
  phong,
  ward,
  sheen,
  disney_diffuse,
  clearcoat
};

// What a coating must know of a lobe under it (coating.cpp).
struct UnderCoat {
  enum class Sort : std::uint8_t { lost, diffuse, glossy };  // lost: next to nothing comes back to the layer
  Sort sort = Sort::lost;
  Rgb albedo{0};  // at normal incidence
  // Glossy ones alone: the albedo at 60 degrees, and the microfacets that are as wide.
  Rgb oblique_albedo{0};
  NormalDistribution distribution = NormalDistribution::beckmann;
  float alpha = 0;  // at most 1 where they are GGX or Beckmann themselves
  float width = 0;  // the same without that limit
};

// What a rough coating adds to the slopes of facets underneath.
struct Widening {
  NormalDistribution distribution;
  float scattered;  // the width added
  float operator()(float alpha) const { return std::sqrt(alpha * alpha + 0.5f * scattered * scattered); }
};

// Microfacets may send light where the macroscopic surface does not: no lobe is chosen less often than by
// this share of its color.
inline constexpr float kMinImportance = 0.05f;

// The defaults of LobeFamily: what diffuse lobes do.
float cosine_pdf(LobeView view, Vec3f wo, Vec3f wi);
bool cosine_sample(LobeView view, Vec3f wo, Vec2f u, Vec3f& wi);
Rgb color_albedo(LobeView view, Vec3f wo);
float color_importance(LobeView view, float cos_o);
float inverse_pi(const Lobe& lobe, float cos_o, float narrowest);
Rgb constant_bound(const LobeTerm& term, const AngleRange& range, CosineFactor factor);
float reach_of_alpha(const LobeTerm& term);

// Directions as in lobe.h: local, mirrored so that wo.z > 0, without the lobe's coat and sheen.
struct LobeFamily {
  // Non-delta lobes: f without the cosine, its density, a draw.
  Rgb (*value)(LobeView view, Vec3f wo, Vec3f wi) = nullptr;
  float (*pdf)(LobeView view, Vec3f wo, Vec3f wi) = cosine_pdf;
  bool (*sample)(LobeView view, Vec3f wo, Vec2f u, Vec3f& wi) = cosine_sample;
  Rgb (*albedo)(LobeView view, Vec3f wo) = quadrature_albedo;
  float (*importance)(LobeView view, float cos_o) = color_importance;
  // Delta lobes: their one direction.
  bool (*direction)(LobeView view, Vec3f wo, Vec3f& wi, Rgb& coefficient) = nullptr;

  // Bounds (lobe_bound.h): the part of f that depends on wo alone, without the color; at least scale · f over
  // it, times the cosine if asked for (refracting: without the Jacobian's denominator); how far the lobe
  // reaches from its mirror direction, about.
  float (*factor_of_wo)(const Lobe& lobe, float cos_o, float narrowest) = inverse_pi;
  Rgb (*bound)(const LobeTerm& term, const AngleRange& range, CosineFactor factor) = constant_bound;
  float (*reach)(const LobeTerm& term) = reach_of_alpha;
  // The same of a fiber, at all w whose latitudes (radians) lie between the two.
  Rgb (*fiber_bound)(const LobeTerm& term, float latitude_o, float lo, float hi,
                     CosineFactor factor) = nullptr;
  bool bound_by_cosine = false;  // the bound takes of the range the cosines alone
  bool bound_by_mirror = false;  // it takes the cosine with the mirror direction
  bool power = false;            // alpha_u is the exponent of a cosine, and multiplies its rounding

  // Least width α of a glossy lobe; none: the lobe is broad.
  float (*roughness)(const Lobe& lobe) = nullptr;
  UnderCoat (*under_coat)(LobeView view) = nullptr;  // none: lost
  void (*widen)(Lobe& lobe, const Widening& by) = nullptr;

  bool matt = false;        // without a preferred direction, on wo's side
  bool refracts = false;    // to the other side, by eta
  bool fresnel = false;     // scaled by lobe_fresnel()
  bool two_colors = false;  // conductor_eta is a second color, which takes part in all weights
  bool two_widths = false;  // alpha_u and alpha_v differ on anisotropic surfaces
  LaneForm lanes = LaneForm::none;
  bool half_vector = false;  // the lanes' formula needs it
};

extern const LobeFamily* const kLobeFamilies[kLobeKinds];
inline const LobeFamily& family_of(LobeKind kind) { return *kLobeFamilies[static_cast<int>(kind)]; }

#define LUMIRANK_DECLARE_FAMILY(name, sort) extern const LobeFamily name##_family;
LUMIRANK_LOBE_KINDS(LUMIRANK_DECLARE_FAMILY)
#undef LUMIRANK_DECLARE_FAMILY

}  // namespace lumirank::scatter
