// Mirrors, smooth glass and what lets light straight through.
#include "scatter/fresnel.h"
#include "scatter/lobes/family.h"
#include "scatter/microfacet.h"

namespace lumirank::scatter {
namespace {

Rgb no_value(LobeView, Vec3f, Vec3f) { return Rgb(0); }
float no_pdf(LobeView, Vec3f, Vec3f) { return 0; }
bool no_sample(LobeView, Vec3f, Vec2f, Vec3f&) { return false; }
float no_width(const Lobe&) { return 0; }

float of_sheet(const Lobe& lobe, Vec3f wo) {
  return sheet_reflectance(lobe.variant == kThinSlab, fresnel_dielectric(wo.z, lobe.eta));
}

bool reflect_direction(LobeView view, Vec3f wo, Vec3f& wi, Rgb& coefficient) {
  const Lobe& lobe = view.lobe;
  wi = {-wo.x, -wo.y, wo.z};
  coefficient = lobe.color * (lobe.variant == 0 ? lobe_fresnel(view, wo.z) : Rgb(of_sheet(lobe, wo)));
  return true;
}

bool transmit_direction(LobeView view, Vec3f wo, Vec3f& wi, Rgb& coefficient) {
  float cos_t;
  const float f = fresnel_dielectric(wo.z, view.eta, &cos_t);
  if (cos_t <= 0) return false;
  wi = normalize({-wo.x / view.eta, -wo.y / view.eta, -cos_t});
  coefficient = view.lobe.color * (1 - f);
  return true;
}

bool pass_direction(LobeView view, Vec3f wo, Vec3f& wi, Rgb& coefficient) {
  const Lobe& lobe = view.lobe;
  wi = -wo;
  coefficient = lobe.color;
  if (lobe.variant != 0) coefficient *= 1 - of_sheet(lobe, wo);
  return true;
}

// A rough layer makes a mirror under it rough.
void widen_mirror(Lobe& lobe, const Widening& by) {
  if (lobe.variant != 0) return;
  lobe.kind = LobeKind::microfacet_reflect;
  lobe.distribution = by.distribution;
  lobe.alpha_u = lobe.alpha_v = std::max(kMinAlpha, by(0));
}

}  // namespace

constinit const LobeFamily delta_reflect_family{.value = no_value,
                                                .pdf = no_pdf,
                                                .sample = no_sample,
                                                .direction = reflect_direction,
                                                .roughness = no_width,
                                                .widen = widen_mirror,
                                                .fresnel = true};

constinit const LobeFamily delta_transmit_family{.value = no_value,
                                                 .pdf = no_pdf,
                                                 .sample = no_sample,
                                                 .direction = transmit_direction,
                                                 .roughness = no_width,
                                                 .refracts = true};

constinit const LobeFamily delta_pass_family{.value = no_value,
                                             .pdf = no_pdf,
                                             .sample = no_sample,
                                             .direction = pass_direction,
                                             .roughness = no_width};

}  // namespace lumirank::scatter
