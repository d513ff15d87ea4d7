// A layer of sheen over an opaque material: every nested lobe under it, and the sheen's own lobe.
#include "base/error.h"
#include "scatter/closure_builder.h"
#include "scatter/lobe.h"
#include "scatter/lobes/charlie_sheen.h"

namespace lumirank::scatter {

void add_lobes(const SheenMaterial& m, ClosureBuilder& out, const SurfacePoint& at, float weight) {
  const Rgb color = reflectance(out.textures(), m.color, at.uv);
  if (!out.front(at) || is_black(color)) return out.add(m.nested, at, weight);

  ClosureBuilder inner = out.inside();
  inner.add(m.nested, at, 1);
  const Closure nested = inner.finish(at);
  SurfacePoint point = at;
  point.shading = nested.frame, point.ng = nested.ng;
  const float roughness = std::clamp(number(out.textures(), m.roughness, at.uv), kMinSheenRoughness, 1.0f);
  const SheenLayer sheen_layer(max_component(color), roughness);

  Lobe own;
  own.kind = LobeKind::charlie_sheen;
  own.color = color;
  own.alpha_u = own.alpha_v = roughness * roughness;
  out.push(own, point, weight);
  for (int k = 0; k < nested.count; ++k) {
    Lobe lobe = nested.lobes[k];
    if (lobe.coat || lobe.sheen_layer || transmits(lobe.kind) || is_hair(lobe.kind))
      throw InternalError("sheen over a coating, a sheen, hair or what lets light pass");
    lobe.sheen_layer = sheen_layer;
    out.push(lobe, point, weight);
  }
}

}  // namespace lumirank::scatter
