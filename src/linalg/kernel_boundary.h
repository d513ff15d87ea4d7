// A curved surface between two sets of points.
#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "base/vec.h"

namespace lumirank::linalg {

// A support vector machine with the kernel exp(−‖x − y‖²/(2·width²)) (LIBSVM; Chang and Lin 2011). Points are
// taken in units of their root mean square distance from their mean, and so is the width.
class KernelBoundary {
 public:
  // second[k]: whether points[k] is of the second set. Both sets need a member.
  KernelBoundary(std::span<const Vec3f> points, std::span<const std::uint8_t> second, double width);
  ~KernelBoundary();
  // Below 0 on the first set's side, above on the second's.
  double side(Vec3f point) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace lumirank::linalg
