// How eye paths and the light paths that are traced beside them (light_tracer.h) share what both find.
#pragma once

#include "pathtrace/emission_sampler.h"
#include "scatter/closure.h"
#include "world/camera.h"
#include "world/light_sampler.h"

namespace lumirank::pathtrace {

// Light paths for one eye path, at the vertex next to the eye, over the density of their starts and the share
// of those eye paths that find the emitter by their BSDF. `eye`: eye paths per area across their direction;
// `pdf`: of wi, the eye path's direction there.
float light_path_ratio(double light_paths, float eye, const world::SurfaceHit& hit,
                       const scatter::Closure& closure, Vec3f wo, Vec3f wi, float pdf);
// The same within a medium, where both collide alike; what has been absorbed and scattered on the way to the
// eye is left out of both, as of all weights.
float light_path_ratio(double light_paths, float eye, float phase_pdf);

// The same where they are merged within `area` (vertex_merging.h), at the vertex that eye paths come to.
float merged_light_path_ratio(double light_paths, float area, const world::SurfaceHit& hit,
                              const scatter::Closure& closure, Vec3f wi, float pdf);

// Cosine of what arrives or leaves: with the surface itself, or across a fiber.
float crossing(const world::SurfaceHit& hit, const scatter::Closure& closure, Vec3f w);

// The eye paths' side. What they find counts divided by what these return: one and the light paths over the
// eye paths that could have found it, `ratio` being light_path_ratio() at the path's first vertex.
class LightPathBalance {
 public:
  // `light_paths` for one eye path of `camera` in each pixel. Starts and camera must outlive it.
  // `merged_pixels`: the area within which light paths are merged behind mirrors and glass, as a part of what
  // a pixel sees at that distance; 0: they are not.
  LightPathBalance(const EmissionSampler& starts, const world::Camera& camera, double light_paths,
                   double merged_pixels = 0)
      : starts_(&starts),
        camera_(&camera),
        light_paths_(light_paths),
        merged_pixels_(static_cast<float>(merged_pixels)) {}

  // At the first vertex, which the eye sees at `distance` along `ray`, where the path takes wi.
  float ratio_on(const geometry::Ray& ray, float distance, const world::SurfaceHit& hit,
                 const scatter::Closure& closure, Vec3f wi, float pdf) const {
    return light_path_ratio(light_paths_, camera_->density(ray, distance), hit, closure, -ray.direction, wi,
                            pdf);
  }
  float ratio_within(const geometry::Ray& ray, float distance, float phase_pdf) const {
    return light_path_ratio(light_paths_, camera_->density(ray, distance), phase_pdf);
  }

  // Area of the disc around the first vertex that is not specular, behind others, at `distance` along a path
  // that left the eye along `ray`; 0: none. Mirrors and glass count as flat.
  float merge_area(const geometry::Ray& ray, float distance, const scatter::Closure& closure) const {
    // Strands are thinner than any disc.
    if (!(merged_pixels_ > 0) || closure.is_fiber()) return 0;
    const float area = merged_pixels_ / camera_->density(ray, distance);
    return area >= kLeastArea && area < kInfinity ? area : 0;
  }
  float ratio_merged(float area, const world::SurfaceHit& hit, const scatter::Closure& closure, Vec3f wi,
                     float pdf) const {
    return merged_light_path_ratio(light_paths_, area, hit, closure, wi, pdf);
  }

  // Of an emitter met by direction; `share`: of that among all ways in which eye paths find it. `hit`:
  // nullptr where the path leaves the scene.
  float over_found(float ratio, float share, const world::SurfaceHit* hit, const geometry::Ray& ray,
                   int environment) const;
  // Of a light sampled at `place`, where `turned` is the density of its direction by scattering.
  float over_sampled(float ratio, Vec3f place, const world::LightSampler::Sample& light, float turned) const;
  // What is left of the background, whose emitters light paths find each as often as it is chosen.
  Rgb background_left(const geometry::Ray& ray, float ratio) const {
    return starts_->background_left(ray, ratio);
  }

 private:
  const EmissionSampler* starts_;
  const world::Camera* camera_;
  static constexpr float kLeastArea = 1e-30f;
  double light_paths_;
  float merged_pixels_;
};

}  // namespace lumirank::pathtrace
