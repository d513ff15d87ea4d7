#include "emitters/hosek_wilkie.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "emitters/hosek_wilkie_data.h"

namespace lumirank::emitters {

namespace {

// The tables hold the integral over the curves of the eye; a sample of it per nanometer is what daylight.h
// counts in. As Mitsuba divides.
constexpr double kNanometers = 106.75;

// Entry `k` of a table with `values` numbers for each channel, in between: linear in turbidity and albedo, a
// Bézier curve of degree five over the third root of the sun's elevation.
struct Between {
  int turbidity;
  double more;  // of the next turbidity
  double albedo;
  std::array<double, kSkyElevations> weights;

  double operator()(std::span<const float> table, int values, int channel, int k) const {
    double sum = 0;
    for (int t = 0; t < 2; ++t)
      for (int a = 0; a < kSkyAlbedos; ++a) {
        const double share = (t == 0 ? 1 - more : more) * (a == 0 ? 1 - albedo : albedo);
        const int level = std::min(turbidity + t, kSkyTurbidities - 1);
        for (int e = 0; e < kSkyElevations; ++e) {
          const int at = (((level * kSkyAlbedos + a) * kSkyElevations + e) * 3 + channel) * values + k;
          sum += share * weights[static_cast<std::size_t>(e)] *
                 static_cast<double>(table[static_cast<std::size_t>(at)]);
        }
      }
    return sum;
  }
};

std::array<double, kSkyElevations> bernstein(double x) {
  constexpr double kBinomial[kSkyElevations] = {1, 5, 10, 10, 5, 1};
  std::array<double, kSkyElevations> weights;
  for (int k = 0; k < kSkyElevations; ++k)
    weights[static_cast<std::size_t>(k)] = kBinomial[k] * std::pow(x, k) * std::pow(1 - x, 5 - k);
  return weights;
}

}  // namespace

HosekWilkieSky::HosekWilkieSky(float turbidity, Rgb albedo, Vec3f to_sun) : to_sun_(to_sun) {
  const double level = std::clamp(turbidity, kMinTurbidity, kMaxTurbidity) - 1;
  const double elevation = std::asin(std::clamp(static_cast<double>(to_sun.y), 0.0, 1.0));
  Between between{static_cast<int>(level), level - std::floor(level), 0,
                  bernstein(std::cbrt(elevation / (kPiD / 2)))};
  for (int c = 0; c < 3; ++c) {
    between.albedo = static_cast<double>(albedo[c]);
    for (int k = 0; k < kSkyShape; ++k) channels_[c].shape[k] = between(kHosekWilkieShape, kSkyShape, c, k);
    channels_[c].radiance = between(kHosekWilkieRadiance, 1, c, 0) / kNanometers;
  }
}

// Equation 8; shape: A to I but for H, which is last here as in the tables.
double HosekWilkieSky::Channel::at(double cos_theta, double gamma) const {
  const auto& [A, B, C, D, E, F, G, I, H] = shape;
  const double cosine = std::cos(gamma), square = cosine * cosine;
  const double halo = (1 + square) / std::pow(1 + H * H - 2 * H * cosine, 1.5);
  return radiance * (1 + A * std::exp(B / (cos_theta + 0.01))) *
         (C + D * std::exp(E * gamma) + F * square + G * halo + I * std::sqrt(cos_theta));
}

Rgb HosekWilkieSky::radiance(Vec3f direction) const {
  if (!(direction.y > 0)) return Rgb{};
  const double gamma = std::acos(std::clamp(static_cast<double>(dot(direction, to_sun_)), -1.0, 1.0));
  Rgb sum;
  for (int c = 0; c < 3; ++c)
    sum[c] = static_cast<float>(std::max(0.0, channels_[c].at(static_cast<double>(direction.y), gamma)));
  return sum;
}

// Linear in turbidity; a Catmull-Rom curve over the third root of the elevation.
Rgb hosek_wilkie_sun(float turbidity, float elevation) {
  const double level =
      std::clamp(turbidity, HosekWilkieSky::kMinTurbidity, HosekWilkieSky::kMaxTurbidity) - 1;
  const int below = std::min(static_cast<int>(level), kSkyTurbidities - 2);
  constexpr int kPieces = kSunElevations - 1;
  const double at = kPieces * std::cbrt(std::clamp(static_cast<double>(elevation) / (kPiD / 2), 0.0, 1.0));
  const int piece = std::min(static_cast<int>(at), kPieces - 1);
  const double f = at - piece;
  Rgb sum;
  for (int c = 0; c < 3; ++c) {
    const auto knot = [&](int k) {
      const auto of = [&](int t) {
        return static_cast<double>(kHosekWilkieSun[(t * kSunElevations + k) * 3 + c]);
      };
      return of(below) + (level - below) * (of(below + 1) - of(below));
    };
    const double p = knot(piece), q = knot(piece + 1);
    const double before = piece > 0 ? knot(piece - 1) : 2 * p - q;
    const double after = piece + 1 < kPieces ? knot(piece + 2) : 2 * q - p;
    const double cubic = 3 * (p - q) + after - before, square = 2 * before - 5 * p + 4 * q - after;
    sum[c] = static_cast<float>(std::max(0.0, p + 0.5 * f * (q - before + f * (square + f * cubic))));
  }
  return sum;
}

}  // namespace lumirank::emitters
