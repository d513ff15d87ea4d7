// Lobes as value, density and draw in the local frame, whatever their family (lobes/family.h). Inside this
// room only.
//
// A lobe acts alike on both sides of the surface (one-sidedness is the material's business): the callers
// mirror directions so that wo.z > 0. Then wi.z > 0 for reflection and wi.z < 0 for transmission. `eta` is
// the relative index as seen from wo's side. (Lobes of fibers know no sides, and nothing is mirrored.) Values
// are f alone, without the cosine; densities are per solid angle of wi.
#pragma once

#include "scatter/closure.h"

namespace lumirank::scatter {

struct LobeView {
  const Lobe& lobe;
  float eta;             // index of the far side over that of wo's side
  bool outside;          // wo is on the outside, where coats are
  bool roughly = false;  // albedos are wanted fast
};

inline LobeView view_from(const Lobe& lobe, bool outside) {
  return {lobe, outside ? lobe.eta : 1 / lobe.eta, outside};
}

// Any non-delta lobe. A draw that leads nowhere (below the horizon) returns false.
Rgb lobe_value(LobeView view, Vec3f wo, Vec3f wi);
float lobe_pdf(LobeView view, Vec3f wo, Vec3f wi);
bool lobe_sample(LobeView view, Vec3f wo, Vec2f u, Vec3f& wi);
// Albedo at cosine wo.z: exact for diffuse and plastic's base, from a table for isotropic microfacets that
// reflect, else by a fixed rule of 55 draws; where it is wanted roughly from the table for all microfacets,
// else by 13 draws.
Rgb lobe_albedo(LobeView view, Vec3f wo);
// Cheap estimate of the albedo's mean over channels, to choose among lobes; positive for every lobe not
// black.
float lobe_importance(LobeView view, float cos_o);
inline bool transmits(LobeKind kind) {
  return sort_of(kind) == LobeSort::shines_through || sort_of(kind) == LobeSort::delta_through;
}

// A delta lobe's single direction (local) and coefficient without radiance scaling. False if there is none
// (total internal reflection).
bool delta_direction(LobeView view, Vec3f wo, Vec3f& wi, Rgb& coefficient);

// Fresnel factor of a reflecting lobe at the cosine with the (micro)facet, one of the four kinds.
Rgb lobe_fresnel(LobeView view, float cos_m);

// The same without the lobe's coat, for directions within the coat (coated.cpp turns outer ones into them).
Rgb bare_value(LobeView view, Vec3f wo, Vec3f wi);
float bare_pdf(LobeView view, Vec3f wo, Vec3f wi);
bool bare_sample(LobeView view, Vec3f wo, Vec2f u, Vec3f& wi);
Rgb bare_albedo(LobeView view, Vec3f wo);
float bare_importance(LobeView view, float cos_o);
bool bare_delta_direction(LobeView view, Vec3f wo, Vec3f& wi, Rgb& coefficient);
Rgb coated_value(LobeView view, Vec3f wo, Vec3f wi);
float coated_pdf(LobeView view, Vec3f wo, Vec3f wi);
bool coated_sample(LobeView view, Vec3f wo, Vec2f u, Vec3f& wi);
Rgb coated_albedo(LobeView view, Vec3f wo);
float coated_importance(LobeView view, float cos_o);
bool coated_delta_direction(LobeView view, Vec3f wo, Vec3f& wi, Rgb& coefficient);
// Drawn by the cosine alone.
bool draws_cosine(LobeKind kind);
// Albedo by a fixed rule of 55 draws.
Rgb quadrature_albedo(LobeView view, Vec3f wo);

// Of fibers: local x runs along them, and wo is not mirrored.
float hair_specular_scale(float exponent);  // what alpha_v must be
float fiber_sine(Vec3f w);                  // of the angle between w and the fiber

}  // namespace lumirank::scatter
