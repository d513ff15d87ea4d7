#include "transport/pairs/scatter_forms.h"

#include <algorithm>

namespace lumirank::transport {
namespace {

bool has_lane_code(const scatter::Lobe& lobe) {
  if (lobe.sheen_layer) return false;
  if (lobe.coat && scatter::shines_through(lobe.kind)) return false;
  return scatter::family_of(lobe.kind).lanes != scatter::LaneForm::none;
}

bool is_anisotropic(const scatter::Lobe& lobe) {
  return scatter::family_of(lobe.kind).two_widths && lobe.alpha_u != lobe.alpha_v;
}

ScatterForm form_of(std::span<const scatter::Lobe> lobes) {
  ScatterForm form;
  form.in_lanes = std::all_of(lobes.begin(), lobes.end(), has_lane_code);
  for (const scatter::Lobe& lobe : lobes) {
    const scatter::LobeFamily& family = scatter::family_of(lobe.kind);
    if (scatter::shines_through(lobe.kind)) form.sides = Sides::both;
    if (scatter::is_hair(lobe.kind)) form.sides = Sides::fiber;
    const bool coated = static_cast<bool>(lobe.coat);
    form.microfacets = form.microfacets || (family.half_vector && !coated);
    form.anisotropic = form.anisotropic || is_anisotropic(lobe);
    form.coated = form.coated || coated;
    if (form.in_lanes)
      form.lobes.push_back({lobe.kind, family.lanes, lobe.fresnel, lobe.distribution, lobe.variant, coated});
  }
  // One form for all that goes lane by lane, but for the side on which rays start.
  if (!form.in_lanes) form.lobes.clear(), form.microfacets = form.anisotropic = form.coated = false;
  return form;
}

}  // namespace

ScatterForms::ScatterForms(const scatter::ClosurePool& pool) {
  form_of_recipe_.reserve(pool.recipes());
  for (std::uint32_t recipe = 0; recipe < pool.recipes(); ++recipe) {
    const ScatterForm form = form_of(pool.lobes(recipe));
    const auto found = std::find(forms_.begin(), forms_.end(), form);
    form_of_recipe_.push_back(static_cast<std::uint16_t>(found - forms_.begin()));
    if (found == forms_.end()) forms_.push_back(form);
  }
}

bool ScatterForms::some_two_sided() const {
  return std::any_of(forms_.begin(), forms_.end(),
                     [](const ScatterForm& form) { return form.sides != Sides::front; });
}

}  // namespace lumirank::transport
