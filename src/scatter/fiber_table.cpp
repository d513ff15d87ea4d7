#include "scatter/fiber_table.h"

#include <algorithm>
#include <cmath>

#include "base/vec.h"
#include "scatter/fresnel.h"
#include "scatter/lobes/bound_terms.h"

namespace lumirank::scatter {
namespace {

// Sharper ones than these look the same.
constexpr double kMinVariance = 1e-4, kMinAzimuthalScale = 0.02;
constexpr float kMinFiberSine = 1e-4f;

// exp(-x) I0(x), x ≥ 0 (Abramowitz and Stegun 1964, 9.8.1 and 9.8.2).
float scaled_bessel(float x) {
  if (x < 3.75f) {
    const float t = square(x / 3.75f);
    const float i0 =
        1 + t * (3.5156229f +
                 t * (3.0899424f + t * (1.2067492f + t * (0.2659732f + t * (0.0360768f + t * 0.0045813f)))));
    return std::exp(-x) * i0;
  }
  const float t = 3.75f / x;
  const float sum =
      0.39894228f +
      t * (0.01328592f +
           t * (0.00225319f +
                t * (-0.00157565f +
                     t * (0.00916281f +
                          t * (-0.02057706f + t * (0.02635537f + t * (-0.01647633f + t * 0.00392377f)))))));
  return sum / std::sqrt(x);
}

float cosine_of(Vec3f w) { return std::max(kMinFiberSine, std::sqrt(w.y * w.y + w.z * w.z)); }

// M(xo, xi) where 1 - cos(θo + θi) is `off`.
float longitudinal(float variance, float off, float product_of_cosines) {
  return std::exp(-off / variance) * scaled_bessel(product_of_cosines / variance) /
         (variance * (1 - std::exp(-2 / variance)));
}

struct Knots {
  std::size_t below;
  float share;  // of the one above
};
Knots knots_about(float x, int intervals) {
  const float scaled = std::clamp(x, 0.0f, 1.0f) * static_cast<float>(intervals);
  const auto below = std::min(static_cast<std::size_t>(scaled), static_cast<std::size_t>(intervals - 1));
  return {below, scaled - static_cast<float>(below)};
}
template <typename T>
auto look_up(const T& table, Knots at) {
  return lerp(table[at.below], table[at.below + 1], at.share);
}

// The place of a latitude of sine x and cosine c among the knots of `scale`: 0 to 1.
float place_of(float x, float c) { return 0.5f * (x < 0 ? c : 2 - c); }
float scale_at(const FiberTable::Part& part, float x, float c) {
  return look_up(part.scale, knots_about(place_of(x, c), FiberTable::kLatitudes)) /
         std::sqrt(c + std::sqrt(part.variance));
}

// 1 - cos(θo + θi - t).
float off_mirror(const FiberTable::Part& part, float xo, float co, float xi, float ci) {
  const float cosine = co * ci - xo * xi, sine = xo * ci + co * xi;
  const float c = cosine * part.tilt_cosine + sine * part.tilt_sine;
  const float s = sine * part.tilt_cosine - cosine * part.tilt_sine;
  return c > 0 ? s * s / (1 + c) : 1 - c;  // 1 - c has no digits left where the lobe is
}

struct Latitude {
  float x, c;  // sine and cosine
};
// Draws of θi are about θo - t, whose cosine counts beyond the pole as well.
Latitude tilted(const FiberTable::Part& part, float xo, float co) {
  return {xo * part.tilt_cosine - co * part.tilt_sine, std::abs(co * part.tilt_cosine + xo * part.tilt_sine)};
}

// What the formulas need of two directions.
struct FiberPair {
  float co, ci;
  Knots row, azimuth;
  FiberPair(Vec3f wo, Vec3f wi) : co(cosine_of(wo)), ci(cosine_of(wi)) {
    const float across = wo.y * wi.y + wo.z * wi.z;
    row = knots_about(std::sqrt(std::max(0.0f, 0.5f * (1 + co * ci + wo.x * wi.x))), FiberTable::kRows);
    azimuth =
        knots_about(std::acos(std::clamp(across / (co * ci), -1.0f, 1.0f)) * kInvPi, FiberTable::kAzimuths);
  }
};

// ------------------------------------------------------------------------------------------ making the table

struct AzimuthalLogistic {  // from -π to π
  double scale, whole;
  explicit AzimuthalLogistic(double s) : scale(s), whole(cdf(kPi) - cdf(-kPi)) {}
  double cdf(double x) const { return 1 / (1 + std::exp(-x / scale)); }
  double density(double x) const {
    const double e = std::exp(-std::abs(x) / scale);
    return e / (scale * (1 + e) * (1 + e) * whole);
  }
};

// What a fiber without pigment scatters by each part, by cos θd: 1 in all.
using ClearShares = std::array<std::array<float, FiberTable::kRows + 1>, FiberTable::kParts>;

// The azimuthal parts at one cosine of θd. Where light meets the fiber at the angle γ from its axis (h = sin
// γ from -1 to 1), Fresnel's F is reflected at once and (1 - F)² T^p F^(p - 1) leaves after p passages, about
// the azimuth 2pγ' - 2γ + pπ (Chiang et al. 2016, equations 8 to 11); what leaves after three or more is
// even.
void fill_rows(FiberTable& table, std::size_t row, Rgb sigma_a, double eta,
               const AzimuthalLogistic& roughness, ClearShares& clear) {
  // A step moves the light that leaves by a third of the roughness at most.
  const int steps = std::clamp(static_cast<int>(20 / roughness.scale), 48, 512);
  const double c = std::max(1e-3, static_cast<double>(row) / FiberTable::kRows);
  const double sine2 = 1 - c * c;
  const double bent_eta = std::sqrt(std::max(0.0, eta * eta - sine2)) / c;
  const double inner_cosine = std::sqrt(std::max(0.0, 1 - sine2 / (eta * eta)));
  constexpr int kClear = 3;  // beside the channels
  double energy[FiberTable::kParts][4] = {};
  double even[3] = {};
  for (int k = 0; k < steps; ++k) {
    const double gamma = 0.5 * static_cast<double>(kPi) * (k + 0.5) / steps, h = std::sin(gamma);
    const double weight = 0.5 * static_cast<double>(kPi) / steps * std::cos(gamma);  // of h from 0 to 1
    const auto f = static_cast<double>(
        fresnel_dielectric(static_cast<float>(c * std::cos(gamma)), static_cast<float>(eta)));
    // An index below that outside: what meets it aslant is reflected whole.
    const bool enters = h < bent_eta && inner_cosine > 0;
    const double inner_gamma = enters ? std::asin(h / bent_eta) : 0;
    double share[FiberTable::kParts][4];
    for (int ch = 0; ch <= kClear; ++ch) {
      const double sigma = ch == kClear ? 0 : static_cast<double>(sigma_a[ch]);
      const double t = enters ? std::exp(-2 * sigma * std::cos(inner_gamma) / inner_cosine) : 0;
      share[0][ch] = enters ? f : 1;
      share[1][ch] = (1 - f) * (1 - f) * t;
      share[2][ch] = share[1][ch] * t * f;
      const double further = f * t < 1 ? share[2][ch] * f * t / (1 - f * t) : 0;
      if (ch < kClear) even[ch] += weight * further / (2 * static_cast<double>(kPi));
      for (int p = 0; p < FiberTable::kParts; ++p) energy[p][ch] += weight * share[p][ch];
      energy[2][ch] += weight * further;
    }
    for (int p = 0; p < FiberTable::kParts; ++p) {
      const double about = std::remainder(2 * p * inner_gamma - 2 * gamma + p * static_cast<double>(kPi),
                                          2 * static_cast<double>(kPi));
      auto& value = table.parts[static_cast<std::size_t>(p)].rows[row].value;
      for (int a = 0; a <= FiberTable::kAzimuths; ++a) {
        const double phi = static_cast<double>(kPi) * a / FiberTable::kAzimuths;
        double here = 0;  // γ and -γ, half of h each
        for (const double side : {about, -about}) {
          const double x = std::remainder(phi - side, 2 * static_cast<double>(kPi));
          if (std::abs(x) < 20 * roughness.scale) here += 0.5 * roughness.density(x);
        }
        for (int ch = 0; ch < 3; ++ch)
          value[static_cast<std::size_t>(a)][ch] += static_cast<float>(weight * here * share[p][ch]);
      }
    }
  }
  for (int p = 0; p < FiberTable::kParts; ++p) {
    clear[static_cast<std::size_t>(p)][row] = static_cast<float>(energy[p][kClear]);
    FiberTable::Row& r = table.parts[static_cast<std::size_t>(p)].rows[row];
    if (p == 2)
      for (Rgb& value : r.value)
        for (int ch = 0; ch < 3; ++ch) value[ch] += static_cast<float>(even[ch]);
    // Straight lines between knots have other areas than the curve.
    constexpr double kWidth = 2 * static_cast<double>(kPi) / FiberTable::kAzimuths;  // both signs of phi
    for (int ch = 0; ch < 3; ++ch) {
      double area = 0;
      for (std::size_t a = 0; a < FiberTable::kAzimuths; ++a)
        area += 0.5 * kWidth * static_cast<double>(r.value[a][ch] + r.value[a + 1][ch]);
      for (Rgb& value : r.value) value[ch] *= area > 0 ? static_cast<float>(energy[p][ch] / area) : 0;
    }
    double all = 0;
    for (std::size_t a = 0; a < FiberTable::kAzimuths; ++a)
      all += 0.5 * kWidth * static_cast<double>(mean(r.value[a]) + mean(r.value[a + 1]));
    double sum = 0;
    for (std::size_t a = 0; a <= FiberTable::kAzimuths; ++a) {
      r.density[a] =
          all > 1e-30 ? static_cast<float>(static_cast<double>(mean(r.value[a])) / all) : 0.5f * kInvPi;
      if (a > 0) sum += 0.5 * kWidth * static_cast<double>(r.density[a] + r.density[a - 1]);
      r.cdf[a] = static_cast<float>(sum);
      for (int ch = 0; ch < 3; ++ch) r.max_value[ch] = std::max(r.max_value[ch], r.value[a][ch]);
    }
  }
}

Latitude latitude_at(std::size_t knot) {
  const float y = 2 * static_cast<float>(knot) / FiberTable::kLatitudes, c = y < 1 ? y : 2 - y;
  const float x = std::sqrt(std::max(0.0f, 1 - c * c));
  return {y < 1 ? -x : x, c};
}

// Calls visit(latitude of wi, M·ci·dθi) where M, tilted by `tilt`, is not nothing.
template <typename Visit>
void over_latitudes(const FiberTable::Part& part, float tilt, Latitude o, Visit&& visit) {
  constexpr int kSteps = 160;
  const float about = tilt - std::atan2(o.x, o.c), reach = 9 * std::sqrt(part.variance);
  const float lo = std::max(-0.5f * kPi, about - reach), hi = std::min(0.5f * kPi, about + reach);
  const float step = (hi - lo) / kSteps;
  for (int k = 0; k < kSteps; ++k) {
    const float theta = lo + (static_cast<float>(k) + 0.5f) * step;
    const Latitude i{std::sin(theta), std::cos(theta)};
    const float off = 2 * square(std::sin(0.5f * (theta - about)));
    visit(i, longitudinal(part.variance, off, o.c * i.c) * i.c * step);
  }
}

// s, by the symmetric form of Sinkhorn's iteration, as if nothing were tilted.
void balance(FiberTable::Part& part) {
  part.scale.fill(1);
  for (int round = 0; round < 12; ++round) {
    auto next = part.scale;
    for (std::size_t k = 0; k < next.size(); ++k) {
      const Latitude o = latitude_at(k);
      float sum = 0;
      over_latitudes(part, 0, o, [&](Latitude i, float m) { sum += m * i.c * scale_at(part, i.x, i.c); });
      next[k] /= std::sqrt(sum * scale_at(part, o.x, o.c));
    }
    part.scale = next;
  }
}

// ∫ f·ci dω by the knots of wo, of a part that scatters `energy` by cos θd.
template <typename T>
std::array<T, FiberTable::kLatitudes + 1> albedo_of(const FiberTable::Part& part,
                                                    const std::array<T, FiberTable::kRows + 1>& energy) {
  std::array<T, FiberTable::kLatitudes + 1> albedo;
  for (std::size_t k = 0; k < albedo.size(); ++k) {
    const Latitude o = latitude_at(k);
    const float so = scale_at(part, o.x, o.c);
    albedo[k] = T(0);
    over_latitudes(part, std::asin(part.tilt_sine), o, [&](Latitude i, float m) {
      const float c = std::sqrt(std::max(0.0f, 0.5f * (1 + o.c * i.c + o.x * i.x)));
      albedo[k] +=
          look_up(energy, knots_about(c, FiberTable::kRows)) * (m * i.c * so * scale_at(part, i.x, i.c));
    });
  }
  return albedo;
}

// θd, by which the parts share the light, spreads more in one part than in another, and tilted scales meet
// light at another width than that where it goes. One more factor for all parts, found as s was, keeps the
// energy of a fiber without pigment.
void keep_energy(FiberTable& table, const ClearShares& clear) {
  constexpr int kRounds = 12;
  for (int round = 0; round <= kRounds; ++round) {
    std::array<float, FiberTable::kLatitudes + 1> sum{};
    for (std::size_t p = 0; p < FiberTable::kParts; ++p) {
      const auto albedo = albedo_of(table.parts[p], clear[p]);
      for (std::size_t k = 0; k < sum.size(); ++k) sum[k] += albedo[k];
    }
    const bool last = round == kRounds;  // no more than arrives
    const float most = std::max(1.0f, *std::max_element(sum.begin(), sum.end()));
    for (FiberTable::Part& part : table.parts)
      for (std::size_t k = 0; k < sum.size(); ++k) part.scale[k] /= std::sqrt(last ? most : sum[k]);
  }
}

void integrate_albedo(FiberTable::Part& part) {
  std::array<Rgb, FiberTable::kRows + 1> energy;
  for (std::size_t row = 0; row < energy.size(); ++row) {
    Rgb sum(0);
    for (std::size_t a = 0; a < FiberTable::kAzimuths; ++a)
      sum += (part.rows[row].value[a] + part.rows[row].value[a + 1]) * (kPi / FiberTable::kAzimuths);
    energy[row] = sum;
  }
  part.albedo = albedo_of(part, energy);
}

}  // namespace

Rgb FiberTable::value(int p, Vec3f wo, Vec3f wi) const {
  const Part& part = parts[static_cast<std::size_t>(p)];
  const FiberPair pair(wo, wi);
  const float off = off_mirror(part, wo.x, pair.co, wi.x, pair.ci);
  const float along = longitudinal(part.variance, off, pair.co * pair.ci) * scale_at(part, wo.x, pair.co) *
                      scale_at(part, wi.x, pair.ci);
  const Row &below = part.rows[pair.row.below], &above = part.rows[pair.row.below + 1];
  return lerp(look_up(below.value, pair.azimuth), look_up(above.value, pair.azimuth), pair.row.share) * along;
}

float FiberTable::density(int p, Vec3f wo, Vec3f wi) const {
  const Part& part = parts[static_cast<std::size_t>(p)];
  const FiberPair pair(wo, wi);
  const Row &below = part.rows[pair.row.below], &above = part.rows[pair.row.below + 1];
  const float off = off_mirror(part, wo.x, pair.co, wi.x, pair.ci);
  return longitudinal(part.variance, off, tilted(part, wo.x, pair.co).c * pair.ci) *
         lerp(look_up(below.density, pair.azimuth), look_up(above.density, pair.azimuth), pair.row.share);
}

Vec3f FiberTable::sample(int p, Vec3f wo, Vec2f u) const {
  const Part& part = parts[static_cast<std::size_t>(p)];
  const float co = cosine_of(wo);
  // The latitude takes two numbers (d'Eon et al. 2013, "Importance Sampling for Physically-Based Hair Fiber
  // Models"): halves of the digits of one.
  constexpr float kHalf = 4096;
  const float digits = u.x * kHalf, first = std::min(std::floor(digits), kHalf - 1), second = digits - first;
  const float v = part.variance, least = std::exp(-2 / v), share = (first + 0.5f) / kHalf;
  const float off = std::clamp(-v * std::log(share + (1 - share) * least), 0.0f, 2.0f);
  const float sine = std::sqrt(std::max(0.0f, off * (2 - off)));
  const Latitude about = tilted(part, wo.x, co);
  const float xi = std::clamp((off - 1) * about.x + sine * std::cos(2 * kPi * second) * about.c, -1.0f, 1.0f);
  const float ci = std::sqrt(std::max(0.0f, 1 - xi * xi));
  // One of the two rows, then the azimuth in it.
  const Knots at = knots_about(std::sqrt(std::max(0.0f, 0.5f * (1 + co * ci + wo.x * xi))), kRows);
  const bool upper = u.y < at.share;
  const float rest = upper ? u.y / at.share : (u.y - at.share) / (1 - at.share);
  const Row& row = part.rows[at.below + (upper ? 1 : 0)];
  const float side = rest < 0.5f ? 1.0f : -1.0f;
  const float x = std::min(rest < 0.5f ? 2 * rest : 2 * rest - 1, 1.0f) * row.cdf.back();
  const auto found = std::upper_bound(row.cdf.begin() + 1, row.cdf.end() - 1, x);
  const auto a = static_cast<std::size_t>(found - row.cdf.begin()) - 1;
  // Where the density is a·(1 - t) + b·t, its integral reaches y at t = 2y/(a + √(a² + 2(b - a)y)).
  const float da = row.density[a], db = row.density[a + 1];
  const float y = (x - row.cdf[a]) * (static_cast<float>(kAzimuths) / (2 * kPi));
  const float root = da + std::sqrt(std::max(0.0f, da * da + 2 * (db - da) * y));
  const float t = root > 0 ? std::clamp(2 * y / root, 0.0f, 1.0f) : 0.5f;
  const float phi = side * (static_cast<float>(a) + t) * (kPi / kAzimuths);
  const float cos_o = wo.y / co, sin_o = wo.z / co, cos_phi = std::cos(phi), sin_phi = std::sin(phi);
  return {xi, ci * (cos_o * cos_phi - sin_o * sin_phi), ci * (sin_o * cos_phi + cos_o * sin_phi)};
}

Rgb FiberTable::albedo(int p, float xo, float co) const {
  return look_up(parts[static_cast<std::size_t>(p)].albedo, knots_about(place_of(xo, co), kLatitudes));
}

Rgb FiberTable::max_value(int p, float latitude_o, float lo, float hi) const {
  const Part& part = parts[static_cast<std::size_t>(p)];
  const float co = std::max(kMinFiberSine, std::cos(latitude_o)), xo = std::sin(latitude_o);
  const float min_c = std::max(kMinFiberSine, std::min(std::cos(lo), std::cos(hi)));
  const float tilt = std::asin(part.tilt_sine);
  const float from = latitude_o - tilt + lo, to = latitude_o - tilt + hi;
  const float apart = from > 0 ? from : to < 0 ? -to : 0.0f;
  // exp(x) I0(-x) falls.
  const float off = std::max(0.0f, 2 * square(std::sin(0.5f * std::min(apart, kPi))) - 1e-6f);
  const float along = longitudinal(part.variance, off, co * min_c);
  float scale = 0;
  const auto knot = [](float latitude) {
    return knots_about(place_of(std::sin(latitude), std::max(kMinFiberSine, std::cos(latitude))), kLatitudes)
        .below;
  };
  for (std::size_t k = knot(lo - 1e-4f); k <= knot(hi + 1e-4f) + 1; ++k)
    scale = std::max(scale, part.scale[k]);
  scale /= std::sqrt(min_c + std::sqrt(part.variance));
  // θd is half of what lies between the latitudes.
  const float first = 0.5f * (lo - latitude_o), second = 0.5f * (hi - latitude_o);
  const float least = std::min(std::cos(first), std::cos(second)) - 1e-4f;
  const float most = max_sine_of(first, second) + 1e-4f;
  Rgb rows(0);
  for (std::size_t row = knots_about(least, kRows).below; row <= knots_about(most, kRows).below + 1; ++row)
    for (int c = 0; c < 3; ++c) rows[c] = std::max(rows[c], part.rows[row].max_value[c]);
  return rows * (along * scale_at(part, xo, co) * scale * 1.0005f);
}

std::shared_ptr<const FiberTable> make_fiber_table(const FiberOptics& fiber) {
  auto table = std::make_shared<FiberTable>();
  const auto m = static_cast<double>(fiber.beta_m), n = static_cast<double>(fiber.beta_n);
  // Chiang et al. 2016, equations 7 and 8.
  const double width = 0.726 * m + 0.812 * m * m + 3.7 * std::pow(m, 20.0);
  const double scale =
      std::sqrt(static_cast<double>(kPi) / 8) * (0.265 * n + 1.194 * n * n + 5.372 * std::pow(n, 22.0));
  constexpr double kSpread[FiberTable::kParts] = {1, 0.25, 4};
  // What goes straight through is as wide as the light, and most of it: its tilt would not be seen, but cost
  // energy at one end.
  constexpr float kTilt[FiberTable::kParts] = {2, 0, -4};
  ClearShares clear;
  const AzimuthalLogistic roughness(std::max(kMinAzimuthalScale, scale));
  for (std::size_t row = 0; row <= FiberTable::kRows; ++row)
    fill_rows(*table, row, fiber.sigma_a, static_cast<double>(fiber.eta), roughness, clear);
  for (std::size_t p = 0; p < FiberTable::kParts; ++p) {
    FiberTable::Part& part = table->parts[p];
    part.variance = static_cast<float>(std::max(kMinVariance, width * width * kSpread[p]));
    const float tilt = kTilt[p] * fiber.alpha;
    part.tilt_sine = std::sin(tilt), part.tilt_cosine = std::cos(tilt);
    balance(part);
  }
  keep_energy(*table, clear);
  for (FiberTable::Part& part : table->parts) integrate_albedo(part);
  return table;
}

}  // namespace lumirank::scatter
