// Power and emission of every kind of emitter, and direct samples of them.
#include "emitters/emitter.h"

#include "base/warp.h"
#include "emitters/area.h"
#include "emitters/environment.h"

namespace lumirank::emitters {

namespace {

// The spot's fall-off integrated over the sphere: 1 up to the beam angle b, then linear in angle down to 0 at
// the cutoff c, so ∫ = 2π (1 - (sin c - sin b)/(c - b)).
double spot_solid_angle(const SpotEmitter& e) {
  const double b = e.beam, c = e.cutoff;
  if (c - b < 1e-6) return 2 * 3.14159265358979323846 * (1 - std::cos(c));
  return 2 * 3.14159265358979323846 * (1 - (std::sin(c) - std::sin(b)) / (c - b));
}

// A disc of half angle α with constant radiance L gives a facing surface E = L π sin²α; over its directions
// (solid angle 2π(1 - cos α)) the mean of L per direction, times that solid angle, is 2E/(1 + cos α).
Rgb directional_value(const DirectionalEmitter& e) { return e.irradiance * (2 / (1 + e.cos_half_angle)); }

Vec3f directional_sample(const DirectionalEmitter& e, Vec2f u) {
  if (!(e.cos_half_angle < 1)) return e.direction;
  return Frame::from_normal(e.direction).to_world(warp_cone(u, e.cos_half_angle));
}

// Where a particle that travels along `direction` enters the scene: uniform on the disc that covers the
// bounding sphere.
Vec3f entry_point(const Bounds3f& scene, Vec3f direction, Vec2f u) {
  const Vec2f disc = warp_disk(u) * scene.radius();
  const Frame frame = Frame::from_normal(direction);
  return scene.center() + frame.s * disc.x + frame.t * disc.y - direction * scene.radius();
}

struct Power {
  float radius;
  Rgb operator()(const AreaEmitter& e) const {
    double sum[3] = {0, 0, 0};
    for (const auto& t : e.triangles)
      for (int k = 0; k < 3; ++k) sum[k] += static_cast<double>(t.area) * t.mean_radiance[k];
    return Rgb(static_cast<float>(sum[0]), static_cast<float>(sum[1]), static_cast<float>(sum[2])) * kPi;
  }
  Rgb operator()(const PointEmitter& e) const { return e.intensity * (4 * kPi); }
  Rgb operator()(const SpotEmitter& e) const { return e.intensity * static_cast<float>(spot_solid_angle(e)); }
  Rgb operator()(const ProfileEmitter& e) const { return e.scale * e.profile->total(); }
  Rgb operator()(const DirectionalEmitter& e) const { return directional_value(e) * (kPi * square(radius)); }
  Rgb operator()(const EnvironmentEmitter& e) const { return total_radiance(e) * (kPi * square(radius)); }
};

struct Direct {
  Vec3f point;
  float u1;
  Vec2f u2;

  DirectSample operator()(const AreaEmitter& e) const {
    DirectSample s;
    const AreaPoint on_light = sample_area(e, u1, u2);
    if (!(on_light.pdf > 0)) return s;
    const auto& t = e.triangles[on_light.triangle];
    const Vec3f to_light = on_light.position - point;
    const float distance2 = length_squared(to_light);
    if (!(distance2 > 0)) return s;
    s.distance = std::sqrt(distance2);
    s.direction = to_light / s.distance;
    s.normal = t.normal;
    s.triangle = on_light.triangle;
    s.barycentric = on_light.barycentric;
    const float cosine = -dot(s.direction, t.normal);
    if (!(cosine > 0)) return s;
    s.radiance = t.mean_radiance;
    s.pdf = on_light.pdf * distance2 / cosine;
    return s;
  }

  DirectSample from_point(Vec3f position, Rgb intensity_over_distance2, float distance2) const {
    DirectSample s;
    s.delta = true;
    if (!(distance2 > 0)) return s;
    s.distance = std::sqrt(distance2);
    s.direction = (position - point) / s.distance;
    s.normal = -s.direction;
    s.radiance = intensity_over_distance2;
    s.pdf = is_black(s.radiance) ? 0.0f : 1.0f;
    return s;
  }
  DirectSample operator()(const PointEmitter& e) const {
    const float d2 = length_squared(e.position - point);
    return from_point(e.position, e.intensity / d2, d2);
  }
  DirectSample operator()(const SpotEmitter& e) const { return towards(e); }
  DirectSample operator()(const ProfileEmitter& e) const { return towards(e); }
  template <typename PointLike>
  DirectSample towards(const PointLike& e) const {
    const float d2 = length_squared(e.position - point);
    if (!(d2 > 0)) return {};
    return from_point(e.position, e.intensity_towards((point - e.position) / std::sqrt(d2)) / d2, d2);
  }

