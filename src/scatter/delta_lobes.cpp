// Mirrors, smooth glass and what lets light straight through.
#include "scatter/charlie_sheen.h"
#include "scatter/fresnel.h"
#include "scatter/lobe.h"

namespace lumirank::scatter {

bool bare_delta_direction(LobeView view, Vec3f wo, Vec3f& wi, Rgb& coefficient) {
  const Lobe& lobe = view.lobe;
  const bool thin = lobe.variant == kThinSlab;
  switch (lobe.kind) {
    case LobeKind::delta_reflect: {
      wi = {-wo.x, -wo.y, wo.z};
      coefficient = lobe.color *
                    (thin ? Rgb(fresnel_thin(fresnel_dielectric(wo.z, lobe.eta))) : lobe_fresnel(view, wo.z));
      break;
    }
    case LobeKind::delta_transmit: {
      float cos_t;
      const float f = fresnel_dielectric(wo.z, view.eta, &cos_t);
      if (cos_t <= 0) return false;
      wi = normalize({-wo.x / view.eta, -wo.y / view.eta, -cos_t});
      coefficient = lobe.color * (1 - f);
      break;
    }
    case LobeKind::delta_pass:
      wi = -wo;
      coefficient = lobe.color;
      if (thin) coefficient *= 1 - fresnel_thin(fresnel_dielectric(wo.z, lobe.eta));
      break;
    default:
      return false;
  }
  if (lobe.veil) coefficient *= veil_factor(lobe.veil, wo.z);
  return !is_black(coefficient);
}

}  // namespace lumirank::scatter
