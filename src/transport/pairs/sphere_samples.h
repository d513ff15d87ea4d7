// The integrals of 16 spherical pairs by few directions each: uniform in the cone and, where a lobe is much
// narrower than the cone, of half vectors that follow the lobe, together by the balance heuristic.
#pragma once

#include "transport/pairs/sphere_cone.h"

namespace lumirank::transport {

// How many directions each strategy gets; whole numbers. Without any of a lobe the cone's are all.
struct SphereCounts {
  Lane cone, row, column;
  LaneMask mixed;  // row or column is not 0
};

// Whether directions of the lobes of a group can be drawn in lanes.
inline bool follows_lobes(const ScatterGroup& group) {
  return group.form->in_lanes && group.form->sides == Sides::front;
}

// Half vectors distributed like the normals of GGX with the roughness of a closure's sharpest lobe: their
// tails are broad enough for lobes of all kinds. The density is rational, so drawing costs little more than
// evaluating.
class LobeSampler {
 public:
  explicit LobeSampler(const ScatterGroup& group)
      : wo_(group.wo), n_(group.n), alpha_u_(group.cones.alpha_u), alpha_v_(group.cones.alpha_v) {
    if (group.form->anisotropic) {
      s_ = group.s, t_ = group.t;
    } else {
      any_frame(n_, s_, t_);
    }
    const Lane both = alpha_u_ * alpha_v_;
    scale_ = splat(0.5f * kInvPi) / both;
    inv_u2_ = splat(1) / (alpha_u_ * alpha_u_), inv_v2_ = splat(1) / (alpha_v_ * alpha_v_);
  }
  Lane3 direction(Lane u, Lane v) const {
    Lane sine, cosine;
    sin_cos_turns(v, sine, cosine);
    const Lane slope = sqrt(u / (splat(1) - u));
    const Lane x = alpha_u_ * slope * cosine, y = alpha_v_ * slope * sine;
    const Lane3 half = n_ + s_ * x + t_ * y;
    return half * (splat(2) * dot(half, wo_) / (splat(1) + x * x + y * y)) - wo_;
  }
  // D(h)·cosθh/(4 wo·h): with H = wo + wi the length of H cancels but for a square.
  Lane density(const Lane3& wi) const {
    const Lane3 h = wo_ + wi;
    const Lane x = dot(h, s_), y = dot(h, t_), z = max(dot(h, n_), Lane{});
    const Lane a = x * x * inv_u2_ + y * y * inv_v2_ + z * z;
    return select(a > Lane{}, scale_ * dot(h, h) * z / select(a > Lane{}, a * a, splat(1)), Lane{});
  }

 private:
  Lane3 wo_, n_, s_, t_;
  Lane alpha_u_, alpha_v_, scale_, inv_u2_, inv_v2_;
};

// Sample k of n: strata in the first dimension, multiples of the golden ratio in the second, both rotated by
// what belongs to the pair and the strategy.
class Lattice {
 public:
  Lattice(LaneBits key, Lane count)
      : u_(unit_lane(key)), v_(unit_lane(mix(key ^ 0x68bc21ebu))), inv_(splat(1) / max(count, splat(1))) {}
  Lane share() const { return inv_; }  // 1 / count
  Lane u(Lane number) const { return min((number + u_) * inv_, splat(1 - 0x1p-24f)); }
  Lane v(int k) const {
    const Lane v = v_ + splat(static_cast<float>(k) * 0.618033989f);
    return v - floor(v);
  }

 private:
  Lane u_, v_, inv_;
};

inline LaneBits pair_keys(const PairExtras& extras) {
  LaneBits row, column;
  for (int k = 0; k < kLanes; ++k) row[k] = extras.row_keys[k], column[k] = extras.column_keys[k];
  return mix_pair(row, column, static_cast<std::uint32_t>(extras.spheres->seed));
}

template <std::uint16_t row_kind, ColumnKind column_kind>
struct SphereIntegrand {
  static constexpr bool scattering_row = row_kind == kRowScatter;
  static constexpr bool scattering_column = column_kind == kColumnScatterSphere;
  const RowGroup& r;
  const ColumnGroup& c;
  const PairExtras& extras;
  const SphereGeometry& at;
  Lane height, r2;
  bool discs, row_fiber, column_fiber;

  SphereIntegrand(const RowGroup& r_, const ColumnGroup& c_, const PairExtras& extras_,
                  const SphereGeometry& at_)
      : r(r_),
        c(c_),
        extras(extras_),
        at(at_),
        height(dot(c.ng, at.w)),
        r2(c.radius * c.radius),
        discs(bits(at.disc) != 0),
        row_fiber(scattering_row && extras.row_sides == Sides::fiber),
        column_fiber(scattering_column && extras.column_sides == Sides::fiber) {}

