// How the optical depth of a medium grows along one ray, by steps of about half a number of its grids: for
// who asks the same way many times, or must get the same answer each time, which tracking (tracking.h) does
// not give. Between the places that are looked at the extinction is their mean, so what is thinner or thicker
// in between is missed; exact where a medium is homogeneous.
#pragma once

#include <vector>

#include "media/medium.h"

namespace lumirank::media {

class DepthProfile {
 public:
  // As of Medium::Walk: `direction` unit, t_max infinite or not. Replaces what was there.
  void follow(const Medium& medium, Vec3f origin, Vec3f direction, float t_max);

  // ∫ extinction over [0, t].
  Rgb depth(float t) const;
  // Per length, as depth() has it; t within [0, t_max].
  Rgb extinction(float t) const;
  Rgb whole_depth() const { return steps_.empty() ? Rgb(0) : steps_.back().depth; }
  // Where depth() of a channel reaches a value, by `mean` that of their mean; infinite: nowhere.
  float place_of(float depth, int channel) const;
  float place_of_mean(float depth) const;

 private:
  struct Step {
    float begin, end;
    Rgb extinction, depth;  // depth: at its end
  };
  // The first step that ends beyond t, or all of them.
  std::size_t step_at(float t) const;
  Rgb depth_before(std::size_t k) const { return k > 0 ? steps_[k - 1].depth : Rgb(0); }
  template <typename Of>
  float find(float depth, const Of& of) const;

  std::vector<Step> steps_;  // ascending; nothing between them
};

}  // namespace lumirank::media
