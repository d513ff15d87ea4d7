#include "scatter/layered_walk.h"

#include <cmath>

#include "base/random.h"
#include "scatter/bsdf_list.h"

namespace lumirank::scatter {

std::size_t Exits::cell(Vec3f wi, Vec3f wo) {
  const int ring = std::min(kRings - 1, static_cast<int>(wi.z * wi.z * kRings));
  double phi = (std::atan2(wi.y, wi.x) - std::atan2(wo.y, wo.x)) / (2 * 3.14159265358979324) +
               0.5 / kSectors;  // the mirror direction in the middle of a sector
  phi -= std::floor(phi);
  return static_cast<std::size_t>(ring * kSectors + std::min(kSectors - 1, static_cast<int>(phi * kSectors)));
}

Exits walk(const MaterialSet& set, Vec3f wo, int particles, std::uint64_t seed) {
  const auto& coating = std::get<CoatingMaterial>(set.materials[1]);
  MaterialSet interface;
  DielectricMaterial glass;
  glass.eta = coating.eta;
  glass.specular_reflectance = glass.specular_transmittance = {Rgb(1), -1};
  glass.distribution = coating.distribution;
  glass.alpha_u = coating.alpha_u, glass.alpha_v = coating.alpha_v;
  glass.smooth = coating.smooth;
  interface.materials.push_back(glass);
  const SurfacePoint at = point_with_normal({0, 0, 1});
  const float depth = coating.absorption.value.r;

  Exits out;
  Rng rng(seed, Stage::test);
  for (int i = 0; i < particles; ++i) {
    // `from` points back to where the particle comes from.
    Vec3f from = wo;
    double energy = 1;
    bool at_base = false;
    for (int bounce = 0; bounce < 200; ++bounce) {
      const Closure closure = at_base ? set.closure(0, at, from) : interface.closure(0, at, from);
      const float u1 = rng.next_float();
      const auto s = sample(closure, from, u1, rng.next_2d(), Lobes::all, true);
      if (!s) break;
      energy *= s->weight.r;
      if (energy < 0.05) {
        if (rng.next_float() > 20 * energy) break;
        energy = 0.05;
      }
      if (!at_base && s->wi.z > 0) {  // out
        const double share = energy / particles;
        out.share[Exits::cell(s->wi, wo)] += share, out.total += share;
        break;
      }
      energy *= std::exp(-depth / std::abs(s->wi.z));
      from = -s->wi;
      at_base = !at_base;
    }
  }
  return out;
}

Exits exits_of_lobes(const MaterialSet& set, Vec3f wo, int particles, std::uint64_t seed) {
  const Closure closure = set.closure(1, point_with_normal({0, 0, 1}), wo);
  Exits out;
  Rng rng(seed, Stage::test, 1);
  for (int i = 0; i < particles; ++i) {
    const float u1 = rng.next_float();
    const auto s = sample(closure, wo, u1, rng.next_2d(), Lobes::all, true);
    if (!s) continue;
    const double share = s->weight.r / particles;
    out.share[Exits::cell(s->wi, wo)] += share, out.total += share;
  }
  return out;
}

double misplaced(const Exits& a, const Exits& b) {
  double sum = 0;
  for (std::size_t k = 0; k < a.share.size(); ++k) sum += std::abs(a.share[k] - b.share[k]);
  return 0.5 * sum;
}

}  // namespace lumirank::scatter