  // sum += f_x cosθx f_y I · scale() at the direction l where `wanted`, f_x or f_y left out where lambertian.
  template <typename Scale>
  void add(Lane3& sum, const Lane3& l, LaneMask wanted, Scale&& scale) const {
    const Lane zero{};
    const Lane slope = column_fiber ? fiber_sine(c.n, l) : dot(c.ng, l);
    LaneMask lit = column_fiber ? wanted : wanted & (slope * height > zero);
    if (discs) {
      const Lane3 off = l * (height / select(lit, slope, splat(1))) - at.w;
      lit &= ~at.disc | (dot(off, off) < r2);
    }
    const Lane cos_x = row_fiber ? fiber_sine(r.n, l) : dot(r.n, l);
    if constexpr (!scattering_row) lit &= (cos_x > zero) & (dot(r.ng, l) > zero);
    if constexpr (!scattering_column) lit &= dot(c.n, l) < zero;
    if (bits(lit) == 0) return;
    Lane3 f{splat(1), splat(1), splat(1)};
    if constexpr (scattering_row) f = eval_f(*extras.row, l, LaneMask{});
    if constexpr (scattering_column) f = f * eval_f(*extras.column, l * splat(-1), LaneMask{});
    const Lane weight = abs(cos_x) * select(at.disc, splat(1), abs(slope)) * scale();
    sum = sum + select(lit, f * weight, Lane3{zero, zero, zero});
  }
};

// ∫ f_x cosθx f_y I dl with f_x, f_y left out where lambertian.
template <std::uint16_t row_kind, ColumnKind column_kind>
inline Lane3 integrate_in_lanes(const RowGroup& r, const ColumnGroup& c, const PairExtras& extras,
                                const SphereGeometry& at, const ConeSampler& cone, Lane cos_max,
                                const SphereCounts& counts) {
  const Lane zero{};
  const SphereIntegrand<row_kind, column_kind> integrand(r, c, extras, at);
  const LaneBits key = pair_keys(extras);
  const Lattice lattice(key, counts.cone);
  const Lane per_direction = splat(2 * kPi) * cone.below * lattice.share();
  Lane3 sum{zero, zero, zero};
  const auto uniform = [&](auto&& scale) {
    for (int k = 0;; ++k) {
      const Lane number = splat(static_cast<float>(k));
      const LaneMask more = number < counts.cone;
      if (bits(more) == 0) break;
      const Lane3 l = cone.direction(lattice.u(number), lattice.v(k));
      integrand.add(sum, l, more, [&] { return scale(l); });
    }
  };
  if (bits(counts.mixed) == 0) {
    uniform([&](const Lane3&) { return per_direction; });
    return sum;
  }
  if constexpr (row_kind == kRowScatter || column_kind == kColumnScatterSphere) {
    // A side without lobes to follow has the other's sampler, and a count of 0.
    const LobeSampler row(row_kind == kRowScatter ? *extras.row : *extras.column);
    const LobeSampler column(column_kind == kColumnScatterSphere ? *extras.column : *extras.row);
    const Lane by_cone = splat(1) / per_direction;
    const auto scale = [&](const Lane3& l) {
      Lane density = by_cone;
      if constexpr (row_kind == kRowScatter) density += counts.row * row.density(l);
      if constexpr (column_kind == kColumnScatterSphere)
        density += counts.column * column.density(l * splat(-1));
      return select(counts.mixed, splat(1) / density, per_direction);
    };
    uniform(scale);
    const auto follow = [&](const LobeSampler& lobe, Lane count, std::uint32_t strategy, float sign) {
      const LaneBits own = mix(key ^ strategy);
      const Lattice points(own, count);
      for (int k = 0;; ++k) {
        const Lane number = splat(static_cast<float>(k));
        const LaneMask more = number < count;
        if (bits(more) == 0) break;
        const Lane3 l = lobe.direction(points.u(number), points.v(k)) * splat(sign);
        integrand.add(sum, l, more & (dot(l, cone.axis) >= cos_max), [&] { return scale(l); });
      }
    };
    if constexpr (row_kind == kRowScatter) follow(row, counts.row, 0x2545f491u, 1);
    if constexpr (column_kind == kColumnScatterSphere) follow(column, counts.column, 0x7f4a7c15u, -1);
  }
  return sum;
}

}  // namespace lumirank::transport