  DirectSample operator()(const DirectionalEmitter& e) const {
    DirectSample s;
    s.delta = true;
    s.direction = -directional_sample(e, u2);
    s.normal = -s.direction;
    s.distance = kInfinity;
    s.radiance = directional_value(e);
    s.pdf = is_black(s.radiance) ? 0.0f : 1.0f;
    return s;
  }
  DirectSample operator()(const EnvironmentEmitter& e) const { return direct_of(e.sample(u2)); }
};

struct Emit {
  const Bounds3f& scene;
  float u1;
  Vec2f u_position, u_direction;

  Emission operator()(const AreaEmitter& e) const {
    Emission out;
    const AreaPoint from = sample_area(e, u1, u_position);
    if (!(from.pdf > 0)) return out;
    const auto& t = e.triangles[from.triangle];
    out.origin = from.position;
    out.normal = t.normal;
    out.direction = Frame::from_normal(t.normal).to_world(warp_cosine_hemisphere(u_direction));
    out.weight = t.mean_radiance * (kPi / from.pdf);
    out.triangle = from.triangle;
    out.barycentric = from.barycentric;
    return out;
  }
  Emission operator()(const PointEmitter& e) const {
    Emission out;
    out.origin = e.position;
    out.direction = warp_sphere(u_direction);
    out.normal = out.direction;
    out.weight = e.intensity * (4 * kPi);
    return out;
  }
  Emission operator()(const SpotEmitter& e) const {
    Emission out;
    out.origin = e.position;
    out.direction = e.frame.to_world(warp_cone(u_direction, e.cos_cutoff));
    out.normal = out.direction;
    out.weight = e.intensity_towards(out.direction) * (2 * kPi * (1 - e.cos_cutoff));
    return out;
  }
  Emission operator()(const ProfileEmitter& e) const {
    Emission out;
    out.origin = e.position;
    const auto drawn = e.profile->sample(u_direction);
    if (!(drawn.pdf > 0)) return out;
    out.direction = e.frame.to_world(drawn.local);
    out.normal = out.direction;
    out.weight = e.scale * e.profile->intensity(drawn.local) / drawn.pdf;
    return out;
  }
  Emission operator()(const DirectionalEmitter& e) const {
    Emission out;
    out.direction = directional_sample(e, u_direction);
    out.normal = out.direction;
    out.origin = entry_point(scene, out.direction, u_position);
    out.weight = directional_value(e) * (kPi * square(scene.radius()));
    return out;
  }
  Emission operator()(const EnvironmentEmitter& e) const {
    Emission out;
    const auto drawn = e.sample(u_direction);
    if (!(drawn.pdf > 0)) return out;
    out.direction = -drawn.direction;
    out.normal = out.direction;
    out.origin = entry_point(scene, out.direction, u_position);
    out.weight = drawn.radiance * (kPi * square(scene.radius()) / drawn.pdf);
    return out;
  }
};

}  // namespace

DirectSample direct_of(const EnvironmentEmitter::Sample& drawn) {
  DirectSample s;
  s.direction = drawn.direction;
  s.normal = -s.direction;
  s.distance = kInfinity;
  s.radiance = drawn.radiance;
  s.pdf = drawn.pdf;
  return s;
}

Rgb SpotEmitter::intensity_towards(Vec3f direction) const {
  const float cosine = dot(direction, frame.n);
  if (!(cosine > cos_cutoff)) return Rgb{};
  if (cosine >= cos_beam) return intensity;
  return intensity * ((cutoff - std::acos(cosine)) / (cutoff - beam));
}

Rgb DirectionalEmitter::radiance_from(Vec3f towards) const {
  // E = L π sin²α on a facing surface.
  if (!(dot(towards, direction) < -cos_half_angle)) return Rgb{};
  return irradiance / (kPi * (1 - square(cos_half_angle)));
}

Rgb power(const Emitter& emitter, float scene_radius) {
  return std::visit(Power{scene_radius}, emitter.kind);
}

DirectSample sample_direct(const Emitter& emitter, Vec3f point, float u1, Vec2f u2) {
  return std::visit(Direct{point, u1, u2}, emitter.kind);
}

Emission sample_emission(const Emitter& emitter, const Bounds3f& scene, float u1, Vec2f u_position,
                         Vec2f u_direction) {
  return std::visit(Emit{scene, u1, u_position, u_direction}, emitter.kind);
}

}  // namespace lumirank::emitters
