// The table of families, and what those do that state nothing else.
#include "base/warp.h"
#include "scatter/lobes/bound_terms.h"
#include "scatter/lobes/family.h"

namespace lumirank::scatter {

#define LUMIRANK_FAMILY_ENTRY(name, sort) &name##_family,
constinit const LobeFamily* const kLobeFamilies[kLobeKinds] = {LUMIRANK_LOBE_KINDS(LUMIRANK_FAMILY_ENTRY)};
#undef LUMIRANK_FAMILY_ENTRY

float cosine_pdf(LobeView, Vec3f, Vec3f wi) { return pdf_cosine_hemisphere(wi.z); }

bool cosine_sample(LobeView, Vec3f, Vec2f u, Vec3f& wi) {
  wi = warp_cosine_hemisphere(u);
  return wi.z > 0;
}

Rgb color_albedo(LobeView view, Vec3f) { return view.lobe.color; }
float color_importance(LobeView view, float) { return mean(view.lobe.color); }
float inverse_pi(const Lobe&, float, float) { return kInvPi; }

Rgb constant_bound(const LobeTerm& term, const AngleRange& range, CosineFactor factor) {
  return term.scale * (factor == CosineFactor::cosine ? range.cos_hi : 1.0f);
}

float reach_of_alpha(const LobeTerm& term) { return std::clamp(term.widest, 1e-4f, 1.0f); }

}  // namespace lumirank::scatter
