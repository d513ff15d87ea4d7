#include "transport/kernels/scatter_group.h"

#include "transport/kernels/tile_plan.h"

namespace lumirank::transport {

ScatterGroup ScatterArena::fetch(const ScatterSide& side, const std::uint32_t items[16]) {
  ScatterGroup group;
  for (int k = 0; k < 16; ++k) {
    if (items[k] == kNoItem) {
      group.closure[k] = nullptr;
      continue;
    }
    group.closure[k] = &closures_.emplace_back(side.get(items[k]));
    group.wo[k] = (*side.wo)[items[k]];
  }
  return group;
}

ScatterGroup ScatterArena::fetch(const ScatterSide& side, std::uint32_t item) {
  ScatterGroup group;
  const scatter::Closure& closure = closures_.emplace_back(side.get(item));
  for (int k = 0; k < 16; ++k) group.closure[k] = &closure, group.wo[k] = (*side.wo)[item];
  return group;
}

Lane3 eval_f(const ScatterGroup& group, const Lane3& wi) {
  Lane3 f{};
  for (int k = 0; k < 16; ++k) {
    if (!group.closure[k]) continue;
    const Rgb c = scatter::eval_f(*group.closure[k], group.wo[k], {wi.x[k], wi.y[k], wi.z[k]});
    f.x[k] = c.r, f.y[k] = c.g, f.z[k] = c.b;
  }
  return f;
}

}  // namespace lumirank::transport
