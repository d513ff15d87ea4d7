// Light scattered by a clear or pigmented dielectric fiber with a rough, scaly surface, as hair is: the model
// of Chiang et al. 2016 ("A Practical and Controllable Hair and Fur Model for Production Path Tracing"),
// which pbrt and Mitsuba 3 have, averaged over the width of the fiber, since ours are as thin as a line
// (Marschner et al. 2003, "Light Scattering from Human Hair Fibers", section 5).
//
// Three parts: p = 0, what is reflected where it arrives; p = 1, what goes through; p = 2, what is reflected
// within, once or more. Local x runs along the fiber; xo and xi are the sines of the latitudes of wo and wi,
// co and ci their cosines, phi the azimuth between both.
//
//   f = M_p(θo, θi) · s_p(θo) · s_p(θi) · N_p(cos θd, phi),  cos θd = √((1 + co·ci + xo·xi)/2)
//
// M is the longitudinal part, about θi = t - θo (d'Eon et al. 2011, equation 7; t is the tilt of the scales,
// see below), and N the azimuthal one with all attenuation (Chiang et al., equations 8 to 11). s, tabulated,
// makes both ends alike and keeps the energy: a fiber without pigment sends on all light. (Chiang et al. tilt
// one end alone, divide by ci and take θo for θd, which is another fiber from its other end.)
#pragma once

#include <array>
#include <memory>

#include "base/rgb.h"
#include "scatter/closure.h"

namespace lumirank::scatter {

struct FiberTable : LobeTable {
  static constexpr int kParts = 3, kRows = 24, kAzimuths = 96, kLatitudes = 64;

  // The azimuthal part at one cosine of θd, by knots of phi from 0 to π, between which it is linear.
  struct Row {
    std::array<Rgb, kAzimuths + 1> value;
    // Of draws: density in phi from -π to π, in proportion to the mean channel, and its integral from 0,
    // doubled.
    std::array<float, kAzimuths + 1> density, cdf;
    Rgb max_value{0};
  };
  struct Part {
    float variance = 0;                    // of M
    float tilt_sine = 0, tilt_cosine = 1;  // of t
    std::array<Row, kRows + 1> rows;       // by cos θd from 0 to 1
    // By latitude, from -90° to 90°: as far as its cosine is from 0.
    std::array<float, kLatitudes + 1> scale;  // s·√(c + √variance)
    std::array<Rgb, kLatitudes + 1> albedo;   // ∫ f·ci dω, by that of wo
  };
  std::array<Part, kParts> parts;

  Rgb value(int part, Vec3f wo, Vec3f wi) const;
  float density(int part, Vec3f wo, Vec3f wi) const;  // of sample(), per solid angle
  Vec3f sample(int part, Vec3f wo, Vec2f u) const;
  Rgb albedo(int part, float xo, float co) const;
  // At least the value at all wi whose latitudes (radians) lie between the two.
  Rgb max_value(int part, float latitude_o, float lo, float hi) const;
};

// Of a fiber whose tip is towards x, in the terms of Chiang et al. 2016, sections 4.1 and 4.3.
struct FiberOptics {
  Rgb sigma_a{0};                      // absorption per radius
  float eta = 1.55f;                   // index over that outside
  float beta_m = 0.3f, beta_n = 0.3f;  // longitudinal and azimuthal roughness in [0, 1]
  float alpha = 0;                     // tilt of the scales, radians, at most 0.35: t is 2α, 0 and -4α

  friend bool operator==(const FiberOptics&, const FiberOptics&) = default;
};
std::shared_ptr<const FiberTable> make_fiber_table(const FiberOptics& fiber);

}  // namespace lumirank::scatter
