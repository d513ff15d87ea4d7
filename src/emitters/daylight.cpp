#include "emitters/daylight.h"

#include <algorithm>
#include <cmath>

namespace lumirank::emitters {

namespace {

Rgb from_xyz(double X, double Y, double Z) {
  const Rgb c(static_cast<float>(3.2404542 * X - 1.5371385 * Y - 0.4985314 * Z),
              static_cast<float>(-0.9692660 * X + 1.8760108 * Y + 0.0415560 * Z),
              static_cast<float>(0.0556434 * X - 0.2040259 * Y + 1.0572252 * Z));
  return {std::max(c.r, 0.0f), std::max(c.g, 0.0f), std::max(c.b, 0.0f)};
}

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
