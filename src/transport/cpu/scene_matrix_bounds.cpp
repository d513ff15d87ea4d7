// What columns can send at most.
#include <algorithm>

#include "transport/cpu/scene_matrix_impl.h"
#include "transport/pairs/row_bounds.h"

namespace lumirank::transport {

using matrix::ColumnSet;
using matrix::Emission;
using matrix::Index;

namespace {

// Integrals of spherical lights are taken by uniform samples of the cone and by some that follow the lobes of
// either end, in the balance heuristic: a sample counts no more than one of the cone alone would, so the
// estimate is below the cone's solid angle times the greatest integrand times all samples per sample of the
// cone. At most one follows either lobe where only one end has a sharp one, and at most three each where both
// have, beside at least one in the cone: twice, or 2·3.5 = 7 times.
constexpr float kLobeSamples = 2;

bool has_sharp_lobe(const VirtualLights& lights, Index j) {
  const auto lobes = lights.closures.lobes(lights.closures.recipe(lights.closure[j]));
  return std::any_of(lobes.begin(), lobes.end(),
                     [](const scatter::Lobe& lobe) { return scatter::lobe_roughness(lobe) < 0.5f; });
}

// The radius, and what a sphere may send beyond a point: samples of lobes, and what is hidden of its disc.
void raise_by_sphere(const VirtualLights& lights, Index j, const SphereRules& rules, bool two_sided,
                     ColumnSet& set) {
  const bool matt = lights.closure[j] == VirtualLights::kLambertian;
  set.spherical = true;
  set.radius = set.min_radius = lights.radius[j];
  if (rules.strategies == SphereRules::Strategies::all) {
    if (rules.samples == SphereRules::Samples::cone) {
      set.intensity *= 3;  // as many of each kind
    } else if (!matt && has_sharp_lobe(lights, j)) {
      set.intensity *= kLobeSamples;
    }
  }
  // The light of a disc lies on the part of it that the receiver's own plane does not hide: of one-sided
  // receivers at least half, and no less than what the light sees.
  const float hidden = std::min(lights.hidden[j], two_sided ? 1.0f : 0.5f);
  set.intensity *= 1 / std::max(1 - hidden, 1e-6f);
}

}  // namespace

ColumnSet SceneMatrix::column_set(Index j) const {
  const VirtualLights& lights = impl_->lights;
  const float clamp = impl_->context.clamp;
  ColumnSet set;
  set.box.extend(lights.position[j]);
  set.direct = lights.depth[j] == 0;
  set.intensity = lights.power[j];
  switch (lights.kind[j]) {
    case LightKind::omni:
      return set;
    case LightKind::spot: {
      const SpotShape& spot = lights.spots[lights.closure[j]];
      if (spot.profile) set.intensity *= spot.profile->max_value();
      return set;
    }
    case LightKind::directional:
      set.emission = Emission::directional;
      set.cone = {-lights.normal[j], 1};
      return set;
    case LightKind::oriented:
      set.emission = Emission::oriented;
      set.cone = {lights.normal[j], 1};
      // a·G·π f_x ≤ X, so f_x·G ≤ X/(a·π).
      if (lights.area[j] > 0 && clamp < kInfinity)
        set.ceiling = set.intensity * (1.00001f * clamp * kInvPi / lights.area[j]);
      return set;
    case LightKind::surface:
      break;
  }
  const bool matt = lights.closure[j] == VirtualLights::kLambertian;
  const bool sphere = lights.spherical();
  if (!sphere && lights.area[j] > 0 && clamp < kInfinity) {
    // a·G·(π f_x)(π f_y) ≤ X with the largest channels of f_x and f_y.
    const float max_f2 = 1.00001f * clamp * kInvPi * kInvPi / lights.area[j];
    set.ceiling = set.intensity * max_f2;
    if (matt && max_component(lights.albedo[j]) > 0)
      set.ceiling *= lights.albedo[j] * (1 / max_component(lights.albedo[j]));
  }
  if (matt) {
    set.emission = Emission::oriented, set.cone = {lights.ng[j], 1};
    set.intensity *= lights.albedo[j] * kInvPi;
  } else {
    const LightPeak& peak = impl_->peaks[lights.closure[j]];
    // Near a disc the cosine does not count.
    const bool disc = sphere && impl_->settings.spheres.indicator == SphereRules::Indicator::disc;
    const bool oriented =
        peak.one_sided && (disc || max_component(peak.max_f) <= 4 * max_component(peak.max_f_cos));
    if (oriented) set.emission = Emission::oriented, set.cone = {lights.ng[j], 1};
    set.intensity *= oriented || disc ? peak.max_f : peak.max_f_cos;
  }
  if (sphere) raise_by_sphere(lights, j, impl_->settings.spheres, impl_->context.has_two_sided, set);
  return set;
}

std::unique_ptr<matrix::RowBounds> SceneMatrix::row_bounds() const {
  return std::make_unique<SceneRowBounds>(
      impl_->receivers, BoundRules{impl_->settings.spheres, impl_->settings.traced_direct_below});
}

}  // namespace lumirank::transport
