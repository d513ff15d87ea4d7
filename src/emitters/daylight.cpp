#include "emitters/daylight.h"

#include <algorithm>
#include <cmath>

#include "base/photometry.h"

namespace lumirank::emitters {

namespace {

Rgb from_xyz(double X, double Y, double Z) {
  const Rgb c(static_cast<float>(3.2404542 * X - 1.5371385 * Y - 0.4985314 * Z),
              static_cast<float>(-0.9692660 * X + 1.8760108 * Y + 0.0415560 * Z),
              static_cast<float>(0.0556434 * X - 0.2040259 * Y + 1.0572252 * Z));
  return {std::max(c.r, 0.0f), std::max(c.g, 0.0f), std::max(c.b, 0.0f)};
}

double cubic(const double (&k)[4], double t) { return ((k[0] * t + k[1]) * t + k[2]) * t + k[3]; }

// The CIE 1931 curves by the sums of Gaussians of Wyman, Sloan and Shirley (JCGT 2013).
double lobe(double nm, double mean, double below, double above) {
  const double t = (nm - mean) * (nm < mean ? below : above);
  return std::exp(-0.5 * t * t);
}
double cie_x(double nm) {
  return 0.362 * lobe(nm, 442.0, 0.0624, 0.0374) + 1.056 * lobe(nm, 599.8, 0.0264, 0.0323) -
         0.065 * lobe(nm, 501.1, 0.0490, 0.0382);
}
double cie_y(double nm) {
  return 0.821 * lobe(nm, 568.8, 0.0213, 0.0247) + 0.286 * lobe(nm, 530.9, 0.0613, 0.0322);
}
double cie_z(double nm) {
  return 1.217 * lobe(nm, 437.0, 0.0845, 0.0278) + 0.681 * lobe(nm, 459.0, 0.0385, 0.0725);
}

// Table 2 of the paper, every 20 nm from 380: the sun's radiance above the atmosphere in W·m⁻²·sr⁻¹·nm⁻¹ and
// the absorption of ozone and water vapor in 1/cm. Mixed gases absorb near 760 nm only.
constexpr double kFirst = 380, kStep = 20;
constexpr int kCount = 20;
constexpr double kSun[kCount] = {16559, 21127, 25829, 26760, 30545, 30663, 28712, 27100, 26361, 25060,
                                 25355, 24631, 23685, 22827, 21970, 21097, 20240, 19427, 18628, 17860};
constexpr double kOzone[kCount] = {0,     0,     0,     0.002, 0.008, 0.017, 0.030, 0.048, 0.070, 0.095,
                                   0.122, 0.120, 0.105, 0.079, 0.057, 0.036, 0.023, 0.014, 0.010, 0.007};
constexpr double kWater[kCount] = {0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0.024, 1, 0.061, 1e-5};

double interpolate(const double (&table)[kCount], double nm) {
  const double at = std::clamp((nm - kFirst) / kStep, 0.0, kCount - 1.0);
  const int i = std::min(static_cast<int>(at), kCount - 2);
  return table[i] + (table[i + 1] - table[i]) * (at - i);
}

}  // namespace

double PreethamSky::Perez::eval(double cos_theta, double gamma) const {
  const double cos_gamma = std::cos(gamma);
  return (1 + a * std::exp(b / cos_theta)) * (1 + c * std::exp(d * gamma) + e * cos_gamma * cos_gamma);
}

// Appendix A.2 of the paper.
PreethamSky::PreethamSky(float turbidity, Vec3f to_sun) : to_sun_(to_sun) {
  const double T = turbidity;
  const double theta = std::acos(std::clamp(static_cast<double>(to_sun.y), 0.0, 1.0));
  Y_ = {0.1787 * T - 1.4630, -0.3554 * T + 0.4275, -0.0227 * T + 5.3251, 0.1206 * T - 2.5771,
        -0.0670 * T + 0.3703};
  x_ = {-0.0193 * T - 0.2592, -0.0665 * T + 0.0008, -0.0004 * T + 0.2125, -0.0641 * T - 0.8989,
        -0.0033 * T + 0.0452};
  y_ = {-0.0167 * T - 0.2608, -0.0950 * T + 0.0092, -0.0079 * T + 0.2102, -0.0441 * T - 1.6537,
        -0.0109 * T + 0.0529};
  const double chi = (4.0 / 9 - T / 120) * (kPiD - 2 * theta);
  const double Y = (4.0453 * T - 4.9710) * std::tan(chi) - 0.2155 * T + 2.4192;
  const double x = T * T * cubic({0.00166, -0.00375, 0.00209, 0}, theta) +
                   T * cubic({-0.02903, 0.06377, -0.03202, 0.00394}, theta) +
                   cubic({0.11693, -0.21196, 0.06052, 0.25886}, theta);
  const double y = T * T * cubic({0.00275, -0.00610, 0.00317, 0}, theta) +
                   T * cubic({-0.04214, 0.08970, -0.04153, 0.00516}, theta) +
                   cubic({0.15346, -0.26756, 0.06670, 0.26688}, theta);
  zenith_Y_ = Y / Y_.eval(1, theta);
  zenith_x_ = x / x_.eval(1, theta);
  zenith_y_ = y / y_.eval(1, theta);
}

Rgb PreethamSky::radiance(Vec3f direction) const {
  if (!(direction.y > 0)) return Rgb{};
  const double cos_theta = std::max(static_cast<double>(direction.y), 1e-4);
  const double gamma = std::acos(std::clamp(static_cast<double>(dot(direction, to_sun_)), -1.0, 1.0));
  const double Y = std::max(0.0, zenith_Y_ * Y_.eval(cos_theta, gamma)) * 1000 / kLumensPerUnit;
  const double x = zenith_x_ * x_.eval(cos_theta, gamma), y = zenith_y_ * y_.eval(cos_theta, gamma);
  return from_xyz(Y / y * x, Y, Y / y * (1 - x - y));
}

Rgb sun_radiance(float turbidity, float theta) {
  // Ångström's turbidity coefficient and the relative optical mass of the air (appendix A.1).
  const double beta = std::max(0.0, 0.04608365822050 * turbidity - 0.04586025928522);
  const double m =
      1 / (std::cos(static_cast<double>(theta)) + 0.15 * std::pow(93.885 - theta * 180 / kPiD, -1.253));
  constexpr double kOzoneColumn = 0.35, kWaterColumn = 2;  // cm
  double X = 0, Y = 0, Z = 0, norm = 0;
  for (double nm = 380; nm <= 760; nm += 5) {
    const double um = nm / 1000;
    const double rayleigh = std::exp(-m * 0.008735 * std::pow(um, -4.08));
    const double aerosol = std::exp(-m * beta * std::pow(um, -1.3));
    const double ozone = std::exp(-m * interpolate(kOzone, nm) * kOzoneColumn);
    const double gas = nm > 759 ? 3.0 * m : 0.0;
    const double gases = std::exp(-1.41 * gas / std::pow(1 + 118.93 * gas, 0.45));
    const double wet = interpolate(kWater, nm) * kWaterColumn * m;
    const double water = std::exp(-0.2385 * wet / std::pow(1 + 20.07 * wet, 0.45));
    const double value = interpolate(kSun, nm) * rayleigh * aerosol * ozone * gases * water;
    X += value * cie_x(nm), Y += value * cie_y(nm), Z += value * cie_z(nm), norm += cie_y(nm);
  }
  return from_xyz(X / norm, Y / norm, Z / norm);
}

}  // namespace lumirank::emitters
