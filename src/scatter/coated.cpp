// Lobes seen through a coat: value, density, draw and albedo in terms of the bare lobe's (coat.h has the
// formula). Local frame, wo.z > 0.
#include "base/warp.h"
#include "scatter/coat.h"
#include "scatter/lobe.h"

namespace lumirank::scatter {
namespace {

Rgb squared(Rgb c) { return c * c; }

// The direction within the layer.
Vec3f bent(const Coat& coat, Vec3f w) { return {w.x / coat.bend, w.y / coat.bend, coat_cosine(coat, w.z)}; }

// Light through a transmitting lobe crosses the coat once, on the outside; two parallel interfaces bend it as
// the nested one alone would.
Rgb crossed_once(LobeView view, Vec3f wo, Vec3f wi) {
  return coat_passage(view.lobe.coat, std::abs(view.outside ? wo.z : wi.z));
}

}  // namespace

Rgb coated_value(LobeView view, Vec3f wo, Vec3f wi) {
  const Coat& coat = view.lobe.coat;
  if (transmits(view.lobe.kind)) return bare_value(view, wo, wi) * crossed_once(view, wo, wi);
  const Vec3f o = bent(coat, wo), i = bent(coat, wi);
  if (!(o.z > 0 && i.z > 0)) return Rgb(0);
  return bare_value(view, o, i) * coat_passage(coat, wo.z) * coat_passage(coat, wi.z) *
         (1 / (coat.bend * coat.bend));
}

float coated_pdf(LobeView view, Vec3f wo, Vec3f wi) {
  const Coat& coat = view.lobe.coat;
  if (transmits(view.lobe.kind)) return bare_pdf(view, wo, wi);
  // Diffuse lobes are drawn outside: drawn within, most directions would not get out.
  if (draws_cosine(view.lobe.kind)) return pdf_cosine_hemisphere(wi.z);
  const Vec3f o = bent(coat, wo), i = bent(coat, wi);
  if (!(o.z > 0 && i.z > 0)) return 0;
  // Solid angles are compressed by cos/(eta²·cos').
  return bare_pdf(view, o, i) * wi.z / (coat.bend * coat.bend * i.z);
}

bool coated_sample(LobeView view, Vec3f wo, Vec2f u, Vec3f& wi) {
  const Coat& coat = view.lobe.coat;
  if (transmits(view.lobe.kind) || draws_cosine(view.lobe.kind)) return bare_sample(view, wo, u, wi);
  const Vec3f o = bent(coat, wo);
  Vec3f i;
  if (!(o.z > 0) || !bare_sample(view, o, u, i)) return false;
  const float x = i.x * coat.bend, y = i.y * coat.bend, z2 = 1 - x * x - y * y;
  if (!(z2 > 0)) return false;  // totally reflected inside
  wi = {x, y, std::sqrt(z2)};
  return true;
}

Rgb coated_albedo(LobeView view, Vec3f wo) {
  Vec3f wi;
  Rgb coefficient;
  if (is_delta(view.lobe.kind))
    return coated_delta_direction(view, wo, wi, coefficient) ? coefficient : Rgb(0);
  return quadrature_albedo(view, wo);
}

float coated_importance(LobeView view, float cos_o) {
  const Coat& coat = view.lobe.coat;
  const float inside = transmits(view.lobe.kind) ? cos_o : coat_cosine(coat, cos_o);
  return bare_importance(view, inside) * std::max(0.05f, mean(coat_passage(coat, cos_o)));
}

bool coated_delta_direction(LobeView view, Vec3f wo, Vec3f& wi, Rgb& coefficient) {
  const Coat& coat = view.lobe.coat;
  if (transmits(view.lobe.kind)) {
    if (!bare_delta_direction(view, wo, wi, coefficient)) return false;
    coefficient *= crossed_once(view, wo, wi);
    return !is_black(coefficient);
  }
  const Vec3f o = bent(coat, wo);
  if (!(o.z > 0) || !bare_delta_direction(view, o, wi, coefficient)) return false;
  wi = {-wo.x, -wo.y, wo.z};
  // Back and forth between two mirrors: c·p² + c²·r·p²… with r what the layer returns inside, which at the
  // refracted angle is what it reflects outside.
  const Rgb passage = coat_passage(coat, wo.z);
  const Rgb one_way = passage / std::max(coat_transmittance(coat, wo.z), 1e-12f);
  const Rgb again = coefficient * squared(one_way) * (1 - coat_transmittance(coat, wo.z));
  coefficient = coefficient * squared(passage);
  for (int c = 0; c < 3; ++c) coefficient[c] /= std::max(1 - again[c], 1e-6f);
  return !is_black(coefficient);
}

}  // namespace lumirank::scatter
