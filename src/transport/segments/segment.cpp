#include "transport/segments/segment.h"

#include <algorithm>
#include <cmath>

namespace lumirank::transport {

namespace {

// Equation 13's σ. As printed the term grows with the distance; what is meant falls with it.
constexpr float kFilmDeviation = 4;

// Towards where most is scattered of what flies along the segment: on, or back.
Vec3f peak_of(const media::PhaseFunction& phase, const Segment& s) {
  return mean(phase.eval(1)) >= mean(phase.eval(-1)) ? s.direction : -s.direction;
}

}  // namespace

float SegmentSimilarity::phase_difference(const Segment& a, const Segment& b) const {
  const media::PhaseFunction& of_a = media_[static_cast<std::size_t>(a.medium)].phase();
  const media::PhaseFunction& of_b = media_[static_cast<std::size_t>(b.medium)].phase();
  if (of_a.isotropic() && of_b.isotropic()) return 0;
  const auto at = [](const media::PhaseFunction& phase, const Segment& s, Vec3f w) {
    return mean(phase.eval(dot(s.direction, w)));
  };
  const Vec3f peak_a = peak_of(of_a, a), peak_b = peak_of(of_b, b);
  const float own_a = at(of_a, a, peak_a), own_b = at(of_b, b, peak_b);
  return std::max(std::abs(own_a - at(of_b, b, peak_a)) / own_a,
                  std::abs(at(of_a, a, peak_b) - own_b) / own_b);
}

float SegmentSimilarity::operator()(const Segment& a, const Segment& b) const {
  const float apart = length(a.origin - b.origin) + length(a.end() - b.end());
  const float near = reach_ > 0 ? std::max(0.0f, reach_ - apart) / reach_ : 0.0f;
  // κ = 1/2; both of its two differences are the same, since a medium has one phase function.
  const float directions = std::max(0.0f, 1 - phase_difference(a, b));
  const float through = 1 - std::abs(a.transmittance - b.transmittance);
  if (!film_) return near + directions + through;
  const float square = length_squared(Vec3f{a.film.x - b.film.x, a.film.y - b.film.y, 0});
  return near + directions + through + std::exp(-square / (2 * kFilmDeviation * kFilmDeviation));
}

}  // namespace lumirank::transport
