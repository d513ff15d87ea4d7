#include "scatter/material.h"

#include "scatter/closure_builder.h"

namespace lumirank::scatter {

Closure MaterialSet::closure(int material, const SurfacePoint& at, Vec3f wo) const {
  ClosureBuilder builder(*this, wo);
  builder.add(material, at, 1);
  return builder.finish(at);
}

}  // namespace lumirank::scatter
