#include "emitters/area.h"

#include "base/error.h"
#include "base/warp.h"

namespace lumirank::emitters {

void finish(AreaEmitter& emitter) {
  double area = 0, power = 0;
  for (const auto& t : emitter.triangles) {
    area += t.area;
    power += static_cast<double>(t.area) * luminance(t.mean_radiance);
  }
  emitter.total_area = static_cast<float>(area);
  const float floor = area > 0 ? static_cast<float>(0.01 * power / area) : 0.0f;
  std::vector<float> weights;
  weights.reserve(emitter.triangles.size());
  for (const auto& t : emitter.triangles)
    weights.push_back(t.area * std::max(luminance(t.mean_radiance), floor));
  emitter.by_power = Distribution1D(weights);
}

AreaPoint sample_area(const AreaEmitter& emitter, float u1, Vec2f u2) {
  AreaPoint point;
  if (!(emitter.by_power.total() > 0)) return point;
  const auto chosen = emitter.by_power.sample(u1);
  const auto& t = emitter.triangles[chosen.index];
  point.triangle = static_cast<std::uint32_t>(chosen.index);
  point.barycentric = warp_triangle(u2);
  point.position = t.at(point.barycentric);
  point.pdf = t.area > 0 ? chosen.pmf / t.area : 0.0f;
  return point;
}

float pdf_direct_triangle(const AreaEmitter::Triangle& triangle, Vec3f direction, float distance) {
  const float cosine = -dot(direction, triangle.normal);
  if (!(cosine > 0) || !(triangle.area > 0)) return 0;
  return square(distance) / (cosine * triangle.area);
}

float pdf_direct_area(const AreaEmitter& emitter, const AreaEmitter::Triangle& triangle, Vec3f direction,
                      float distance) {
  const std::ptrdiff_t index = &triangle - emitter.triangles.data();
  if (index < 0 || index >= static_cast<std::ptrdiff_t>(emitter.triangles.size()))
    throw InternalError("pdf_direct_area: the triangle is not one of the emitter's");
  return emitter.by_power.pmf(static_cast<std::size_t>(index)) *
         pdf_direct_triangle(triangle, direction, distance);
}

}  // namespace lumirank::emitters
