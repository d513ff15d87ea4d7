// Fresnel factors and transmittances in lanes: line by line after scatter/fresnel.h, interface.h and coat.h.
#pragma once

#include "base/lane_math.h"
#include "transport/pairs/scatter_group.h"

namespace lumirank::transport {

inline Lane saturated(Lane x) { return min(max(x, Lane{}), splat(1)); }

// scatter::fresnel_dielectric.
inline Lane fresnel_dielectric(Lane cos_i, Lane eta) {
  const Lane c = min(cos_i, splat(1));
  const Lane cos_t2 = splat(1) - (splat(1) - c * c) / (eta * eta);
  const Lane cos_t = sqrt(max(cos_t2, Lane{}));
  const Lane parallel = (eta * c - cos_t) / (eta * c + cos_t + splat(1e-20f));
  const Lane perpendicular = (c - eta * cos_t) / (c + eta * cos_t + splat(1e-20f));
  const Lane r = splat(0.5f) * (parallel * parallel + perpendicular * perpendicular);
  return select(cos_t2 > Lane{}, min(r, splat(1)), splat(1));
}

// scatter::fresnel_conductor.
inline Lane fresnel_conductor(Lane cos_i, Lane eta, Lane k) {
  const Lane c = min(cos_i, splat(1)), c2 = c * c, s2 = splat(1) - c2;
  const Lane t0 = eta * eta - k * k - s2;
  const Lane a2_plus_b2 = sqrt(t0 * t0 + splat(4) * eta * eta * k * k);
  const Lane a = sqrt(max(Lane{}, splat(0.5f) * (a2_plus_b2 + t0)));
  const Lane t1 = a2_plus_b2 + c2, t2 = splat(2) * a * c;
  const Lane perpendicular = (t1 - t2) / (t1 + t2 + splat(1e-20f));
  const Lane t3 = c2 * a2_plus_b2 + s2 * s2, t4 = t2 * s2;
  const Lane parallel = perpendicular * (t3 - t4) / (t3 + t4 + splat(1e-20f));
  return saturated(splat(0.5f) * (perpendicular + parallel));
}

inline Lane3 fresnel(scatter::FresnelKind kind, const LobeLanes& lobe, Lane cos_m) {
  switch (kind) {
    case scatter::FresnelKind::dielectric: {
      const Lane f = fresnel_dielectric(cos_m, lobe.eta);
      return {f, f, f};
    }
    case scatter::FresnelKind::conductor:
      return {fresnel_conductor(cos_m, lobe.a.x, lobe.b.x), fresnel_conductor(cos_m, lobe.a.y, lobe.b.y),
              fresnel_conductor(cos_m, lobe.a.z, lobe.b.z)};
    case scatter::FresnelKind::schlick: {
      const Lane m = saturated(splat(1) - cos_m), m2 = m * m, w = m2 * m2 * m;
      return lobe.a + (Lane3{splat(1), splat(1), splat(1)} - lobe.a) * w;
    }
    case scatter::FresnelKind::none:
      break;
  }
  return {splat(1), splat(1), splat(1)};
}

// scatter::interface_transmittance.
inline Lane interface_transmittance(const LobeLanes& lobe, Lane cos_theta) {
  const Lane s = splat(1) - fresnel_dielectric(cos_theta, lobe.eta);
  return saturated(lobe.a.x + s * (lobe.a.y + s * (lobe.a.z + s * lobe.b.x)) +
                   cos_theta * (lobe.b.y + cos_theta * lobe.b.z));
}

// scatter::coat_cosine.
inline Lane coat_cosine(const CoatLanes& coat, Lane cos_theta) {
  return sqrt(max(Lane{}, splat(1) - (splat(1) - cos_theta * cos_theta) / (coat.bend * coat.bend)));
}

// scatter::coat_passage; `inside` is coat_cosine().
inline Lane3 coat_passage(const CoatLanes& coat, Lane cos_theta, Lane inside) {
  const Lane s = splat(1) - fresnel_dielectric(cos_theta, coat.eta);
  Lane t = saturated(coat.t[0] + s * (coat.t[1] + s * (coat.t[2] + s * coat.t[3])) +
                     cos_theta * (coat.t[4] + cos_theta * coat.t[5]));
  const Lane x = (inside - coat.critical) / coat.width;
  const Lane y = sqrt(splat(1) + x * x) - x;
  t = t * sqrt(splat(1) + coat.trapped * max(Lane{}, y * y - splat(0.01f)));
  const LaneMask enters = inside > Lane{};
  t = select(enters, t, Lane{});
  const Lane way = splat(1) / select(enters, inside, splat(1));
  return {t * exp_negative(-(coat.depth.x * way)), t * exp_negative(-(coat.depth.y * way)),
          t * exp_negative(-(coat.depth.z * way))};
}

}  // namespace lumirank::transport
