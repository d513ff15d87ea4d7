// Bump and normal maps: the shading frame that they make.
#include "scatter/closure_builder.h"

namespace lumirank::scatter {
namespace {

SurfacePoint with_normal(const SurfacePoint& at, Vec3f n, Vec3f tangent) {
  SurfacePoint out = at;
  const float toward = dot(n, at.ng);
  // A closure's shading normal is never behind its surface: lift it to just above the horizon.
  constexpr float min_cosine = 1e-3f;
  if (!(toward >= min_cosine)) n = n + at.ng * (min_cosine - toward);
  const float len = length(n);
  if (!(len > 1e-12f) || !std::isfinite(len)) return at;
  out.shading = Frame::from_normal_tangent(n / len, tangent);
  return out;
}

}  // namespace

SurfacePoint turned(const SurfacePoint& at) {
  SurfacePoint out = at;
  out.ng = -at.ng;
  out.shading.n = -at.shading.n;
  return out;
}

// Blinn 1978: the surface is displaced along the shading normal by the height, curvature neglected.
SurfacePoint bumped(const TextureSet& textures, const BumpMaterial& m, const SurfacePoint& at) {
  if (!(length_squared(at.dpdu) > 0 && length_squared(at.dpdv) > 0)) return at;
  const Vec2f slope = textures.gradient(m.texture, at.uv) * m.scale;
  const Vec3f n = at.shading.n;
  const Vec3f du = at.dpdu - n * dot(n, at.dpdu) + n * slope.x;
  const Vec3f dv = at.dpdv - n * dot(n, at.dpdv) + n * slope.y;
  Vec3f bent = cross(du, dv);
  const float len = length(bent);
  if (!(len > 0) || !std::isfinite(len)) return at;
  bent = bent / len;
  if (dot(bent, n) < 0) bent = -bent;
  return with_normal(at, bent, du);
}

SurfacePoint normal_mapped(const TextureSet& textures, const NormalMapMaterial& m, const SurfacePoint& at) {
  const Rgb c = textures.lookup(m.texture, at.uv);
  Vec3f local{(2 * c.r - 1) * m.scale, (2 * c.g - 1) * m.scale, 2 * c.b - 1};
  if (m.follow_uv && dot(at.shading.t, at.dpdv) > 0) local.y = -local.y;
  const float len = length(local);
  if (!(len > 1e-6f) || !std::isfinite(len)) return at;
  return with_normal(at, at.shading.to_world(local / len), at.shading.s);
}

SurfacePoint with_turned_tangent(const TextureSet& textures, const TurnedTangentMaterial& m,
                                 const SurfacePoint& at) {
  const Rgb c = m.direction.texture >= 0 ? textures.lookup(m.direction.texture, at.uv) : m.direction.value;
  const float x = 2 * c.r - 1, y = 2 * c.g - 1, cosine = std::cos(m.angle), sine = std::sin(m.angle);
  const Vec3f up = dot(at.shading.t, at.dpdv) > 0 ? -at.shading.t : at.shading.t;
  const Vec3f tangent = at.shading.s * (x * cosine - y * sine) + up * (x * sine + y * cosine);
  const float len = length(tangent);
  if (!(len > 1e-6f) || !std::isfinite(len)) return at;
  SurfacePoint out = at;
  out.shading = Frame::from_normal_tangent(at.shading.n, tangent / len);
  return out;
}

}  // namespace lumirank::scatter
