// One of the three parts of what a dielectric fiber scatters (fiber_table.h).
#include <cmath>

#include "scatter/closure_builder.h"
#include "scatter/fiber_table.h"
#include "scatter/lobes/bound_terms.h"
#include "scatter/lobes/family.h"

namespace lumirank::scatter {
namespace {

const FiberTable& fiber_table(const Lobe& lobe) { return *static_cast<const FiberTable*>(lobe.table); }

Rgb hair_fiber_value(LobeView view, Vec3f wo, Vec3f wi) {
  return view.lobe.color * fiber_table(view.lobe).value(view.lobe.variant, wo, wi);
}
float hair_fiber_pdf(LobeView view, Vec3f wo, Vec3f wi) {
  return fiber_table(view.lobe).density(view.lobe.variant, wo, wi);
}
bool hair_fiber_sample(LobeView view, Vec3f wo, Vec2f u, Vec3f& wi) {
  wi = fiber_table(view.lobe).sample(view.lobe.variant, wo, u);
  return true;
}
Rgb hair_fiber_albedo(LobeView view, Vec3f wo) {
  return view.lobe.color * fiber_table(view.lobe).albedo(view.lobe.variant, wo.x, fiber_sine(wo));
}
// By the cosine with the normal, which on a fiber is towards wo.
float hair_fiber_importance(LobeView view, float cos_o) {
  const Rgb color = view.lobe.color;
  const FiberTable& table = fiber_table(view.lobe);
  const Rgb both = table.albedo(view.lobe.variant, -1, cos_o) + table.albedo(view.lobe.variant, 1, cos_o);
  return std::max(1e-3f * mean(color), 0.5f * mean(color * both));
}
float hair_fiber_factor(const Lobe&, float, float) { return 1; }
Rgb hair_fiber_bound(const LobeTerm& t, float latitude_o, float lo, float hi, CosineFactor factor) {
  return t.scale * fiber_table(*t.lobe).max_value(t.lobe->variant, latitude_o, lo, hi) *
         (factor == CosineFactor::cosine ? max_sine_of(lo, hi) : 1.0f);
}
// cosⁿ of the same variance.
float hair_fiber_roughness(const Lobe& lobe) {
  const float variance = fiber_table(lobe).parts[lobe.variant].variance;
  return std::min(1.0f, std::sqrt(2 / (1 / variance + 1)));
}

}  // namespace

constinit const LobeFamily hair_fiber_family{.value = hair_fiber_value,
                                             .pdf = hair_fiber_pdf,
                                             .sample = hair_fiber_sample,
                                             .albedo = hair_fiber_albedo,
                                             .importance = hair_fiber_importance,
                                             .factor_of_wo = hair_fiber_factor,
                                             .fiber_bound = hair_fiber_bound,
                                             .roughness = hair_fiber_roughness};

void add_lobes(const HairFiberMaterial& m, ClosureBuilder& out, const SurfacePoint& at, float weight) {
  for (int part = 0; part < FiberTable::kParts; ++part) {
    Lobe lobe = lobe_of(LobeKind::hair_fiber, Rgb(1));
    lobe.variant = static_cast<std::uint8_t>(part);
    lobe.table = m.table.get();
    out.push(lobe, at, weight);
  }
}

}  // namespace lumirank::scatter
