// The modified Phong model (Lafortune and Willems 1994): (n + 2)/(2π)·cosⁿ of the angle to the mirror
// direction.
#include "scatter/lobe.h"

namespace lumirank::scatter {
namespace {

float cos_to_mirror(Vec3f wo, Vec3f wi) { return dot(Vec3f{-wo.x, -wo.y, wo.z}, wi); }

}  // namespace

Rgb phong_value(const Lobe& lobe, Vec3f wo, Vec3f wi) {
  const float c = cos_to_mirror(wo, wi), n = lobe.alpha_u;
  if (c <= 0) return Rgb(0);
  return lobe.color * ((n + 2) * (0.5f * kInvPi) * std::pow(c, n));
}

float phong_pdf(const Lobe& lobe, Vec3f wo, Vec3f wi) {
  const float c = cos_to_mirror(wo, wi), n = lobe.alpha_u;
  return c <= 0 ? 0.0f : (n + 1) * (0.5f * kInvPi) * std::pow(c, n);
}

bool phong_sample(const Lobe& lobe, Vec3f wo, Vec2f u, Vec3f& wi) {
  const float c = std::pow(1 - u.x, 1 / (lobe.alpha_u + 1)), s = std::sqrt(std::max(0.0f, 1 - c * c));
  const float phi = 2 * kPi * u.y;
  const Frame around = Frame::from_normal({-wo.x, -wo.y, wo.z});
  wi = around.to_world({s * std::cos(phi), s * std::sin(phi), c});
  return wi.z > 0;
}

}  // namespace lumirank::scatter
