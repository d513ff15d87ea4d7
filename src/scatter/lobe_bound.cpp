// The geometry of bounds: which angles a cone of directions leaves open. What lobes make of them is in
// lobes/, family by family.
#include "scatter/lobe_bound.h"

#include <algorithm>
#include <cmath>

#include "scatter/coat.h"
#include "scatter/lobe.h"
#include "scatter/lobes/bound_terms.h"
#include "scatter/lobes/charlie_sheen.h"
#include "scatter/lobes/family.h"

namespace lumirank::scatter {
namespace {

constexpr float kGrazingBound = 1e-6f;  // as in eval_f()
// Evaluation in floats, and in lanes with their own exponentials.
constexpr float kRounding = 1.0005f;

float cos_sum(Angle a, Angle b) { return a.cosine * b.cosine - a.sine * b.sine; }
float cos_difference(Angle a, Angle b) { return a.cosine * b.cosine + a.sine * b.sine; }

// Cosines with the normal of directions in a cone about one at the angle theta from it; false if all are
// behind.
bool cosines(Angle theta, const ConeWidth& width, float& lo, float& hi) {
  hi = theta.cosine >= width.whole.cosine ? 1.0f : cos_difference(theta, width.whole) + kAngleSlack;
  // Not beyond a quarter turn: there both the cosine's sign and its size would mislead.
  lo = theta.cosine > 0 && width.whole.cosine > 0 ? std::max(0.0f, cos_sum(theta, width.whole) - kAngleSlack)
                                                  : 0.0f;
  hi = std::min(hi, 1.0f);
  return hi > 0;
}

float angle_of(float cosine) { return std::acos(std::clamp(cosine, -1.0f, 1.0f)); }

// Precise near the fiber too.
float latitude(Vec3f w, Vec3f fiber) { return std::atan2(dot(w, fiber), length(cross(w, fiber))); }

// Where w is on the side of wo and within a cone about a.
AngleRange range_about(Vec3f n, const LobeTerm& t, Vec3f a, const ConeWidth& width, float cos_lo,
                       float cos_hi) {
  AngleRange r;
  r.cos_lo = cos_lo, r.cos_hi = cos_hi;
  const Vec3f h = t.wo + a;
  const float len = length(h), hz = dot(h, n);
  const Angle half = Angle::of_cosine(0.5f * len);
  // Above the horizon |wo + w| is no less than the sum of the cosines.
  const float min_half = 0.5f * (t.cos_o + cos_lo);
  float half_lo = width.half.cosine > 0 ? std::max(0.0f, cos_sum(half, width.half) - kAngleSlack) : 0.0f;
  r.half_lo = std::max(half_lo, min_half);
  if (dot(a, n) >= 0) half_lo = r.half_lo;
  const float turn = 0.5f * (width.angle + kAngleSlack) / std::max(half_lo, 1e-6f) + kAngleSlack;
  if (turn < kPi / 2 && len > 1e-6f) {
    const Angle tilt{length(h - n * hz) / len, hz / len}, by = Angle::of(turn);
    if (tilt.cosine < by.cosine) {
      r.tilt_cos = std::max(0.0f, cos_difference(tilt, by));
      r.tilt_sin = r.tilt_cos > 0 ? tilt.sine * by.cosine - tilt.cosine * by.sine : 1.0f;
    }
    if (tilt.cosine > by.sine) r.max_tilt_sin = std::min(1.0f, tilt.sine * by.cosine + tilt.cosine * by.sine);
  }
  if (family_of(t.lobe->kind).bound_by_mirror) {
    const float off = 2 * std::asin(std::min(1.0f, 0.5f * length(a - n * (2 * t.cos_o) + t.wo)));
    r.cos_mirror = std::cos(std::clamp(off - width.angle - kAngleSlack, 0.0f, kPi));
  }
  return r;
}

// Where w is on the side of wo, between two angles from its mirror direction.
AngleRange ring(const LobeTerm& t, float from, float to) {
  AngleRange r;
  const float theta = angle_of(t.cos_o);
  const float min_angle = std::max({0.0f, theta - to - kAngleSlack, from - theta - kAngleSlack});
  const float max_angle = theta + to + kAngleSlack;
  r.cos_hi = std::cos(std::min(min_angle, kPi / 2)),
  r.cos_lo = max_angle < kPi / 2 ? std::cos(max_angle) : 0.0f;
  const float half = theta + 0.5f * to + kAngleSlack;
  r.half_lo = std::max(half < kPi / 2 ? std::cos(half) : 0.0f, 0.5f * (t.cos_o + r.cos_lo));
  // Tilting the half vector by δ turns w by 2δ at most.
  const Angle tilt = Angle::of(std::clamp(0.5f * from - kAngleSlack, 0.0f, kPi / 2));
  r.tilt_sin = tilt.sine, r.tilt_cos = std::max(0.0f, tilt.cosine);
  r.cos_mirror = std::cos(std::max(0.0f, from - kAngleSlack));
  return r;
}

// Bounds under a coat: `inside` are the angles there, the cosines those outside.
Rgb under_coat(const LobeTerm& t, const AngleRange& inside, float cos_hi, CosineFactor factor) {
  const auto bound = family_of(t.lobe->kind).bound;
  Rgb max_f = bound(t, inside, CosineFactor::none);
  if (factor == CosineFactor::none) return max_f;
  max_f *= cos_hi;
  // In a denser layer the cosine inside is the larger one.
  if (t.lobe->coat.bend >= 1) {
    const Rgb other = bound(t, inside, CosineFactor::cosine);
    for (int c = 0; c < 3; ++c) max_f[c] = std::min(max_f[c], other[c]);
  }
  return max_f;
}

}  // namespace

ClosureBound::ClosureBound(const Closure& closure, Vec3f wo, bool adjoint)
    : ClosureBound({closure.lobes, static_cast<std::size_t>(closure.count)}, {}, closure.frame.n,
                   closure.frame.s, wo, dot(closure.frame.n, wo) > 0, adjoint) {}

ClosureBound::ClosureBound(std::span<const Lobe> lobes, std::span<const Rgb> colors, Vec3f n, Vec3f tangent,
                           Vec3f wo, bool outside, bool adjoint)
    : n_(n), wo_(wo), outside_(outside) {
  for (const Lobe& lobe : lobes) fiber_ = fiber_ || is_hair(lobe.kind);
  if (fiber_) {
    n_ = tangent;
    cos_o_ = length(cross(n_, wo));
  } else {
    if (dot(n_, wo) < 0) n_ = -n_;
    cos_o_ = dot(n_, wo);
  }
  if (!(cos_o_ > kGrazingBound)) return;
  for (std::size_t k = 0; k < lobes.size(); ++k)
    if (!is_delta(lobes[k].kind)) add(lobes[k], colors.empty() ? lobes[k].color : colors[k], adjoint);
}

void ClosureBound::add(const Lobe& lobe, Rgb color, bool adjoint) {
  const LobeFamily& family = family_of(lobe.kind);
  LobeTerm t;
  t.lobe = &lobe, t.wo = wo_, t.cos_o = cos_o_, t.roughness = lobe_roughness(lobe);
  t.eta = view_from(lobe, outside_).eta;
  t.widest = std::max(lobe.alpha_u, lobe.alpha_v), t.narrowest = std::min(lobe.alpha_u, lobe.alpha_v);
  // Of a grazing cosine few digits are left.
  Rgb factor(kRounding * (1 + 4e-7f / cos_o_));
  // And what a power makes of a cosine's last digit.
  if (family.power) factor *= 1 + 6e-7f * lobe.alpha_u;
  if (lobe.coat) {
    const Coat& coat = lobe.coat;
    const bool once = transmits(lobe.kind);
    if (!once) {
      const float inside = coat_cosine(coat, cos_o_);
      if (!(inside > 0)) return;
      t.wo = wo_ * (1 / coat.bend) + n_ * (inside - cos_o_ / coat.bend), t.cos_o = inside;
      factor *= 1 / (coat.bend * coat.bend);
    }
    if (!once || outside_) factor *= coat_passage(coat, cos_o_);
    // At w it is crossed straight through at the least.
    if (!once || !outside_)
      for (int c = 0; c < 3; ++c) factor[c] *= std::exp(-coat.depth[c]);
  }
  if (lobe.sheen_layer) factor *= sheen_layer_factor(lobe.sheen_layer, t.cos_o);
  // Radiance is that much denser on the far side; see microfacet_transmit_value().
  if (adjoint && family.refracts) factor *= t.eta * t.eta;
  factor *= family.factor_of_wo(lobe, t.cos_o, t.narrowest);
  t.scale = color * factor;
  if (family.fresnel) t.at_normal = lobe_fresnel({lobe, t.eta, outside_}, 1);
  if (family.two_colors) t.at_normal = lobe.conductor_eta * factor;
  if (is_black(t.scale) && is_black(t.at_normal)) return;
  through_ = through_ || shines_through(lobe.kind);
  terms_[static_cast<std::size_t>(count_++)] = t;
}

float ClosureBound::crossed(const LobeTerm& t, float cos_lo) const {
  const Coat& coat = t.lobe->coat;
  if (!coat || !(coat.trapped > 0) || (transmits(t.lobe->kind) && outside_)) return 1;
  return coat_return(coat, coat_cosine(coat, cos_lo));
}

Rgb ClosureBound::on_fiber(const LobeTerm& t, const DirectionCone& cone, CosineFactor factor) const {
  const float about = latitude(cone.axis, n_);
  return family_of(t.lobe->kind)
      .fiber_bound(t, latitude(wo_, n_), std::max(-kPi / 2, about - cone.angle - kAngleSlack),
                   std::min(kPi / 2, about + cone.angle + kAngleSlack), factor);
}

Rgb ClosureBound::reflected(const LobeTerm& t, const DirectionCone& cone, const ConeWidth& width,
                            float cos_lo, float cos_hi, CosineFactor factor) const {
  const Coat& coat = t.lobe->coat;
  if (!coat) {
    const LobeFamily& family = family_of(t.lobe->kind);
    if (!family.bound_by_cosine)
      return family.bound(t, range_about(n_, t, cone.axis, width, cos_lo, cos_hi), factor);
    AngleRange r;
    r.cos_lo = cos_lo, r.cos_hi = cos_hi;
    return family.bound(t, r, factor);
  }
  const float inside_lo = coat_cosine(coat, cos_lo), inside_hi = coat_cosine(coat, cos_hi);
  const float cosine = dot(cone.axis, n_);
  AngleRange r;
  if (coat.bend >= 1 && cosine > 0) {
    // Refraction into the denser medium brings directions closer together by its index at least.
    const Vec3f a = cone.axis * (1 / coat.bend) + n_ * (coat_cosine(coat, cosine) - cosine / coat.bend);
    r = range_about(n_, t, a, ConeWidth(cone.angle / coat.bend + kAngleSlack), inside_lo, inside_hi);
  } else {
    r.cos_lo = inside_lo, r.cos_hi = inside_hi, r.half_lo = 0.5f * (t.cos_o + inside_lo);
  }
  return under_coat(t, r, cos_hi, factor) * crossed(t, cos_lo);
}

Rgb ClosureBound::refracted(const LobeTerm& t, const DirectionCone& cone, float cos_lo, float cos_hi,
                            CosineFactor factor) const {
  AngleRange r;
  r.cos_lo = cos_lo, r.cos_hi = cos_hi;
  // The half vector of refraction, wo + eta·w, is in a ball about that of the axis. Its length to the square
  // is the Jacobian's denominator; nothing below 1e-16 is answered.
  const Vec3f h = t.wo + cone.axis * t.eta;
  const float len = length(h), reach = t.eta * (cone.angle + kAngleSlack) + kAngleSlack, hz = dot(h, n_);
  if (reach < len) {
    const float tilt = std::atan2(length(h - n_ * hz), std::abs(hz)) - std::asin(reach / len) - kAngleSlack;
    const Angle min_tilt = Angle::of(std::max(0.0f, tilt));
    r.tilt_sin = min_tilt.sine, r.tilt_cos = std::max(0.0f, min_tilt.cosine);
  }
  const float min_length = std::max({len - reach, std::abs(t.eta - 1) - kAngleSlack, 1e-8f});
  return family_of(t.lobe->kind).bound(t, r, factor) * (crossed(t, cos_lo) / (min_length * min_length));
}

Rgb ClosureBound::through_sheet(const LobeTerm& t, const DirectionCone& cone, const ConeWidth& width,
                                float cos_lo, float cos_hi, CosineFactor factor) const {
  const LobeFamily& family = family_of(t.lobe->kind);
  AngleRange r;
  r.cos_lo = cos_lo, r.cos_hi = cos_hi;
  if (!family.bound_by_cosine)
    r = range_about(n_, t, cone.axis - n_ * (2 * dot(cone.axis, n_)), width, cos_lo, cos_hi);
  return family.bound(t, r, factor) * crossed(t, cos_lo);
}

Rgb ClosureBound::within(const DirectionCone& cone, CosineFactor factor, float sharp) const {
  Rgb sum(0);
  if (count_ == 0) return sum;
  const ConeWidth width(cone.angle);
  const Angle theta = Angle::of_cosine(dot(cone.axis, n_));
  float lo = 0, hi = 0, behind_lo = 0, behind_hi = 0;
  const bool before = !fiber_ && cosines(theta, width, lo, hi);
  const bool behind = through_ && cosines({theta.sine, -theta.cosine}, width, behind_lo, behind_hi);
  for (int k = 0; k < count_; ++k) {
    const LobeTerm& t = terms_[static_cast<std::size_t>(k)];
    if (t.roughness < sharp) continue;
    if (fiber_) {
      sum += on_fiber(t, cone, factor);
    } else if (!shines_through(t.lobe->kind)) {
      if (before) sum += reflected(t, cone, width, lo, hi, factor);
    } else if (behind) {
      sum += family_of(t.lobe->kind).refracts ? refracted(t, cone, behind_lo, behind_hi, factor)
                                              : through_sheet(t, cone, width, behind_lo, behind_hi, factor);
    }
  }
  return sum;
}

Rgb ClosureBound::in_rings(const LobeTerm& t, CosineFactor factor) const {
  const LobeFamily& family = family_of(t.lobe->kind);
  const Coat& coat = t.lobe->coat;
  const bool within = coat && !transmits(t.lobe->kind);
  Rgb max_f(0);
  float from = 0;
  for (float to = family.reach(t); from < kPi; to *= 2) {
    if (to > 2) to = kPi;
    const AngleRange r = ring(t, from, to);
    float cos_lo = r.cos_lo, cos_hi = r.cos_hi;
    if (within) {
      const auto outside = [&](float c) {
        return std::sqrt(std::max(0.0f, square(coat.bend * c) - (square(coat.bend) - 1)));
      };
      cos_lo = outside(cos_lo), cos_hi = std::min(1.0f, outside(cos_hi) + 1e-6f);
    }
    const Rgb here =
        (within ? under_coat(t, r, cos_hi, factor) : family.bound(t, r, factor)) * crossed(t, cos_lo);
    for (int c = 0; c < 3; ++c) max_f[c] = std::max(max_f[c], here[c]);
    from = to;
  }
  return max_f;
}

Rgb ClosureBound::anywhere(CosineFactor factor, float sharp) const {
  Rgb sum(0);
  for (int k = 0; k < count_; ++k) {
    const LobeTerm& t = terms_[static_cast<std::size_t>(k)];
    if (t.roughness < sharp) continue;
    if (fiber_) {
      sum += on_fiber(t, {n_, kPi}, factor);
    } else if (family_of(t.lobe->kind).refracts) {
      sum += refracted(t, {-n_, kPi}, 0, 1, factor);
    } else {
      sum += in_rings(t, factor);
    }
  }
  return sum;
}

}  // namespace lumirank::scatter
