#include "transport/pairs/sphere_integral.h"

#include <cmath>
#include <utility>

#include "base/frame.h"
#include "base/random.h"
#include "base/warp.h"

namespace lumirank::transport {
namespace {

// Sample k of n: strata in the first dimension, multiples of the golden ratio in the second, both rotated.
Vec2f lattice(int k, int n, Vec2f offset) {
  const float y = offset.y + static_cast<float>(k) * 0.618033989f;
  return {(static_cast<float>(k) + offset.x) / static_cast<float>(n), y - std::floor(y)};
}

}  // namespace

SphereCone sphere_cone(Vec3f n, Vec3f w, float radius) {
  const float d2 = length_squared(w), sin2 = radius * radius / d2;
  if (!(sin2 < 1)) return {dot(n, w) < 0 ? -n : n, 0, 2 * kPi};
  const float cosine = std::sqrt(1 - sin2);
  return {w / std::sqrt(d2), cosine, 2 * kPi * sin2 / (1 + cosine)};
}

Rgb sphere_integrand(const SphereEnds& ends, Vec3f l) {
  const float slope = dot(ends.ng, l), height = dot(ends.ng, ends.w);
  float indicator = std::abs(slope);
  if (ends.y.is_fiber()) {
    indicator = ends.y.cosine(l);
  } else if (slope * height <= 0) {
    return Rgb(0);
  } else if (ends.disc) {
    if (!(length_squared(l * (height / slope) - ends.w) < ends.radius * ends.radius)) return Rgb(0);
    indicator = 1;
  }
  const Rgb fy = scatter::eval_f(ends.y, ends.incoming, -l, true);
  if (is_black(fy)) return Rgb(0);
  return scatter::eval(ends.x, ends.wo, l) * fy * indicator;
}

Rgb sphere_integral(const SphereEnds& ends, SphereSamples samples, std::uint64_t key) {
  const SphereCone cone = sphere_cone(ends.n, ends.w, ends.radius);
  Rng rng(key, Stage::spheres);
  Rgb sum(0);
  // One sample of any strategy; its own density is not computed twice.
  const auto add = [&](Vec3f l, float pdf_x, float pdf_y) {
    if (!(dot(l, cone.axis) >= cone.cos_max)) return;
    const Rgb value = sphere_integrand(ends, l);
    if (is_black(value)) return;
    float density = static_cast<float>(samples.cone) / cone.solid_angle;
    if (samples.receiver > 0)
      density += static_cast<float>(samples.receiver) *
                 (pdf_x >= 0 ? pdf_x : scatter::pdf(ends.x, ends.wo, l, scatter::Lobes::non_delta));
    if (samples.light > 0)
      density += static_cast<float>(samples.light) *
                 (pdf_y >= 0 ? pdf_y : scatter::pdf(ends.y, ends.incoming, -l, scatter::Lobes::non_delta));
    if (std::isfinite(density)) sum += value / density;
  };
  constexpr float kUnknown = -1;

  const Frame frame = Frame::from_normal(cone.axis);
  Vec2f offset = rng.next_2d();
  for (int k = 0; k < samples.cone; ++k) {
    const Vec2f u = lattice(k, samples.cone, offset);
    // As warp_cone, but 1 - cosθ keeps its digits where the cone is narrow.
    const float below = u.x * cone.solid_angle / (2 * kPi), r = std::sqrt(below * (2 - below));
    const float phi = 2 * kPi * u.y;
    Vec3f l = frame.to_world({r * std::cos(phi), r * std::sin(phi), 1 - below});
    // Rounding must not lose the rim.
    if (dot(l, cone.axis) < cone.cos_max) l = cone.axis;
    add(l, kUnknown, kUnknown);
  }
  // The lobe of a closure is chosen by the stratified dimension, so that every lobe gets its share.
  offset = rng.next_2d();
  for (int k = 0; k < samples.receiver; ++k) {
    const Vec2f u = lattice(k, samples.receiver, offset);
    const auto s = scatter::sample(ends.x, ends.wo, u.x, {u.y, rng.next_float()}, scatter::Lobes::non_delta);
    if (s) add(s->wi, s->pdf, kUnknown);
  }
  offset = rng.next_2d();
  for (int k = 0; k < samples.light; ++k) {
    const Vec2f u = lattice(k, samples.light, offset);
    const auto s =
        scatter::sample(ends.y, ends.incoming, u.x, {u.y, rng.next_float()}, scatter::Lobes::non_delta, true);
    if (s) add(-s->wi, kUnknown, s->pdf);
  }
  return sum;
}

}  // namespace lumirank::transport
