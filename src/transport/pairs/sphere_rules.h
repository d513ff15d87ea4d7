// Rules by which the integral of a spherical light is taken.
//
// Hašan, Křivánek, Walter and Bala, "Virtual Spherical Lights for Many-Light Rendering of Glossy Scenes"
// (2009), equation 5: E = Φ/(πr²) ∫_Ω f_x(l) cosθx f_y(−l) I(l) dl, Ω the cone of directions from the
// receiver x to the sphere of radius r about the light p (the hemisphere of x if x is inside).
#pragma once

#include <cstdint>

namespace lumirank::transport {

struct SphereRules {
  // I(l), which stands for "l meets the lit surface": cosθy as in the paper, or whether l meets the disc of
  // radius r in the tangent plane of the light. Beyond kDiscReach radii, where the cosine is always taken,
  // they agree to 5 %, to 10 % at grazing angles. The disc also leaves out what lies behind the receiver's
  // own surface where the light knows it to be hidden: nothing is lost in a corner.
  enum class Indicator : std::uint8_t { cosine, disc } indicator = Indicator::disc;
  // all: uniform in the cone, BSDF at x, BSDF at the light, balance heuristic (section 3.3); cone: the first
  // alone.
  enum class Strategies : std::uint8_t { all, cone } strategies = Strategies::all;
  // overlap: samples by how many lobes' widths the cone has where they overlap; cone: by the cone alone, 100
  // for 2π.
  enum class Samples : std::uint8_t { overlap, cone } samples = Samples::overlap;
  // In radii: receivers closer to the center get nothing, because their light is traced (LightReach).
  float beyond = 0;
};

inline constexpr float kDiscReach = 4;
inline constexpr float kSamplesInHemisphere = 100;  // section 3.3

}  // namespace lumirank::transport
