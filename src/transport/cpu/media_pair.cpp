#include "transport/cpu/media_pair.h"

#include <cmath>

#include "media/tracking.h"
#include "scatter/closure.h"
#include "transport/pairs/pair_kernel.h"
#include "transport/pairs/ray_sampling.h"

namespace lumirank::transport {
namespace {

// What a point light sends along -w, where w is the unit direction towards it: radiant intensity, or, of what
// is infinitely far, irradiance. What is not the light's own is 0: it does not shine there.
Rgb shines(const VirtualLights& lights, std::size_t j, Vec3f w) {
  const Rgb power = lights.power[j];
  switch (lights.kind[j]) {
    case LightKind::omni:
    case LightKind::directional:
      return power;
    case LightKind::oriented:
      return power * std::max(0.0f, -dot(lights.normal[j], w));
    case LightKind::spot: {
      const SpotShape& spot = lights.spots[lights.closure[j]];
      return power * spot_share(spot, -dot(lights.normal[j], w), -w);
    }
    case LightKind::surface:
      break;
  }
  const scatter::Closure closure = lights.closure_at(j);
  // f without the cosine of the shading normal: flux leaves through the geometric surface.
  const Rgb f = scatter::eval_f(closure, lights.incoming[j], -w, true);
  const float cosine = closure.is_fiber() ? closure.cosine(-w) : std::abs(dot(lights.ng[j], w));
  return power * f * cosine;
}

}  // namespace

MediaPairs::Entry MediaPairs::connect(Rgb value, const world::StraightSegment& segment, matrix::Part part,
                                      Rng& rng) const {
  Entry entry;
  if (is_black(value)) return entry;
  const auto arriving =
      world::pass_straight(world_, segment, part != matrix::Part::value, [&rng] { return rng.next_float(); });
  entry.traced = true;
  entry.visible = !arriving.blocked;
  entry.unoccluded = value * arriving.left;
  if (!is_finite(entry.unoccluded)) return {};
  return entry;
}

MediaPairs::Entry MediaPairs::ray_to_segment(std::size_t i, std::size_t j, matrix::Part part) const {
  const EyeSegments& rows = receivers_.segments;
  const RayLights& rays = lights_.rays;
  if (too_deep(rows.depth[i], rays.depth[j])) return {};
  Numbers numbers = numbers_of(rows.id[i], rays.id[j]);
  const auto random = [&numbers] { return numbers.tracking.next_float(); };
  const RayPlace on_ray = sample_near_line(rays.origin[j], rays.direction[j], rays.length[j], rows.origin[i],
                                           rows.direction[i], numbers.place());
  if (!(on_ray.pdf > 0)) return {};
  const Vec3f y = rays.origin[j] + rays.direction[j] * on_ray.t;
  const RayPlace on_segment =
      sample_equiangular(rows.origin[i], rows.direction[i], rows.length[i], y, numbers.place());
  if (!(on_segment.pdf > 0)) return {};
  const Vec3f x = rows.origin[i] + rows.direction[i] * on_segment.t;
  const float d = length(y - x);
  if (!(d > 0)) return {};
  const Vec3f w = (y - x) / d;
  const media::Medium &there = medium(rays.medium[j]), &here = medium(rows.medium[i]);
  const Rgb scattered_there = there.at(y).scattering * there.phase().eval(-dot(rays.direction[j], w));
  const Rgb scattered_here = here.at(x).scattering * here.phase().eval(dot(rows.direction[i], w));
  Rgb value = rays.power[j] * scattered_there * scattered_here * (1 / (d * d * on_ray.pdf * on_segment.pdf));
  if (is_black(value)) return {};
  value *= media::transmittance(there, rays.origin[j], rays.direction[j], on_ray.t, random) *
           media::transmittance(here, rows.origin[i], rows.direction[i], on_segment.t, random);
  return connect(value, {x, Vec3f{}, w, d, rows.medium[i]}, part, numbers.tracking);
}

MediaPairs::Entry MediaPairs::point_to_segment(std::size_t i, std::size_t j, matrix::Part part) const {
  const EyeSegments& rows = receivers_.segments;
  const VirtualLights& points = lights_.points;
  if (too_deep(rows.depth[i], points.depth[j])) return {};
  Numbers numbers = numbers_of(rows.id[i], points.id[j]);
  const auto random = [&numbers] { return numbers.tracking.next_float(); };
  const bool far = points.kind[j] == LightKind::directional;
  const RayPlace place = far ? RayPlace{numbers.place() * rows.length[i], 1 / rows.length[i]}
                             : sample_equiangular(rows.origin[i], rows.direction[i], rows.length[i],
                                                  points.position[j], numbers.place());
  if (!(place.pdf > 0)) return {};
  const Vec3f x = rows.origin[i] + rows.direction[i] * place.t;
  const float d = far ? kInfinity : length(points.position[j] - x);
  if (!(d > 0)) return {};
  const Vec3f w = far ? -points.normal[j] : (points.position[j] - x) / d;
  const media::Medium& here = medium(rows.medium[i]);
  Rgb value = shines(points, j, w) * here.at(x).scattering * here.phase().eval(dot(rows.direction[i], w)) *
              (1 / (place.pdf * (far ? 1.0f : d * d)));
  if (is_black(value)) return {};
  value *= media::transmittance(here, rows.origin[i], rows.direction[i], place.t, random);
  return connect(value, {x, Vec3f{}, w, d, rows.medium[i]}, part, numbers.tracking);
}

MediaPairs::Entry MediaPairs::ray_to_receiver(std::size_t i, std::size_t j, matrix::Part part) const {
  const RayLights& rays = lights_.rays;
  if (too_deep(receivers_.depth[i], rays.depth[j])) return {};
  Numbers numbers = numbers_of(receivers_.id[i], rays.id[j]);
  const auto random = [&numbers] { return numbers.tracking.next_float(); };
  const Vec3f x = receivers_.position[i];
  const RayPlace place =
      sample_equiangular(rays.origin[j], rays.direction[j], rays.length[j], x, numbers.place());
  if (!(place.pdf > 0)) return {};
  const Vec3f y = rays.origin[j] + rays.direction[j] * place.t;
  const float d = length(y - x);
  if (!(d > 0)) return {};
  const Vec3f w = (y - x) / d;
  const Rgb f = scatter::eval(receivers_.closure_at(i), receivers_.wo[i], w);
  if (is_black(f)) return {};
  const media::Medium& there = medium(rays.medium[j]);
  Rgb value = rays.power[j] * f * there.at(y).scattering * there.phase().eval(-dot(rays.direction[j], w)) *
              (1 / (d * d * place.pdf));
  if (is_black(value)) return {};
  value *= media::transmittance(there, rays.origin[j], rays.direction[j], place.t, random);
  const bool front = dot(receivers_.ng[i], w) >= 0;
  return connect(value, {x, receivers_.ng[i], w, d, receivers_.media[i][front ? 0 : 1]}, part,
                 numbers.tracking);
}

Rgb MediaPairs::media_between(std::size_t i, std::size_t j) const {
  const VirtualLights& points = lights_.points;
  Rng rng(settings_.seed, Stage::ray_pairs, receivers_.id[i], points.id[j]);
  const bool far = points.kind[j] == LightKind::directional;
  const Vec3f x = receivers_.position[i];
  const float d = far ? kInfinity : length(points.position[j] - x);
  if (!(d > 0)) return Rgb{0};
  const Vec3f w = far ? -points.normal[j] : (points.position[j] - x) / d;
  const bool front = dot(receivers_.ng[i], w) >= 0;
  return world::pass_media(world_, {x, receivers_.ng[i], w, d, receivers_.media[i][front ? 0 : 1]},
                           [&rng] { return rng.next_float(); });
}

}  // namespace lumirank::transport
