// Upper bounds of f, and of f times the cosine, of a closure for light from anywhere within a cone: for
// methods that refine until what they leave out cannot matter (light cuts).
//
// Bounds are per channel and never below what eval_f() gives, whether in scalars or in lanes. They are tight
// for small cones: the half vector of wo and w moves by at most angle/(2·cos(d/2)) when w does, d being the
// angle between wo and w, so normal distributions are taken at the least angle that the half vector can have
// (to the same end Walter et al. 2005, section 4.1, use cube maps). What tangents decide is bounded over all
// of them.
#pragma once

#include <array>
#include <span>

#include "scatter/closure.h"

namespace lumirank::scatter {

struct DirectionCone {
  Vec3f axis{0, 0, 1};  // unit, away from the surface
  float angle = kPi;    // radians; π and more: all directions
};

// What is multiplied with f.
enum class CosineFactor : std::uint8_t { none, cosine };

struct ConeWidth;  // lobes/bound_terms.h

// One lobe at one wo. Under a coat, directions and cosines are those inside.
struct LobeTerm {
  const Lobe* lobe;
  Rgb scale;      // what does not depend on w
  Rgb at_normal;  // microfacets: Fresnel reflectance at right angles; oren_nayar: the other color
  Vec3f wo;
  float cos_o, eta, roughness;
  float widest, narrowest;  // of alpha_u and alpha_v
};

// The non-delta lobes of one closure at one wo, prepared for many cones. Refers to the lobes that it was
// given.
class ClosureBound {
 public:
  ClosureBound() = default;
  // `n` is the shading normal on either side, `tangent` the fiber's direction where it is one; colors: of the
  // lobes, instead of their own, if any; `outside`: whether wo is on the closure's outer side; `adjoint` as
  // in eval_f().
  ClosureBound(std::span<const Lobe> lobes, std::span<const Rgb> colors, Vec3f n, Vec3f tangent, Vec3f wo,
               bool outside, bool adjoint = false);
  explicit ClosureBound(const Closure& closure, Vec3f wo, bool adjoint = false);

  // At least eval_f(closure, wo, w, adjoint), times closure.cosine(w) if asked for, for all unit w in the
  // cone. Lobes with a roughness below `sharp` are left out.
  Rgb within(const DirectionCone& cone, CosineFactor factor, float sharp = 0) const;
  // The same for all directions, tighter than a cone of π: rings about the mirror direction are bounded one
  // by one.
  Rgb anywhere(CosineFactor factor, float sharp = 0) const;
  bool black() const { return count_ == 0; }

 private:
  void add(const Lobe& lobe, Rgb color, bool adjoint);
  Rgb on_fiber(const LobeTerm& term, const DirectionCone& cone, CosineFactor factor) const;
  Rgb reflected(const LobeTerm& term, const DirectionCone& cone, const ConeWidth& width, float cos_lo,
                float cos_hi, CosineFactor factor) const;
  Rgb refracted(const LobeTerm& term, const DirectionCone& cone, float cos_lo, float cos_hi,
                CosineFactor factor) const;
  Rgb through_sheet(const LobeTerm& term, const DirectionCone& cone, const ConeWidth& width, float cos_lo,
                    float cos_hi, CosineFactor factor) const;
  Rgb in_rings(const LobeTerm& term, CosineFactor factor) const;
  // What a coat does where light crosses it at w, beyond what is in the scale.
  float crossed(const LobeTerm& term, float cos_lo) const;

  std::array<LobeTerm, kMaxLobes> terms_;
  int count_ = 0;
  Vec3f n_{0, 0, 1}, wo_{0, 0, 1};  // n on the side of wo; on a fiber its direction
  float cos_o_ = 1;
  bool outside_ = true, fiber_ = false, through_ = false;  // through_: some lobe shines through
};

}  // namespace lumirank::scatter
