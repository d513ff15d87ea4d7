#include "base/near_origin.h"

#include <cmath>

namespace lumirank {

double Bounds3d::radius() const {
  if (empty()) return 0;
  return 0.5 * std::hypot(hi.x - lo.x, hi.y - lo.y, hi.z - lo.z);
}

Vec3d near_origin(const Bounds3d& box, double far) {
  const double radius = box.radius();
  const Vec3d center = box.center();
  Vec3d origin;
  if (box.empty() || !std::isfinite(radius) || !is_finite(center)) return origin;
  for (int k = 0; k < 3; ++k) {
    if (!(std::abs(center[k]) > far * radius)) continue;
    const double step = radius > 0 ? std::exp2(std::floor(std::log2(radius))) : 0;
    origin[k] = step > 0 ? std::round(center[k] / step) * step : center[k];
  }
  return origin;
}

}  // namespace lumirank
