#include "transport/pairs/lobe_cones.h"

#include <algorithm>
#include <cmath>

#include "scatter/lobes/family.h"

namespace lumirank::transport {
namespace {

// A reflected lobe of roughness α fills about 4πα² and ends about 3α from its axis; what is rougher than this
// counts as broad. A lobe that refracts has no axis here, so it may be anywhere.
constexpr float kBroad = 0.5f, kReach = 3;

}  // namespace

LobeCone lobe_cone(std::span<const scatter::Lobe> lobes) {
  LobeCone cone;
  float sharpest = kBroad * kBroad, reach = 0;
  bool anywhere = false;
  for (const scatter::Lobe& lobe : lobes) {
    const float min_width = scatter::lobe_roughness(lobe);
    if (min_width >= kBroad) continue;
    const bool two_widths = scatter::family_of(lobe.kind).two_widths && !scatter::shines_through(lobe.kind);
    const float wider = lobe.coat ? lobe.coat.bend : 1.0f;  // refraction into the open
    const float max_width = two_widths ? wider * std::max(lobe.alpha_u, lobe.alpha_v) : min_width;
    if (min_width * max_width < sharpest) {
      sharpest = min_width * max_width;
      const bool along_u = two_widths && lobe.alpha_u > lobe.alpha_v;
      cone.alpha_u = along_u ? max_width : min_width, cone.alpha_v = along_u ? min_width : max_width;
    }
    reach = std::max(reach, std::min(kPi, kReach * max_width));
    anywhere = anywhere || scatter::shines_through(lobe.kind) || scatter::is_hair(lobe.kind);
  }
  if (anywhere) reach = kPi;
  cone.per_solid_angle = reach > 0 ? 1 / (4 * kPi * sharpest) : 0;
  cone.cos_reach = std::cos(reach), cone.sin_reach = std::sin(reach);
  return cone;
}

std::vector<LobeCone> lobe_cones(const scatter::ClosurePool& pool) {
  std::vector<LobeCone> cones;
  cones.reserve(pool.recipes());
  for (std::uint32_t recipe = 0; recipe < pool.recipes(); ++recipe)
    cones.push_back(lobe_cone(pool.lobes(recipe)));
  return cones;
}

}  // namespace lumirank::transport
