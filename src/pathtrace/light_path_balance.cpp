#include "pathtrace/light_path_balance.h"

#include <cmath>

namespace lumirank::pathtrace {

float crossing(const world::SurfaceHit& hit, const scatter::Closure& closure, Vec3f w) {
  return closure.is_fiber() ? closure.cosine(w) : std::abs(dot(hit.point.ng, w));
}

float light_path_ratio(double light_paths, float eye, const world::SurfaceHit& hit,
                       const scatter::Closure& closure, Vec3f wo, Vec3f wi, float pdf) {
  const float from_eye = eye * crossing(hit, closure, wo) * pdf;
  return from_eye > 0 ? static_cast<float>(light_paths) * crossing(hit, closure, wi) / from_eye : 0.0f;
}

float light_path_ratio(double light_paths, float eye, float phase_pdf) {
  const float from_eye = eye * phase_pdf;
  return from_eye > 0 ? static_cast<float>(light_paths) / from_eye : 0.0f;
}

float merged_light_path_ratio(double light_paths, float area, const world::SurfaceHit& hit,
                              const scatter::Closure& closure, Vec3f wi, float pdf) {
  return pdf > 0 ? static_cast<float>(light_paths) * area * crossing(hit, closure, wi) / pdf : 0.0f;
}

float LightPathBalance::over_found(float ratio, float share, const world::SurfaceHit* hit,
                                   const geometry::Ray& ray, int environment) const {
  const float density =
      hit ? starts_->density(hit->emitter, hit->hit.triangle, hit->point.position, ray.direction)
          : starts_->density(environment, 0, ray.origin, ray.direction);
  return 1 + ratio * share * density;
}

float LightPathBalance::over_sampled(float ratio, Vec3f place, const world::LightSampler::Sample& light,
                                     float turned) const {
  const emitters::DirectSample& direct = light.direct;
  const Vec3f on_emitter = direct.distance < kInfinity ? place + direct.direction * direct.distance : place;
  const float density =
      direct.delta ? starts_->delta_density(light.emitter, place, direct.direction, direct.distance) *
                         turned / light.pdf
                   : starts_->density(light.emitter, direct.triangle, on_emitter, direct.direction) * turned /
                         (light.pdf + turned);
  return 1 + ratio * density;
}

}  // namespace lumirank::pathtrace
