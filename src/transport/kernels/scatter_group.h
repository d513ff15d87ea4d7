// Receivers or surface lights that are not lambertian, 16 at a time.
#pragma once

#include <cstdint>
#include <deque>
#include <span>
#include <vector>

#include "scatter/closure.h"
#include "transport/closure_pool.h"
#include "transport/kernels/lanes.h"

namespace lumirank::transport {

// The closures of one side of the matrix and the directions known first.
struct ScatterSide {
  const ClosurePool* pool;
  const std::vector<std::uint32_t>* closure;
  const std::vector<Vec3f>*normal, *ng, *wo;

  scatter::Closure get(std::uint32_t item) const {
    return pool->get((*closure)[item], (*normal)[item], (*ng)[item]);
  }
};

// Fetched once, evaluated for many partners.
struct ScatterGroup {
  const scatter::Closure* closure[16];  // nullptr: padding
  Vec3f wo[16];
};

// Keeps what ScatterGroups point to; clear() before the next tile.
class ScatterArena {
 public:
  // items: 16 receivers or lights, kNoItem where there is none.
  ScatterGroup fetch(const ScatterSide& side, const std::uint32_t items[16]);
  // 16 times the same.
  ScatterGroup fetch(const ScatterSide& side, std::uint32_t item);
  void clear() { closures_.clear(); }

 private:
  std::deque<scatter::Closure> closures_;  // does not move its elements
};

// f(wo, wi) of scatter::eval_f, wi unit and away from the surface.
Lane3 eval_f(const ScatterGroup& group, const Lane3& wi);

}  // namespace lumirank::transport
