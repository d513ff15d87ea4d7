// Lobes of one brightness: Lambert's, its like on the far side of a sheet, and plastic's base under its
// smooth or rough interface (interface.h).
#include "base/warp.h"
#include "scatter/interface.h"
#include "scatter/lobes/bound_terms.h"
#include "scatter/lobes/family.h"

namespace lumirank::scatter {
namespace {

Rgb diffuse_value(LobeView view, Vec3f, Vec3f) { return view.lobe.color * kInvPi; }
UnderCoat diffuse_under_coat(LobeView view) { return {UnderCoat::Sort::diffuse, view.lobe.color}; }

float behind_pdf(LobeView, Vec3f, Vec3f wi) { return pdf_cosine_hemisphere(-wi.z); }
bool behind_sample(LobeView, Vec3f, Vec2f u, Vec3f& wi) {
  wi = -warp_cosine_hemisphere(u);
  return wi.z < 0;
}

Rgb interfaced_value(LobeView view, Vec3f wo, Vec3f wi) {
  const Lobe& lobe = view.lobe;
  return lobe.color * (kInvPi * interface_transmittance(lobe, wo.z) * interface_transmittance(lobe, wi.z));
}
Rgb interfaced_albedo(LobeView view, Vec3f wo) {
  return view.lobe.color * (interface_transmittance(view.lobe, wo.z) * view.lobe.alpha_v);
}
float interfaced_importance(LobeView view, float cos_o) {
  const Lobe& lobe = view.lobe;
  return mean(lobe.color) * std::max(kMinImportance, interface_transmittance(lobe, cos_o)) * lobe.alpha_v;
}
float interfaced_factor(const Lobe& lobe, float cos_o, float) {
  return kInvPi * interface_transmittance(lobe, cos_o);
}
UnderCoat interfaced_under_coat(LobeView view) {
  return {UnderCoat::Sort::diffuse, view.lobe.color * (view.lobe.alpha_v * view.lobe.alpha_v)};
}

}  // namespace

constinit const LobeFamily diffuse_family{.value = diffuse_value,
                                          .albedo = color_albedo,
                                          .bound_by_cosine = true,
                                          .under_coat = diffuse_under_coat,
                                          .matt = true,
                                          .lanes = LaneForm::constant};

constinit const LobeFamily diffuse_transmit_family{.value = diffuse_value,
                                                   .pdf = behind_pdf,
                                                   .sample = behind_sample,
                                                   .albedo = color_albedo,
                                                   .bound_by_cosine = true,
                                                   .lanes = LaneForm::constant};

constinit const LobeFamily interfaced_diffuse_family{.value = interfaced_value,
                                                     .albedo = interfaced_albedo,
                                                     .importance = interfaced_importance,
                                                     .factor_of_wo = interfaced_factor,
                                                     .bound_by_cosine = true,
                                                     .under_coat = interfaced_under_coat,
                                                     .matt = true,
                                                     .lanes = LaneForm::interfaced_diffuse};

}  // namespace lumirank::scatter
