// Flights through media: where a path collides, and what of the light arrives.
//
// Woodcock et al. 1965 (delta tracking). Novák, Selle, Jarosz, "Residual ratio tracking for estimating
// attenuation in participating media", 2014. Colors: Wilkie et al., "Hero wavelength spectral sampling",
// 2014, for media Miller, Georgiev, Jarosz, "A null-scattering path integral formulation of light transport",
// 2019.
#pragma once

#include <cmath>

#include "media/medium.h"

namespace lumirank::media {

// So little extinction for each length is none: nothing would notice it, and its inverse may be infinite.
inline constexpr float kNoExtinction = 1e-30f;

// What is carried along a path whose distances are drawn for one channel, the hero: its throughput for that
// choice, and how much likelier each other channel would have made the same path. Its contribution is
// weight(), the balance heuristic over the three choices.
struct ChannelThroughput {
  Rgb throughput{1};
  Rgb likelihood{1};  // relative to the hero's

  void multiply(Rgb value) { throughput *= value; }
  Rgb weight() const { return throughput / mean(likelihood); }
  // An event that the channels would have made with densities `density`, and that transports `value`.
  void event(Rgb value, Rgb density, int hero) {
    const float one = 1 / density[hero];
    throughput *= value * one;
    likelihood *= density * one;
  }
};

inline Rgb exp_minus(Rgb x) { return {std::exp(-x.r), std::exp(-x.g), std::exp(-x.b)}; }

inline Rgb passed(Rgb extinction, float distance) { return exp_minus(over_length(extinction, distance)); }

// A path's way from `origin` along unit `direction` to `t_max` (may be infinite) through a medium: places
// where it collides with something, real or not, are drawn by the hero's bound of the extinction. At each
//   visit(t, at, bound) -> bool: whether it flies on
// where `path` has been brought to the place but not made to collide: the densities are bound per length.
// With `at`, the coefficients there. Returns whether the end was reached; `path` is brought there. `random()`
// gives numbers in [0, 1).
template <typename Random, typename Visit>
bool fly(const Medium& medium, Vec3f origin, Vec3f direction, float t_max, int hero, Random&& random,
         ChannelThroughput& path, Visit&& visit) {
  Medium::Walk walk(medium, origin, direction, t_max);
  Medium::Walk::Piece piece;
  while (walk.next(piece)) {
    float t = piece.begin;
    const Rgb bound = piece.extinction.most;
    while (true) {
      const float step = bound[hero] > kNoExtinction ? -std::log1p(-random()) / bound[hero] : kInfinity;
      if (!(t + step < piece.end)) {
        const Rgb through = passed(bound, piece.end - t);
        if (is_black(through)) return false;  // an endless medium, or one that lets nothing through
        path.event(through, through, hero);
        break;
      }
      t += step;
      const Rgb through = passed(bound, step);
      path.event(through, through, hero);
      if (!visit(t, medium.at(origin + direction * t), bound)) return false;
    }
  }
  return true;
}

// Optical distance, by half of the bounds, along which their middle is counted.
inline constexpr float kMaxResidual = 0.25f;
// So little of light is rather lost by chance than followed on.
inline constexpr float kFaint = 0.05f;

// What is left of light along several ways, one after the other: exp(-depth) · ratio. The exponential is
// taken once, of all of them.
struct OpticalPath {
  Rgb depth{0}, ratio{1};
  float residual = 0;  // optical distance over which ratio may have grown

  void add_even(Rgb extinction, float distance) { depth += over_length(extinction, distance); }
  // Along a way through a medium, as an unbiased estimate; exact where it is homogeneous. All channels share
  // their random places.
  template <typename Random>
  void add(const Medium& medium, Vec3f origin, Vec3f direction, float t_max, Random&& random);
  Rgb left() const { return ratio * exp_minus(depth); }
};

template <typename Random>
void OpticalPath::add(const Medium& medium, Vec3f origin, Vec3f direction, float t_max, Random&& random) {
  if (medium.homogeneous()) return add_even(medium.even_extinction(), t_max);
  Medium::Walk walk(medium, origin, direction, t_max);
  Medium::Walk::Piece piece;
  float free = -1;  // optical distance by the bounds to the next place; < 0: not drawn yet
  while (walk.next(piece)) {
    // The middle of what may be there is counted as if it were there, and what differs from it is tracked:
    // half as many places and half the variance of counting the least. But where there is less, the ratio
    // grows, by exp(kMaxResidual) in the mean of its square, and that is where light gets through.
    float bound = piece.extinction.half();
    const float length = piece.end - piece.begin;
    const bool grows = residual + bound * length < kMaxResidual;
    if (grows)
      residual += bound * length;
    else
      bound *= 2;
    const Rgb counted = grows ? piece.extinction.middle() : piece.extinction.least;
    depth += counted * length;
    if (!(bound > kNoExtinction)) continue;
    if (free < 0) free = -std::log(1 - random());
    float t = piece.begin;
    // What is left of the distance goes on in the next piece.
    while (free < bound * (piece.end - t)) {
      t += free / bound;
      ratio *= Rgb(1) - (walk.extinction(t) - counted) * (1 / bound);
      if (const float most = max_component(ratio); most < kFaint) {
        if (!(random() * kFaint < most)) {
          ratio = Rgb(0);
          return;
        }
        ratio *= kFaint / most;
      }
      free = -std::log(1 - random());
    }
    free -= bound * (piece.end - t);
  }
}

// An unbiased estimate of the transmittance over a distance.
template <typename Random>
Rgb transmittance(const Medium& medium, Vec3f origin, Vec3f direction, float t_max, Random&& random) {
  OpticalPath path;
  path.add(medium, origin, direction, t_max, random);
  return path.left();
}

}  // namespace lumirank::media
