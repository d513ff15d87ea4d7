// What happens when materials are mixed until a closure is full.
#include <cmath>

#include "base/error.h"
#include "scatter/closure_builder.h"
#include "scatter/lobes/family.h"

namespace lumirank::scatter {
namespace {

bool same_sort(const Lobe& a, const Lobe& b) {
  return a.kind == b.kind && a.fresnel == b.fresnel && a.distribution == b.distribution &&
         a.variant == b.variant && a.table == b.table &&
         static_cast<bool>(a.coat) == static_cast<bool>(b.coat) &&
         static_cast<bool>(a.sheen_layer) == static_cast<bool>(b.sheen_layer);
}

bool equal_but_color(const Lobe& a, const Lobe& b) {
  if (!same_sort(a, b) || a.coat != b.coat || a.sheen_layer != b.sheen_layer) return false;
  return a.alpha_u == b.alpha_u && a.alpha_v == b.alpha_v && a.eta == b.eta &&
         (family_of(a.kind).two_colors || a.conductor_eta == b.conductor_eta) &&
         a.conductor_k == b.conductor_k && a.extra == b.extra;
}

Lobe average(const Lobe& a, const Lobe& b) {
  const float wa = mean(a.color), wb = mean(b.color), t = wb / (wa + wb);
  Lobe out = a;
  out.color = a.color + b.color;
  out.alpha_u = lerp(a.alpha_u, b.alpha_u, t), out.alpha_v = lerp(a.alpha_v, b.alpha_v, t);
  out.eta = lerp(a.eta, b.eta, t), out.extra = lerp(a.extra, b.extra, t);
  out.coat.eta = lerp(a.coat.eta, b.coat.eta, t), out.coat.bend = lerp(a.coat.bend, b.coat.bend, t);
  for (int i = 0; i < 6; ++i) out.coat.t[i] = lerp(a.coat.t[i], b.coat.t[i], t);
  out.coat.depth = lerp(a.coat.depth, b.coat.depth, t);
  if (a.sheen_layer)
    out.sheen_layer = SheenLayer(lerp(a.sheen_layer.share_value(), b.sheen_layer.share_value(), t),
                                 lerp(a.sheen_layer.roughness_value(), b.sheen_layer.roughness_value(), t));
  if (family_of(a.kind).two_colors) {
    out.conductor_eta = a.conductor_eta + b.conductor_eta;
  } else {
    out.conductor_eta = lerp(a.conductor_eta, b.conductor_eta, t);
    out.conductor_k = lerp(a.conductor_k, b.conductor_k, t);
  }
  return out;
}

}  // namespace

bool absorb(Closure& closure, const Lobe& lobe) {
  for (int k = 0; k < closure.count; ++k) {
    Lobe& have = closure.lobes[k];
    if (!equal_but_color(have, lobe)) continue;
    if (family_of(have.kind).two_colors) have.conductor_eta += lobe.conductor_eta;
    have.color += lobe.color;
    return true;
  }
  return false;
}

// Joins the two lobes that differ least among the ones of one sort: the diffuse ones first, then by
// roughness. Their parameters are averaged by weight, so the energy of the sum is kept as nearly as its
// shape.
void merge_lobes(Closure& closure, const Lobe& extra) {
  if (is_black(extra.color)) return;
  constexpr int n = kMaxLobes + 1;
  Lobe all[n];
  std::copy(closure.lobes, closure.lobes + kMaxLobes, all);
  all[kMaxLobes] = extra;
  int first = -1, second = -1;
  float min_gap = kInfinity;
  for (int i = 0; i < n; ++i) {
    for (int j = i + 1; j < n; ++j) {
      if (!same_sort(all[i], all[j])) continue;
      const float gap = family_of(all[i].kind).matt ? -1.0f
                                                    : std::abs(all[i].alpha_u - all[j].alpha_u) +
                                                          std::abs(all[i].alpha_v - all[j].alpha_v);
      if (gap < min_gap) min_gap = gap, first = i, second = j;
    }
  }
  if (first < 0) throw InternalError("a closure has more sorts of lobes than kMaxLobes");
  all[first] = average(all[first], all[second]);
  closure.count = 0;
  for (int i = 0; i < n; ++i)
    if (i != second) closure.add(all[i]);
}

}  // namespace lumirank::scatter
